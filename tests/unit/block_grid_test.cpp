// SPDX-License-Identifier: Apache-2.0
// Numbering of active blocks and their neighbours.
#include "volumes/block_grid.h"

#include <gtest/gtest.h>

namespace turbid {
namespace {

bool always(glm::ivec3) {
  return true;
}

TEST(BlockGrid, NumbersActiveBlocksInOrderXFastest) {
  const BlockGrid grid({2, 3, 2}, 8, [](glm::ivec3 b) { return b != glm::ivec3(1, 0, 0); });
  ASSERT_EQ(grid.count(), 11);
  EXPECT_EQ(grid.coordinates(0), glm::ivec3(0, 0, 0));
  EXPECT_EQ(grid.coordinates(1), glm::ivec3(0, 1, 0));
  EXPECT_EQ(grid.coordinates(10), glm::ivec3(1, 2, 1));
  for (int b = 0; b < grid.count(); ++b) EXPECT_EQ(grid.find(grid.coordinates(b)), b);
  EXPECT_EQ(grid.find({1, 0, 0}), -1) << "inactive";
  EXPECT_EQ(grid.find({-1, 0, 0}), -1) << "outside";
  EXPECT_EQ(grid.find({0, 3, 0}), -1) << "outside";
  EXPECT_EQ(grid.voxels_per_block(), 512);
}

TEST(BlockGrid, NeighbourOfANeighbourIsTheBlockItself) {
  const BlockGrid grid({4, 3, 5}, 8, [](glm::ivec3 b) { return (b.x + 2 * b.y + 3 * b.z) % 4 != 0; },
                       {true, false, true});
  for (int b = 0; b < grid.count(); ++b)
    for (int face = 0; face < 6; ++face) {
      const int other = grid.neighbours()[b][face];
      if (other < grid.count()) {
        EXPECT_EQ(grid.neighbours()[other][face ^ 1], b);
      }
    }
}

TEST(BlockGrid, FacesWithoutANeighbourPointToTheBlockOfZeros) {
  const BlockGrid grid({2, 1, 1}, 8, always);
  EXPECT_EQ(grid.neighbours()[0], (std::array<std::int32_t, 6>{2, 1, 2, 2, 2, 2}));
  EXPECT_EQ(grid.neighbours()[1], (std::array<std::int32_t, 6>{0, 2, 2, 2, 2, 2}));
}

TEST(BlockGrid, PeriodicAxesWrapAndOthersDoNot) {
  const BlockGrid grid({3, 2, 1}, 4, always, {true, false, true});
  const int first = grid.find({0, 0, 0});
  const auto& neighbours = grid.neighbours()[first];
  EXPECT_EQ(neighbours[0], grid.find({2, 0, 0}));
  EXPECT_EQ(neighbours[1], grid.find({1, 0, 0}));
  EXPECT_EQ(neighbours[2], grid.count());
  EXPECT_EQ(neighbours[3], grid.find({0, 1, 0}));
  EXPECT_EQ(neighbours[4], first) << "a single periodic layer is its own neighbour";
  EXPECT_EQ(neighbours[5], first);
  EXPECT_EQ(grid.voxels_per_block(), 64);
}

TEST(BlockGrid, MayBeEmpty) {
  const BlockGrid grid({2, 2, 2}, 8, [](glm::ivec3) { return false; });
  EXPECT_EQ(grid.count(), 0);
  EXPECT_TRUE(grid.neighbours().empty());
}

}  // namespace
}  // namespace turbid
