// SPDX-License-Identifier: Apache-2.0
// Which voxel centres lie inside a closed mesh, decided exactly: how often its surface winds around them.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace turbid {

/// Crossings of the surface with the lines along x through the voxel centres. A centre is inside where the winding
/// number is positive, so bodies may have cavities, and parts that overlap are one body. Positions are in voxels,
/// rounded to 2^-20 voxel and then treated exactly, with ties broken by symbolic perturbation (Edelsbrunner and Muecke
/// 1990): no line slips through an edge or a vertex.
class Winding {
 public:
  /// The centre of voxel (i, j, k) is the position (i, j, k). `voxels`: size of the domain.
  Winding(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles, glm::ivec3 voxels);

  /// Are the centres of the eight voxels (x..x+7, y, z) inside? They lie in the domain.
  std::array<bool, 8> inside_row(int x, int y, int z) const;

 private:
  struct Crossing {
    std::int32_t first;    ///< the first voxel of the line beyond the surface
    std::int32_t winding;  ///< +1 where the line enters, -1 where it leaves
  };
  glm::ivec3 voxels_;
  std::vector<std::uint32_t> begin_;  ///< of each line's crossings; one more than there are lines
  std::vector<Crossing> crossings_;
};

}  // namespace turbid
