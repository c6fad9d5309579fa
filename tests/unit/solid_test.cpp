// SPDX-License-Identifier: Apache-2.0
// Primitive bodies: their triangles close and have the volume and area of the shape, their distances are distances.
#include "volumes/solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "host/base/errors.h"
#include "tests/unit/mesh_shapes.h"

namespace turbid {
namespace {

constexpr double pi = std::numbers::pi;

Placement tilted(float scale = 2.5f) {
  Placement placement;
  placement.rotation = glm::mat3(glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(1, 2, -0.5f))));
  placement.scale = scale;
  placement.translation = {3, -4, 5};
  return placement;
}

struct Named {
  const char* name;
  Solid solid;
  glm::vec3 centre;
  float size;  ///< half the longest extent [scene units]
};

std::vector<Named> primitives() {
  std::vector<Named> all;
  for (const Placement& p : {Placement{}, tilted()}) {
    all.push_back({"sphere", make_sphere(1.5f, p), p.translation, 1.5f * p.scale});
    all.push_back({"box", make_box({1, 2, 3}, p), p.translation, 1.5f * p.scale});
    all.push_back({"cylinder", make_cylinder(1, 3, p), p.translation, 1.5f * p.scale});
  }
  return all;
}

TEST(Solid, EveryPrimitiveIsClosedAndOutwardAsItIs) {
  for (Named& p : primitives()) {
    TriangleMesh checked = p.solid.mesh;
    std::vector<std::string> warnings;
    require_closed_surface(checked, warnings);  // throws, or warns, if there is anything to repair
    EXPECT_TRUE(warnings.empty()) << p.name << ": " << warnings[0];
    EXPECT_EQ(checked.triangles, p.solid.mesh.triangles) << p.name;
    EXPECT_EQ(checked.positions, p.solid.mesh.positions) << p.name;
  }
}

TEST(Solid, CornerNormalsAreUnitAndPointToWhereTheDistanceGrows) {
  for (const Named& p : primitives()) {
    const TriangleMesh& mesh = p.solid.mesh;
    ASSERT_EQ(mesh.corner_normals.size(), 3 * mesh.triangles.size());
    for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c) {
      const glm::vec3 x = mesh.positions[mesh.triangles[c / 3][static_cast<int>(c % 3)]], n = mesh.corner_normals[c];
      ASSERT_NEAR(glm::length(n), 1, 1e-6) << p.name;  // a few roundings
      ASSERT_GT(p.solid.signed_distance(x + 0.01f * p.size * n), 0.005f * p.size) << p.name;
      // Backwards is inside, or, from an edge, along the neighbouring face: zero up to the rounding of coordinates.
      ASSERT_LT(p.solid.signed_distance(x - 0.01f * p.size * n), 5e-6f) << p.name;
    }
  }
}

TEST(Solid, TheDistanceIsZeroAtTheVertices) {
  for (const Named& p : primitives())
    for (const glm::vec3& x : p.solid.mesh.positions) {
      if (glm::distance(x, p.centre) < 0.999f * p.size && std::string(p.name) == "sphere")
        FAIL() << "not on the sphere";
      // Coordinates of up to 9 in single precision: an error of 2^-21 each, some of them added.
      ASSERT_NEAR(p.solid.signed_distance(x), 0, 5e-6) << p.name;
    }
}

TEST(Solid, TheDistanceHasUnitGradientAwayFromEdgesAndMedialAxes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> coordinate(-1.6f, 1.6f);
  for (const Named& p : primitives()) {
    int off = 0;
    constexpr int points = 2000;
    for (int i = 0; i < points; ++i) {
      const glm::vec3 x = p.centre + p.size * glm::vec3(coordinate(random), coordinate(random), coordinate(random));
      const float h = 0.005f * p.size;
      glm::vec3 gradient;
      for (int k = 0; k < 3; ++k) {
        glm::vec3 e(0);
        e[k] = h;
        gradient[k] = (p.solid.signed_distance(x + e) - p.solid.signed_distance(x - e)) / (2 * h);
      }
      off += std::abs(glm::length(gradient) - 1) > 1e-3f;  // 2nd differences h^2 / r^2 and rounding 1e-6 / h stay below
    }
    EXPECT_LT(off, points / 20) << p.name;  // those within h of where the gradient jumps
  }
}

TEST(Solid, TheDistanceScalesAndMovesWithThePlacement) {
  const Placement placed = tilted();
  const std::vector<std::pair<Solid, Solid>> pairs = {{make_sphere(1, {}), make_sphere(1, placed)},
                                                      {make_box({1, 2, 3}, {}), make_box({1, 2, 3}, placed)},
                                                      {make_cylinder(1, 2, {}), make_cylinder(1, 2, placed)}};
  for (const auto& [plain, moved] : pairs)
    for (const glm::vec3 x : {glm::vec3(0), glm::vec3(0.3f, -0.2f, 0.9f), glm::vec3(2, 3, -1), glm::vec3(0, 1.5f, 0)}) {
      const glm::vec3 y = placed.rotation * (placed.scale * x) + placed.translation;
      EXPECT_NEAR(moved.signed_distance(y), placed.scale * plain.signed_distance(x), 1e-5) << plain.mesh.name;
    }
}

