// SPDX-License-Identifier: Apache-2.0
// Private to volumes/: OpenVDB grids built block by block in parallel, and boxes of voxels read out of them quickly.
// OpenVDB's leaves are our blocks (8^3 voxels), but they store z fastest where we have x fastest.
#pragma once
#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "volumes/frame.h"

namespace turbid {

inline constexpr int kBlockVoxels = kBlockEdge * kBlockEdge * kBlockEdge;
static_assert(openvdb::FloatGrid::TreeType::LeafNodeType::DIM == kBlockEdge);

template <class GridT>
using LeafOf = typename GridT::TreeType::LeafNodeType;

/// Calls visit(voxel, offset) for the voxels of a block, x fastest: `voxel` counts them, `offset` is the place in the
/// leaf.
template <class Visit>
void for_block_voxels(Visit visit) {
  int voxel = 0;
  for (int z = 0; z < kBlockEdge; ++z)
    for (int y = 0; y < kBlockEdge; ++y)
      for (int x = 0; x < kBlockEdge; ++x) visit(voxel++, (x << 6) | (y << 3) | z);
}

inline glm::ivec3 block_at(glm::ivec3 blocks, int index) {
  return {index % blocks.x, index / blocks.x % blocks.y, index / (blocks.x * blocks.y)};
}
inline int block_count(glm::ivec3 blocks) {
  return blocks.x * blocks.y * blocks.z;
}
inline openvdb::Coord first_voxel(glm::ivec3 block) {
  return openvdb::Coord(block.x, block.y, block.z) << 3;
}

/// What a block of a grid holds: a leaf, else one value for all its voxels, else the grid's background.
template <class GridT>
struct BlockContent {
  std::unique_ptr<LeafOf<GridT>> leaf;
  std::optional<typename GridT::ValueType> tile;
  bool tile_active = false;
};

template <class GridT>
std::unique_ptr<LeafOf<GridT>> make_leaf(glm::ivec3 block, typename GridT::ValueType value, bool active = false) {
  return std::make_unique<LeafOf<GridT>>(first_voxel(block), value, active);
}

template <class GridT>
typename GridT::Ptr assemble(const GridFrame& frame, typename GridT::ValueType background,
                             std::vector<BlockContent<GridT>>& contents) {
  auto grid = GridT::create(background);
  for (std::size_t i = 0; i < contents.size(); ++i) {
    auto& content = contents[i];
    if (content.leaf)
      grid->tree().addLeaf(content.leaf.release());
    else if (content.tile)
      grid->tree().addTile(1, first_voxel(block_at(frame.blocks(), static_cast<int>(i))), *content.tile,
                           content.tile_active);
  }
  auto transform = openvdb::math::Transform::createLinearTransform(frame.voxel_size);
  const glm::dvec3 centre = glm::dvec3(frame.origin) + 0.5 * double(frame.voxel_size);
  transform->postTranslate({centre.x, centre.y, centre.z});
  grid->setTransform(transform);
  return grid;
}

/// The grid whose blocks hold what `fill(block)` -> BlockContent returns; `fill` runs on several threads.
template <class GridT, class Fill>
typename GridT::Ptr grid_from_blocks(const GridFrame& frame, typename GridT::ValueType background, Fill fill) {
  std::vector<BlockContent<GridT>> contents(block_count(frame.blocks()));
  tbb::parallel_for(std::size_t(0), contents.size(),
                    [&](std::size_t i) { contents[i] = fill(block_at(frame.blocks(), static_cast<int>(i))); });
  return assemble<GridT>(frame, background, contents);
}

/// Calls store(i, value) for the voxels of the box, x fastest. Coordinates outside the domain are wrapped on the axes
/// of `wrap` and moved to the nearest voxel on the others.
template <class GridT, class Store>
void read_box(const GridT& grid, const GridFrame& frame, glm::ivec3 lower, glm::ivec3 size, Store store,
              std::array<bool, 3> wrap = {false, false, false}) {
  const auto place = [&](int axis, int i) {
    const int count = frame.voxels[axis], at = lower[axis] + i;
    return wrap[axis] ? ((at % count) + count) % count : std::clamp(at, 0, count - 1);
  };
  const auto run_end = [&](int axis, int begin) {  // the run of positions that fall into one block
    const int block = place(axis, begin) >> 3;
    int end = begin + 1;
    while (end < size[axis] && place(axis, end) >> 3 == block) ++end;
    return end;
  };
  const std::size_t row = size.x, slice = row * size.y;
  std::array<int, 64> x_offset;
  for (int z0 = 0, z1; z0 < size.z; z0 = z1) {
    z1 = run_end(2, z0);
    for (int y0 = 0, y1; y0 < size.y; y0 = y1) {
      y1 = run_end(1, y0);
      for (int x0 = 0, x1; x0 < size.x; x0 = x1) {
        x1 = std::min(run_end(0, x0), x0 + static_cast<int>(x_offset.size()));
        const openvdb::Coord first(place(0, x0), place(1, y0), place(2, z0));
        const auto* leaf = grid.tree().probeConstLeaf(first);
        if (!leaf) {
          const auto value = grid.tree().getValue(first);
          for (int z = z0; z < z1; ++z)
            for (int y = y0; y < y1; ++y)
              for (int x = x0; x < x1; ++x) store(z * slice + y * row + x, value);
          continue;
        }
        const auto* values = leaf->buffer().data();
        for (int x = x0; x < x1; ++x) x_offset[x - x0] = (place(0, x) & 7) << 6;
        for (int z = z0; z < z1; ++z)
          for (int y = y0; y < y1; ++y) {
            const auto* line = values + (((place(1, y) & 7) << 3) | (place(2, z) & 7));
            const std::size_t at = z * slice + y * row;
            for (int x = x0; x < x1; ++x) store(at + x, line[x_offset[x - x0]]);
          }
      }
    }
  }
}

}  // namespace turbid
