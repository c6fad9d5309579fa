// SPDX-License-Identifier: Apache-2.0
// Active blocks of a domain: cubes of edge^3 voxels that hold at least one active voxel, and who is whose neighbour.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "volumes/frame.h"

namespace turbid {

class BlockGrid {
 public:
  /// `active` is asked for every block coordinate of the domain once. `periodic[axis]` wraps neighbours.
  BlockGrid(glm::ivec3 blocks, int edge, const std::function<bool(glm::ivec3)>& active,
            std::array<bool, 3> periodic = {false, false, false});

  int edge() const { return edge_; }
  int voxels_per_block() const { return edge_ * edge_ * edge_; }
  int count() const { return static_cast<int>(coordinates_.size()); }
  glm::ivec3 dimensions() const { return blocks_; }
  std::array<bool, 3> periodic() const { return periodic_; }
  /// Index of the block at these block coordinates, or -1 if it is inactive or outside.
  int find(glm::ivec3 block) const;
  glm::ivec3 coordinates(int block) const { return coordinates_[block]; }
  /// Neighbours over the faces -x, +x, -y, +y, -z, +z; count() where there is none (a block of zeros on the device).
  const std::vector<std::array<std::int32_t, 6>>& neighbours() const { return neighbours_; }

 private:
  glm::ivec3 blocks_;
  int edge_;
  std::array<bool, 3> periodic_;
  std::vector<glm::ivec3> coordinates_;
  std::vector<std::int32_t> index_;
  std::vector<std::array<std::int32_t, 6>> neighbours_;
};

}  // namespace turbid
