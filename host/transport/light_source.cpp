// SPDX-License-Identifier: Apache-2.0
// Adds up the tiles' copies of each node in a fixed order.
#include "host/transport/light_source.h"

#include <cmath>

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512, kTileEdge = TURBID_TILE_EDGE;

struct Target {
  std::size_t at;
  float weight;
};

/// Active voxels of region r within `reach` of a voxel, with weights 1 / distance^2.
std::vector<Target> nearest(const DiffusionMedium& medium, glm::ivec3 voxel, int region, int reach) {
  std::vector<Target> targets;
  for (int dz = -reach; dz <= reach; ++dz) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const glm::ivec3 v = voxel + glm::ivec3(dx, dy, dz);
        if (glm::any(glm::lessThan(v, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(v, medium.frame.voxels))) continue;
        const int block = medium.blocks.find(v / kEdge);
        if (block < 0) continue;
        const glm::ivec3 local = v % kEdge;
        const std::size_t at = block * std::size_t{kVoxels} + local.x + kEdge * (local.y + kEdge * local.z);
        if (medium.region[at] != region) continue;
        targets.push_back({at, 1.0f / static_cast<float>(dx * dx + dy * dy + dz * dz)});
      }
    }
  }
  return targets;
}

}  // namespace

LightSource gather_source(const std::vector<std::int64_t>& deposit, double watts_per_unit, const DeviceMedium& device,
                          const DiffusionMedium& medium) {
  const int channels = medium.channels;
  const std::size_t stride = medium.stride();
  LightSource source;
  source.power = medium.emission;
  source.density.assign(stride * channels, 0.0f);
  for (int c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < stride; ++i) source.emitted[c] += source.power[c * stride + i];
  }
  // Copies of a node in neighbouring tiles are added in double precision before anything is rounded.
  std::vector<double> own(stride * channels, 0.0), foreign(stride * channels, 0.0);
  for (std::size_t tile = 0; tile < device.source_tiles.size(); ++tile) {
    const SourceTile& where = device.source_tiles[tile];
    const std::int64_t* node = deposit.data() + tile * TURBID_TILE_NODES * channels;
    for (int i = 0; i < TURBID_TILE_NODES; ++i, node += channels) {
      bool empty = true;
      for (int c = 0; c < channels; ++c) empty &= node[c] == 0;
      if (empty) continue;
      const glm::ivec3 voxel =
          kEdge * where.block + glm::ivec3(i % kTileEdge, (i / kTileEdge) % kTileEdge, i / (kTileEdge * kTileEdge));
      const glm::ivec3 inside = glm::min(voxel, medium.frame.voxels - 1);
      const int block = medium.blocks.find(inside / kEdge);
      const glm::ivec3 local = inside % kEdge;
      const std::size_t at = block < 0 ? 0 : block * std::size_t{kVoxels} + local.x + kEdge * (local.y + kEdge * local.z);
      if (block >= 0 && medium.region[at] == where.region) {
        for (int c = 0; c < channels; ++c) own[c * stride + at] += watts_per_unit * static_cast<double>(node[c]);
        continue;
      }
      std::vector<Target> targets = nearest(medium, inside, where.region, 1);
      for (int reach = 2; targets.empty() && reach <= 3; ++reach) targets = nearest(medium, inside, where.region, reach);
      double total = 0;
      for (const Target& target : targets) total += target.weight;
      for (int c = 0; c < channels; ++c) {
        const double power = watts_per_unit * static_cast<double>(node[c]);
        if (targets.empty()) source.unresolved[c] += power;
        for (const Target& target : targets) foreign[c * stride + target.at] += power * target.weight / total;
      }
    }
  }
  for (int c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < stride; ++i) {
      const std::size_t at = c * stride + i;
      source.deposited[c] += own[at] + foreign[at];
      source.power[at] += static_cast<float>(own[at] + foreign[at]);
      source.density[at] = static_cast<float>(own[at] / medium.hat_volume[i]);
    }
  }
  source.deposited += source.unresolved;
  return source;
}

}  // namespace turbid
