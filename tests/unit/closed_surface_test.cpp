// SPDX-License-Identifier: Apache-2.0
// Closed surfaces in memory: repairs, cavities, corner normals and placement.
#include <gtest/gtest.h>

#include <cmath>

#include "host/base/errors.h"
#include "tests/unit/mesh_shapes.h"

namespace turbid {
namespace {

TEST(ClosedSurface, UnusedPointsAreDroppedWithAWarning) {
  TriangleMesh mesh = cube(1);
  mesh.positions.insert(mesh.positions.begin(), glm::vec3(NAN));
  for (glm::uvec3& t : mesh.triangles) t += 1u;
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_EQ(mesh.positions.size(), 8u);
  EXPECT_EQ(warnings, std::vector<std::string>{"cube: dropped 1 point that no triangle uses"});
  EXPECT_FLOAT_EQ(bounds(mesh).upper.x, 1);
}

TEST(ClosedSurface, ASliverBetweenThreePointsOnALineIsFlippedAwayNotCutOut) {
  // Face z = 0 of a tetrahedron has a fourth point (0.5, 0, 0) on its edge, closed by a triangle without area.
  TriangleMesh mesh;
  mesh.name = "sliver";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 4}, {0, 4, 3}, {4, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_EQ(mesh.triangles.size(), 6u);
  EXPECT_DOUBLE_EQ(volume(mesh), 1.0 / 6);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    EXPECT_GT(glm::length(glm::cross(b - a, c - a)), 0.4f);  // twice the area; the smallest half face has 1/4
  }
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("flipped 1 edge"), std::string::npos);
}

TEST(ClosedSurface, CracksBelowAMillionthOfTheSizeAreWeldedWithAWarningLargerOnesAreHoles) {
  for (const float crack : {1e-6f, 1e-4f}) {  // the cube's diagonal is 3.46
    TriangleMesh mesh = cube(1);
    mesh.positions.push_back(mesh.positions[7] + glm::vec3(crack, 0, 0));
    mesh.triangles[2].z = 8;  // one of the triangles at corner 7 has its own
    std::vector<std::string> warnings;
    if (crack > 3.5e-6f) {
      EXPECT_THROW(require_closed_surface(mesh, warnings), InputError);
      continue;
    }
    require_closed_surface(mesh, warnings);
    EXPECT_EQ(mesh.positions.size(), 8u);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("welding"), std::string::npos);
  }
}

TEST(ClosedSurface, CoincidentTrianglesAreRemovedWhereThatLeavesAClosedSurface) {
  TriangleMesh twice = cube(1);
  twice.triangles.insert(twice.triangles.end(), twice.triangles.begin(), twice.triangles.begin() + 5);
  std::vector<std::string> warnings;
  require_closed_surface(twice, warnings);
  EXPECT_EQ(twice.triangles.size(), 12u);
  EXPECT_NE(warnings.at(0).find("5 duplicate triangles"), std::string::npos);

  TriangleMesh joined = cube(1);  // two cubes side by side, with the wall between them from both
  add_cube(joined, 1, true, {2, 0, 0});
  joined.triangles[2] = {1, 3, 7};  // cut the wall along the same diagonal: 1-7 here, 0-6 of the second cube there
  warnings.clear();
  require_closed_surface(joined, warnings);
  EXPECT_EQ(joined.triangles.size(), 20u);
  EXPECT_NEAR(volume(joined), 16, 1e-9);  // integers divided by 6
  EXPECT_NE(warnings.at(0).find("walls without thickness"), std::string::npos);
}

TEST(ClosedSurface, ACavityStaysACavity) {
  TriangleMesh mesh = cube(2);
  add_cube(mesh, 1, false, {0.3f, 0.2f, 0.1f});
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_NEAR(volume(mesh), 64 - 8, 1e-5);  // coordinates such as 1.3 are rounded to single precision
  EXPECT_TRUE(warnings.empty());
}

TEST(ClosedSurface, AnInsideOutBodyWithACavityIsTurnedAsAWhole) {
  TriangleMesh mesh = cube(2, false);
  add_cube(mesh, 1, true);
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_NEAR(volume(mesh), 64 - 8, 1e-9);  // integers divided by 6
  EXPECT_EQ(warnings.size(), 2u);
}

TEST(ClosedSurface, ABodyInTheCavityOfABodyPointsOutwardAgain) {
  TriangleMesh mesh = cube(3);
  add_cube(mesh, 2, false);
  add_cube(mesh, 1, false);  // wrong
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_NEAR(volume(mesh), 216 - 64 + 8, 1e-9);  // a sum of small integers, each divided by 6
  EXPECT_EQ(warnings, std::vector<std::string>{"cube: turned 1 inside-out component outward"});
}

