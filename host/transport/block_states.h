// SPDX-License-Identifier: Apache-2.0
// Where bodies are, block by block of 8^3 cells: which of them may own a point there, and how fast their distances
// change.
#pragma once
#include <vector>

#include "volumes/medium_volume.h"

namespace turbid {

inline glm::ivec3 block_coordinates(int block, glm::ivec3 blocks) {
  return {block % blocks.x, (block / blocks.x) % blocks.y, block / (blocks.x * blocks.y)};
}

/// Of body r, per block: TURBID_TILE_OUTSIDE, TURBID_TILE_INSIDE, or 0 where its surface may pass. By trilinear
/// interpolation that is exactly where both signs occur; and where the block ends within the gap to another body that r
/// touches. `slope`, per block, is raised to the steepest slope of the distance in blocks of the last kind [1].
std::vector<int> classify(const MediumVolume&, int r, std::vector<float>* slope);

/// Blocks in which region r may own a point: 0; elsewhere TURBID_TILE_OUTSIDE. body_state[r]: as of `classify`, r >= 1.
std::vector<int> presence(int r, const std::vector<std::vector<int>>& body_state, int blocks);

/// The one region of each block; < 0 where more may meet: see TURBID_SLOPE_UNIT.
std::vector<int> only_region(const std::vector<std::vector<int>>& body_state, const std::vector<float>& slope);

}  // namespace turbid