TEST(Sphere, HasTheVolumeAreaAndNormalsOfASphere) {
  const float radius = 2;
  const TriangleMesh mesh = make_sphere(radius, {}).mesh;
  // Inscribed: the triangles' edges are at most 0.0414 radii long, so they lie at most 0.0414^2 / 6 = 2.9e-4 radii
  // below the sphere, which is at most 8.6e-4 of the volume and 5.8e-4 of the area.
  EXPECT_LT(volume(mesh), 4 * pi / 3 * 8);
  EXPECT_NEAR(volume(mesh) / (4 * pi / 3 * 8), 1, 8.6e-4);
  EXPECT_LT(area(mesh), 4 * pi * 4);
  EXPECT_NEAR(area(mesh) / (4 * pi * 4), 1, 5.8e-4);
  for (const glm::vec3& p : mesh.positions) ASSERT_NEAR(glm::length(p), radius, 1e-6);
  for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c) {
    const glm::vec3 p = mesh.positions[mesh.triangles[c / 3][static_cast<int>(c % 3)]];
    ASSERT_LT(glm::distance(mesh.corner_normals[c], p / radius), 1e-6f);
  }
}

TEST(Sphere, KeepsRadialNormalsWherePlaced) {
  const Placement placement = tilted();
  const TriangleMesh mesh = make_sphere(1, placement).mesh;
  for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c) {
    const glm::vec3 p = mesh.positions[mesh.triangles[c / 3][static_cast<int>(c % 3)]];
    ASSERT_LT(glm::distance(mesh.corner_normals[c], (p - placement.translation) / placement.scale), 2e-6f);
  }
}

TEST(Box, HasItsVolumeAreaAndDistances) {
  const Solid box = make_box({1, 2, 4}, {});
  EXPECT_EQ(box.mesh.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(volume(box.mesh), 8);
  EXPECT_DOUBLE_EQ(area(box.mesh), 2 * (2 + 4 + 8));
  EXPECT_FLOAT_EQ(box.signed_distance({0, 0, 0}), -0.5f);
  EXPECT_FLOAT_EQ(box.signed_distance({0, 0.9f, 0}), -0.1f);
  EXPECT_FLOAT_EQ(box.signed_distance({3.5f, 5, 2}), 5);  // to the edge: sides 3 and 4
  EXPECT_FLOAT_EQ(box.signed_distance({1.5f, 3, 4}), 3);  // to the corner: sides 1, 2, 2
}

TEST(Cylinder, HasItsVolumeAreaAndDistances) {
  const Solid cylinder = make_cylinder(2, 3, {});
  // A prism over a regular polygon of n corners has area n/2 r^2 sin(2 pi/n) = pi r^2 (1 - (2 pi/n)^2 / 6); n >= 96.
  EXPECT_NEAR(volume(cylinder.mesh) / (pi * 4 * 3), 1, 7.2e-4);
  EXPECT_LT(volume(cylinder.mesh), pi * 4 * 3);
  EXPECT_NEAR(area(cylinder.mesh) / (2 * pi * 4 + 4 * pi * 3), 1, 7.2e-4);
  EXPECT_FLOAT_EQ(bounds(cylinder.mesh).upper.y, 1.5f);
  EXPECT_FLOAT_EQ(cylinder.signed_distance({0, 0, 0}), -1.5f);
  EXPECT_FLOAT_EQ(cylinder.signed_distance({1.2f, 0, -1.6f}), 0);
  EXPECT_FLOAT_EQ(cylinder.signed_distance({0, -4, 0}), 2.5f);
  EXPECT_FLOAT_EQ(cylinder.signed_distance({3, 5.5f, 4}), 5);  // to the rim: sides 3 and 4
}

TEST(Cylinder, IsRoundAtTheSideAndSharpAtTheCaps) {
  const TriangleMesh mesh = make_cylinder(2, 3, {}).mesh;
  for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c) {
    const glm::uvec3 t = mesh.triangles[c / 3];
    const glm::vec3 p = mesh.positions[t[static_cast<int>(c % 3)]];
    const bool cap = mesh.positions[t.x].y == mesh.positions[t.y].y && mesh.positions[t.y].y == mesh.positions[t.z].y;
    const glm::vec3 exact = cap ? glm::vec3(0, std::copysign(1.0f, p.y), 0) : glm::vec3(p.x, 0, p.z) / 2.0f;
    ASSERT_LT(glm::distance(mesh.corner_normals[c], exact),
              2e-6f);  // equal angles on both sides: only rounding remains
  }
}

TEST(Solid, SizesThatAreNotPositiveAreRefused) {
  EXPECT_THROW(make_sphere(0, {}), InputError);
  EXPECT_THROW(make_sphere(NAN, {}), InputError);
  EXPECT_THROW(make_box({1, -1, 1}, {}), InputError);
  EXPECT_THROW(make_cylinder(1, INFINITY, {}), InputError);
  Placement flat;
  flat.scale = 0;
  EXPECT_THROW(make_box({1, 1, 1}, flat), InputError);
}

TEST(MeshSolid, IsPlacedAndLeavesTheDistanceToTheVoxels) {
  const Placement placement = tilted();
  const Solid solid = make_mesh_solid(make_box({1, 2, 4}, {}).mesh, placement);
  EXPECT_FALSE(solid.signed_distance);
  const TriangleMesh expected = make_box({1, 2, 4}, placement).mesh;
  EXPECT_EQ(solid.mesh.positions, expected.positions);
  EXPECT_EQ(solid.mesh.corner_normals, expected.corner_normals);
}

}  // namespace
}  // namespace turbid
