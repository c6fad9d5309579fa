// SPDX-License-Identifier: Apache-2.0
// See block_states.h.
#include "host/transport/block_states.h"

#include <algorithm>
#include <cmath>

#include "host/base/parallel.h"
#include "kernels/shared/medium_params.h"

namespace turbid {
namespace {

constexpr int kTileEdge = TURBID_TILE_EDGE, kCells = kTileEdge - 1;

/// No trilinear interpolant of a tile's nodes changes faster than this: within a cell its derivative along an axis is a
/// mean of the differences along the cell's four edges.
float steepest_slope(const std::vector<float>& nodes) {
  constexpr int strides[3] = {1, kTileEdge, kTileEdge * kTileEdge};
  float steepest = 0;
  for (int cell = 0; cell < kCells * kCells * kCells; ++cell) {
    const glm::ivec3 corner = block_coordinates(cell, glm::ivec3(kCells));
    const float* at = nodes.data() + corner.x * strides[0] + corner.y * strides[1] + corner.z * strides[2];
    float square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int along = strides[axis], u = strides[(axis + 1) % 3], v = strides[(axis + 2) % 3];
      float largest = 0;
      for (int edge : {0, u, v, u + v}) largest = std::max(largest, std::abs(at[edge + along] - at[edge]));
      square += largest * largest;
    }
    steepest = std::max(steepest, square);
  }
  return std::sqrt(steepest);
}

}  // namespace

std::vector<int> classify(const MediumVolume& medium, int r, std::vector<float>* slope) {
  const glm::ivec3 blocks = medium.frame().blocks();
  std::vector<int> state(blocks.x * blocks.y * blocks.z, TURBID_TILE_OUTSIDE);
  parallel_ranges(static_cast<int>(state.size()), [&](int begin, int end) {
    std::vector<float> nodes(TURBID_TILE_NODES);
    for (int block = begin; block < end; ++block) {
      medium.read_signed_distance(r, 8 * block_coordinates(block, blocks), glm::ivec3(kTileEdge), nodes);
      const auto [low, high] = std::minmax_element(nodes.begin(), nodes.end());
      state[block] = *low >= TURBID_TOUCH ? TURBID_TILE_OUTSIDE : *high < 0.0f ? TURBID_TILE_INSIDE : 0;
      if (state[block] == 0) (*slope)[block] = std::max((*slope)[block], steepest_slope(nodes));
    }
  });
  return state;
}

std::vector<int> presence(int r, const std::vector<std::vector<int>>& body_state, int blocks) {
  std::vector<int> result(blocks, TURBID_TILE_OUTSIDE);
  for (int block = 0; block < blocks; ++block) {
    bool present = r == 0 || body_state[r][block] != TURBID_TILE_OUTSIDE;
    for (std::size_t higher = r + 1; higher < body_state.size(); ++higher) {
      if (body_state[higher][block] == TURBID_TILE_INSIDE) present = false;
    }
    if (present) result[block] = 0;
  }
  return result;
}

std::vector<int> only_region(const std::vector<std::vector<int>>& body_state, const std::vector<float>& slope) {
  const int blocks = static_cast<int>(slope.size());
  std::vector<int> result(blocks, 0);
  for (int block = 0; block < blocks; ++block) {
    for (int r = static_cast<int>(body_state.size()) - 1; r >= 1; --r) {
      if (body_state[r][block] == TURBID_TILE_OUTSIDE) continue;
      const float steepest = std::max(slope[block], 1.0f) + 1e-4f;  // and what rounding may add
      result[block] =
          body_state[r][block] == TURBID_TILE_INSIDE ? r : -static_cast<int>(std::ceil(steepest / TURBID_SLOPE_UNIT));
      break;
    }
  }
  return result;
}

}  // namespace turbid