TEST(ClosedSurface, OverlappingBodiesAreNotCavities) {
  TriangleMesh mesh = cube(2);
  add_cube(mesh, 1, true, {1.9f, 0.1f, 0.2f});
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_NEAR(volume(mesh), 64 + 8, 1e-5);
  EXPECT_TRUE(warnings.empty());
}

TEST(ClosedSurface, ASheetWithoutThicknessNextToABodyIsRemoved) {
  TriangleMesh mesh = cube(1);
  mesh.positions.insert(mesh.positions.end(), {{3, 0, 0}, {4, 0, 0}, {3, 1, 0}});
  mesh.triangles.insert(mesh.triangles.end(), {{8, 9, 10}, {8, 10, 9}});
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.positions.size(), 8u);
  EXPECT_NE(warnings.at(0).find("1 component without volume"), std::string::npos);
}

TEST(ClosedSurface, TwoBodiesThatTouchInOnePointAreAccepted) {
  TriangleMesh mesh = cube(1);
  add_cube(mesh, 1, true, {2, 2, 2});
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  EXPECT_EQ(mesh.positions.size(), 15u);
  EXPECT_TRUE(warnings.empty());
}

TEST(ClosedSurface, RepairingTwiceChangesNothing) {
  TriangleMesh mesh = cube(1, false);
  std::vector<std::string> warnings;
  require_closed_surface(mesh, warnings);
  const TriangleMesh first = mesh;
  warnings.clear();
  require_closed_surface(mesh, warnings);
  EXPECT_EQ(mesh.positions, first.positions);
  EXPECT_EQ(mesh.triangles, first.triangles);
  EXPECT_EQ(mesh.corner_normals, first.corner_normals);
  EXPECT_TRUE(warnings.empty());
}

TEST(CornerNormals, OfACubeAreItsFaceNormals) {
  TriangleMesh mesh = cube(1);
  compute_corner_normals(mesh);
  ASSERT_EQ(mesh.corner_normals.size(), 36u);
  for (std::size_t c = 0; c < 36; ++c) {
    const glm::uvec3 t = mesh.triangles[c / 3];
    const glm::vec3 centroid = (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0f;
    for (int k = 0; k < 3; ++k)  // the face's axis is the one at +-1
      EXPECT_FLOAT_EQ(mesh.corner_normals[c][k], std::abs(centroid[k]) > 0.99f ? std::copysign(1.0f, centroid[k]) : 0);
  }
}

TEST(CornerNormals, DoNotDependOnHowAFaceIsCutIntoTriangles) {
  TriangleMesh mesh = cube(1);
  compute_corner_normals(mesh, 180.0f);  // no creases: a corner of the cube sees three right angles, however cut
  for (std::size_t c = 0; c < 36; ++c) {
    const glm::vec3 diagonal = glm::normalize(mesh.positions[mesh.triangles[c / 3][static_cast<int>(c % 3)]]);
    EXPECT_LT(glm::distance(mesh.corner_normals[c], diagonal), 1e-6f);  // a few roundings
  }
}

TEST(CornerNormals, SplitAtTheCreaseAngle) {
  TriangleMesh mesh = cube(1);  // faces meet at 90 degrees
  compute_corner_normals(mesh, 89.0f);
  EXPECT_FLOAT_EQ(std::abs(mesh.corner_normals[0].x), 1);
  compute_corner_normals(mesh, 91.0f);
  EXPECT_LT(std::abs(mesh.corner_normals[0].x), 0.6f);
}

TEST(Transform, PlacesPositionsAndKeepsTheSurfaceOutwardEvenUnderAReflection) {
  TriangleMesh mesh = cube(1);
  compute_corner_normals(mesh);
  transform(mesh, glm::mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1), 3, {10, 20, 30});
  EXPECT_EQ(bounds(mesh).lower, glm::vec3(7, 17, 27));
  EXPECT_EQ(bounds(mesh).upper, glm::vec3(13, 23, 33));
  EXPECT_NEAR(volume(mesh), 216, 1e-9);  // integers: exact up to the division by 6
  for (std::size_t c = 0; c < 36; ++c) {
    const glm::vec3 from_centre =
        mesh.positions[mesh.triangles[c / 3][static_cast<int>(c % 3)]] - glm::vec3(10, 20, 30);
    EXPECT_FLOAT_EQ(glm::dot(mesh.corner_normals[c], from_centre), 3);
  }
}

}  // namespace
}  // namespace turbid
