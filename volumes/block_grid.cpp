// SPDX-License-Identifier: Apache-2.0
// Numbers the active blocks of a domain along a Morton curve, so that neighbours lie close in memory, and finds the neighbours
// over their six faces.
#include "volumes/block_grid.h"

#include <algorithm>
#include <stdexcept>

namespace turbid {
namespace {

/// Position of a block in the dense table, x fastest.
std::size_t slot(glm::ivec3 block, glm::ivec3 blocks) {
  return (static_cast<std::size_t>(block.z) * blocks.y + block.y) * blocks.x + block.x;
}

}  // namespace

BlockGrid::BlockGrid(glm::ivec3 blocks, int edge, const std::function<bool(glm::ivec3)>& active,
                     std::array<bool, 3> periodic)
    : blocks_(blocks), edge_(edge), periodic_(periodic) {
  if (blocks.x < 0 || blocks.y < 0 || blocks.z < 0 || edge < 1)
    throw std::invalid_argument("BlockGrid: empty or negative size");
  index_.assign(static_cast<std::size_t>(blocks.x) * blocks.y * blocks.z, -1);
  int levels = 0;
  while ((1 << levels) < std::max({blocks.x, blocks.y, blocks.z})) ++levels;
  auto visit = [&](auto&& self, glm::ivec3 at, int size) -> void {
    if (at.x >= blocks.x || at.y >= blocks.y || at.z >= blocks.z) return;
    if (size == 1) {
      if (!active(at)) return;
      index_[slot(at, blocks)] = count();
      coordinates_.push_back(at);
      return;
    }
    const int half = size / 2;
    for (int octant = 0; octant < 8; ++octant)
      self(self, at + half * glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2), half);
  };
  visit(visit, glm::ivec3(0), 1 << levels);

  neighbours_.resize(coordinates_.size());
  for (int block = 0; block < count(); ++block)
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      glm::ivec3 neighbour = coordinates_[block];
      neighbour[axis] += face % 2 == 0 ? -1 : 1;
      if (periodic_[axis]) neighbour[axis] = (neighbour[axis] + blocks[axis]) % blocks[axis];
      const int found = find(neighbour);
      neighbours_[block][face] = found >= 0 ? found : count();
    }
}

int BlockGrid::find(glm::ivec3 block) const {
  for (int axis = 0; axis < 3; ++axis)
    if (block[axis] < 0 || block[axis] >= blocks_[axis]) return -1;
  return index_[slot(block, blocks_)];
}

}  // namespace turbid
