// SPDX-License-Identifier: Apache-2.0
// Where bodies' surfaces cut the lines between voxel centres, by their signed distances.
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "volumes/medium_volume.h"

namespace turbid {

/// Signed distances [voxels] of bodies around one block of voxels, read once each.
class BlockDistances {
 public:
  /// `lower`: the block's first voxel.
  BlockDistances(const MediumVolume& medium, glm::ivec3 lower) : medium_(medium), lower_(lower - 2) {}
  /// `local`: voxel within the block, or up to two outside it.
  float at(int body, glm::ivec3 local);
  /// By central differences [1]; up to one voxel outside the block.
  glm::vec3 gradient(int body, glm::ivec3 local);

 private:
  const MediumVolume& medium_;
  glm::ivec3 lower_;
  std::map<int, std::vector<float>> values_;
};

/// Where the surface of `body` cuts the line from a voxel's centre to its neighbour's: distance [voxels] and |n_a|.
struct Cut {
  float distance = 0.5f, normal = 1.0f;
};
Cut cut_by(BlockDistances&, int body, glm::ivec3 voxel, int axis, int sign);

}  // namespace turbid
