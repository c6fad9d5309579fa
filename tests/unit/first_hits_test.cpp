// SPDX-License-Identifier: Apache-2.0
// First hits that are kept are those of the camera that asks.
#include "host/view/first_hits.h"

#include <gtest/gtest.h>

#include "volumes/solid.h"

namespace turbid {
namespace {

TEST(FirstHits, AreThoseOfTheViewAskedForWhicheverWereAskedForBefore) {
  const TriangleMesh ball = make_sphere(1, Placement{}).mesh;
  const std::vector<RasterMesh> meshes{{&ball, 1}};
  const Box3 box{glm::vec3(-1), glm::vec3(1)};
  const auto view_from = [&](float x, int edge) {
    return camera_view({x, 0, 4}, glm::vec3(0), {0, 1, 0}, 40, edge, edge, box);
  };
  FirstHits hits;
  for (int turn = 0; turn < 3; ++turn) {
    for (const RasterView& view : {view_from(0, 16), view_from(0, 32), view_from(2, 32), view_from(2, 32)}) {
      const RasterImage fresh = rasterise(meshes, view);
      const RasterImage& kept = hits.of(meshes, view);
      EXPECT_EQ(kept.id, fresh.id);
      EXPECT_EQ(kept.position, fresh.position);
    }
  }
}

TEST(FirstHits, OfTheLastTwoViewsAreNotDrawnAgain) {
  TriangleMesh ball = make_sphere(1, Placement{}).mesh;
  const std::vector<RasterMesh> meshes{{&ball, 1}};
  const Box3 box{glm::vec3(-1), glm::vec3(1)};
  const RasterView coarse = camera_view({0, 0, 4}, glm::vec3(0), {0, 1, 0}, 40, 8, 8, box);
  const RasterView fine = camera_view({0, 0, 4}, glm::vec3(0), {0, 1, 0}, 40, 16, 16, box);
  FirstHits hits;
  const std::vector<int> before = hits.of(meshes, coarse).id;
  hits.of(meshes, fine);
  for (glm::vec3& p : ball.positions) p *= 0.1f;
  EXPECT_EQ(hits.of(meshes, coarse).id, before);
  hits.clear();
  EXPECT_NE(hits.of(meshes, coarse).id, before);
}

}  // namespace
}  // namespace turbid
