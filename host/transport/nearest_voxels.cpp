// SPDX-License-Identifier: Apache-2.0
// Looks through cubes of growing size.
#include "host/transport/nearest_voxels.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kReach = 3;

void find_within(const DiffusionMedium& medium, glm::ivec3 voxel, int region, int reach, std::vector<NearVoxel>& found) {
  for (int dz = -reach; dz <= reach; ++dz) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const glm::ivec3 offset(dx, dy, dz);
        const std::int64_t at = active_voxel(medium, voxel + offset);
        if (at < 0 || medium.region[static_cast<std::size_t>(at)] != region) continue;
        found.push_back(
            {static_cast<std::size_t>(at), 1.0f / static_cast<float>(dx * dx + dy * dy + dz * dz), -offset});
      }
    }
  }
}

}  // namespace

std::int64_t active_voxel(const DiffusionMedium& medium, glm::ivec3 voxel) {
  if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, medium.frame.voxels)))
    return -1;
  const int block = medium.blocks.find(voxel / kEdge);
  if (block < 0) return -1;
  const glm::ivec3 local = voxel % kEdge;
  return block * std::int64_t{512} + local.x + kEdge * (local.y + kEdge * local.z);
}

void find_nearest_voxels(const DiffusionMedium& medium, glm::ivec3 voxel, int region, std::vector<NearVoxel>& found) {
  found.clear();
  for (int reach = 1; found.empty() && reach <= kReach; ++reach) find_within(medium, voxel, region, reach, found);
  double total = 0;
  for (const NearVoxel& near : found) total += near.weight;
  for (NearVoxel& near : found) near.weight = static_cast<float>(near.weight / total);
}

}  // namespace turbid
