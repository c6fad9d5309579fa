// SPDX-License-Identifier: Apache-2.0
// See volume_errors.h.
#include "host/study/volume_errors.h"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace turbid {
namespace {

/// measure_errors over the voxels of all active blocks; reference(voxel) answers per colour.
template <class Reference>
ErrorMeasures over_voxels(const FluenceVolume& got, const VoxelChoice& where, Reference reference) {
  std::vector<float> a, b;
  const int edge = got.blocks.edge(), per_block = got.blocks.voxels_per_block();
  for (int block = 0; block < got.blocks.count(); ++block)
    for (int v = 0; v < per_block; ++v) {
      const glm::ivec3 voxel =
          got.blocks.coordinates(block) * edge + glm::ivec3(v % edge, v / edge % edge, v / (edge * edge));
      if (where && !where(got.frame.centre_of(voxel))) continue;
      const glm::vec3 expected = reference(voxel);
      for (int c = 0; c < 3; ++c) {
        a.push_back(got.fluence[c * got.colour_stride() + std::size_t(block) * per_block + v]);
        b.push_back(expected[c]);
      }
    }
  return measure_errors(a, b);
}

/// 0 where no block is active.
glm::vec3 fluence_at(const FluenceVolume& volume, glm::ivec3 voxel) {
  const int edge = volume.blocks.edge(), block = volume.blocks.find(voxel / edge);
  if (block < 0) return glm::vec3(0);
  const glm::ivec3 v = voxel % edge;
  const std::size_t at = std::size_t(block) * volume.blocks.voxels_per_block() + (v.z * edge + v.y) * edge + v.x;
  glm::vec3 fluence;
  for (int c = 0; c < 3; ++c) fluence[c] = volume.fluence[c * volume.colour_stride() + at];
  return fluence;
}

/// How many of the reference's voxels lie along the edge of one of got's.
int refinement(const GridFrame& got, const GridFrame& reference) {
  const int times = static_cast<int>(std::lround(got.voxel_size / reference.voxel_size));
  // 1e-3 voxels over the whole domain: more than the rounding of float sizes, less than any intended shift.
  const float slack = 1e-3f * got.voxel_size;
  if (times < 1 || glm::length(got.origin - reference.origin) > slack ||
      glm::any(glm::greaterThan(glm::abs(got.size() - reference.size()), glm::vec3(slack))) ||
      reference.voxels != got.voxels * times)
    throw std::invalid_argument("volume_errors: the reference's voxels do not divide those of the same domain");
  return times;
}

}  // namespace

ErrorMeasures volume_errors(const FluenceVolume& got, const std::function<glm::vec3(glm::vec3)>& formula,
                            const VoxelChoice& where) {
  return over_voxels(got, where, [&](glm::ivec3 voxel) { return formula(got.frame.centre_of(voxel)); });
}

ErrorMeasures volume_errors(const FluenceVolume& got, const FluenceVolume& reference, const VoxelChoice& where) {
  const int times = refinement(got.frame, reference.frame);
  return over_voxels(got, where, [&](glm::ivec3 voxel) {
    glm::dvec3 sum(0);
    for (int z = 0; z < times; ++z)
      for (int y = 0; y < times; ++y)
        for (int x = 0; x < times; ++x) sum += glm::dvec3(fluence_at(reference, voxel * times + glm::ivec3(x, y, z)));
    return glm::vec3(sum / double(times * times * times));
  });
}

}  // namespace turbid
