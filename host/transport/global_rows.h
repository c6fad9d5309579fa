// SPDX-License-Identifier: Apache-2.0
// Where the global lattice keeps its voxels: rows along x through neighbouring blocks, the walls where blocks end, and
// the faces within them at which light does not simply stream on (kernels/global_lattice.cl).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

/// A face that `exchange` mixes: between voxel x below and y above it along the axis.
struct GlobalFace {
  std::array<std::int32_t, 4> places;  ///< of x and y, the axis, unused
  std::int8_t open_towards;            ///< face number 0..5 if only one side is active (mirrors included), else -1
};

struct GlobalRows {
  std::vector<std::array<std::int32_t, 4>> rows;  ///< place of the first voxel, first block, blocks, y + 8 z
  std::vector<std::array<std::int32_t, 4>>
      ends;  ///< [row]: places beyond its ends, or -1 for a wall; to the next row in y, z
  std::vector<std::array<float, 2>> end_walls;    ///< [channel][row]: R at its ends, 0 where there is no wall
  std::vector<std::array<std::int32_t, 2>> near;  ///< [block in row order][-y, +y, -z, +z]: first place beyond,
                                                  ///< distance of rows; or -1 - wall, 0
  std::vector<float> walls;                       ///< [channel][wall][row][x]: R
  int wall_count = 0;
  std::vector<std::int32_t> order;   ///< [block of the diffusion medium]: its number in row order
  std::vector<std::int32_t> places;  ///< [block][voxel] of the diffusion medium: where it is kept
  int place_count = 0;               ///< a multiple of 8
  std::vector<GlobalFace> faces;
  std::vector<std::array<float, 4>> links;  ///< [channel][face]: own and other share of arrivals at y, then at x
};

GlobalRows make_global_rows(const DiffusionMedium&);

}  // namespace turbid
