// SPDX-License-Identifier: Apache-2.0
// What the rasteriser sees of spheres and boxes whose pictures are known exactly.
#include "host/raster/raster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"

namespace turbid {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Latitude-longitude sphere with exact normals; its facets lie inside the sphere by at most r (1 - cos(pi / (2
/// rings))).
TriangleMesh sphere(glm::vec3 centre, float radius, int rings = 128) {
  TriangleMesh mesh;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double theta = kPi * i / rings, phi = 2 * kPi * j / columns;
      mesh.positions.push_back(centre + radius * glm::vec3(std::sin(theta) * std::cos(phi), std::cos(theta),
                                                           -std::sin(theta) * std::sin(phi)));
    }
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const unsigned a = i * columns + j, b = i * columns + (j + 1) % columns, c = a + columns, d = b + columns;
      if (i > 0) mesh.triangles.push_back({a, c, b});
      if (i < rings - 1) mesh.triangles.push_back({b, c, d});
    }
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) mesh.corner_normals.push_back(glm::normalize(mesh.positions[t[k]] - centre));
  return mesh;
}

double facet_depth(double radius, int rings = 128) {
  // A quadrilateral's diagonal spans sqrt(2) steps; the middle of a chord of angle a lies r (1 - cos(a / 2)) inside.
  return radius * (1 - std::cos(kPi / rings * std::sqrt(2.0) / 2));
}

struct Picture {
  RasterImage image;
  RasterView view;
  std::size_t at(int x, int y) const { return std::size_t(y) * image.width + x; }
  long count(int id) const { return std::count(image.id.begin(), image.id.end(), id); }
};

Picture see(const std::vector<RasterMesh>& meshes, const RasterView& view) {
  return {rasterise(meshes, view), view};
}

/// Distance of a point from the ray through a pixel's centre, over the point's distance from the eye.
double off_ray(const RasterView& view, glm::dvec3 point, int x, int y) {
  const glm::dvec4 clip = glm::dmat4(view.projection) * glm::dmat4(view.view) * glm::dvec4(point, 1);
  const double dx = clip.x / clip.w - ((2 * x + 1.0) / view.width - 1);
  const double dy = clip.y / clip.w - (1 - (2 * y + 1.0) / view.height);
  return std::hypot(dx / view.projection[0][0], dy / view.projection[1][1]);
}

const Box3 kUnitBounds{{-1, -1, -1}, {1, 1, 1}};

TEST(Raster, CameraSeesTheSilhouetteOfASphereWhereItsTangentsAre) {
  const TriangleMesh mesh = sphere({0, 0, 0}, 1);
  const int size = 401;
  const Picture p = see({{&mesh, 7}}, camera_view({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 35, size, size, kUnitBounds));
  // tan of the tangent cone's half angle is r / sqrt(d^2 - r^2).
  const double radius = 0.5 * size / std::tan(glm::radians(17.5)) / std::sqrt(15.0);
  int left = size, right = -1, top = size, bottom = -1;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (p.image.id[p.at(x, y)] == 7) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
  // A row's ends are known to one pixel at each end; the facets take off 0.02 pixels.
  EXPECT_NEAR(right - left + 1, 2 * radius, 1.1);
  EXPECT_NEAR(bottom - top + 1, 2 * radius, 1.1);
  EXPECT_EQ(left + right, size - 1);  // an odd size puts the centre on a pixel
  EXPECT_EQ(top + bottom, size - 1);
  // Area of a disc on a lattice: the error grows as radius^(2/3), a few dozen of the 88000 pixels here.
  EXPECT_NEAR(p.count(7), kPi * radius * radius, 60);
  EXPECT_EQ(p.count(7) + p.count(-1), long(size) * size);
}

TEST(Raster, HitsLieOnThePixelRayAndOnTheSphereWithRadialNormals) {
  // Off-centre and far from the origin, so that a loss of precision would show.
  const glm::vec3 centre(30, -20, 10);
  const TriangleMesh mesh = sphere(centre, 2);
  const Box3 box{centre - 2.0f, centre + 2.0f};
  const glm::vec3 eye = centre + glm::vec3(3, 4, 5);
  const Picture p = see({{&mesh, 0}}, camera_view(eye, centre, {0, 1, 0}, 40, 320, 200, box));
  ASSERT_GT(p.count(0), 10000);
  double worst_ray = 0, worst_radius = 0, worst_normal = 1;
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 320; ++x) {
      const std::size_t i = p.at(x, y);
      if (p.image.id[i] < 0) continue;
      const glm::dvec3 from_centre = glm::dvec3(p.image.position[i]) - glm::dvec3(centre);
      worst_ray = std::max(worst_ray, off_ray(p.view, p.image.position[i], x, y));
      worst_radius = std::max(worst_radius, std::abs(glm::length(from_centre) - 2));
      worst_normal = std::min(worst_normal, glm::dot(glm::normalize(from_centre), glm::dvec3(p.image.normal[i])));
      ASSERT_NEAR(glm::length(p.image.normal[i]), 1, 1e-6);  // float rounding of a unit vector
      ASSERT_EQ(p.image.front[i], 1);
    }
  // The stored position is a float: half an ulp of 32 is 2e-6 per coordinate at a distance of 5 to 9.
  EXPECT_LT(worst_ray, 2e-6);
  EXPECT_LT(worst_radius, facet_depth(2) + 1e-5);
  // Interpolated normals err by about an eighth of the facet's angle squared: 1 - cos of 8e-5 is far below this.
  EXPECT_GT(worst_normal, 1 - 1e-6);
}

TEST(Raster, TheCentrePixelHitsTheNearPole) {
  const TriangleMesh mesh = sphere({0, 0, 0}, 1);
  const Picture p = see({{&mesh, 0}}, camera_view({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 35, 101, 101, kUnitBounds));
  const glm::vec3 hit = p.image.position[p.at(50, 50)];
  EXPECT_NEAR(hit.x, 0, 1e-6);  // the picture's centre is the camera's axis
  EXPECT_NEAR(hit.y, 0, 1e-6);
  EXPECT_NEAR(hit.z, 1, 1e-6);  // the pole is a vertex of this mesh
}

TEST(Raster, TheTopRowIsUpAndTheLastColumnIsRight) {
  const TriangleMesh above = sphere({0, 0.7f, 0}, 0.2f, 16), right = sphere({0.7f, 0, 0}, 0.2f, 16);
  const Picture p =
      see({{&above, 1}, {&right, 2}}, camera_view({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 35, 100, 100, kUnitBounds));
  double row = 0, column = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      if (p.image.id[p.at(x, y)] == 1) row += y + 0.5;
      if (p.image.id[p.at(x, y)] == 2) column += x + 0.5;
    }
  // 0.7 at distance 4 is 0.7 / (4 tan 17.5) = 0.555 of the half picture; a perspective sphere is hardly shifted.
  EXPECT_NEAR(row / p.count(1), 50 - 50 * 0.555, 0.6);
  EXPECT_NEAR(column / p.count(2), 50 + 50 * 0.555, 0.6);
}

TEST(Raster, FromInsideEveryPixelSeesAnInnerFace) {
  const TriangleMesh mesh = sphere({0, 0, 0}, 1, 32);
  const glm::vec3 eye(0.3f, 0.1f, -0.2f);
  const Picture p = see({{&mesh, 0}}, camera_view(eye, {1, 0, 0}, {0, 1, 0}, 90, 128, 96, kUnitBounds));
  EXPECT_EQ(p.count(0), 128 * 96);
  EXPECT_EQ(std::count(p.image.front.begin(), p.image.front.end(), 0), 128 * 96);
  for (std::size_t i = 0; i < p.image.id.size(); ++i)  // normals stay outward
    ASSERT_GT(glm::dot(p.image.normal[i], p.image.position[i]), 0.9f);
}

TEST(Raster, NoInnerFacePeepsOutAtTheSilhouetteOfASphereSeenFromOutside) {
  // Large enough that GL's rounding of corners would show some: 4 pixels of each picture, were they not sorted out.
  const TriangleMesh mesh = sphere({0, 0, 0}, 1), wall = sphere({0, 0, -12}, 10);
  const Box3 box{{-10, -10, -22}, {10, 10, 1}};
  for (const bool with_wall : {false, true}) {
    std::vector<RasterMesh> meshes{{&mesh, 0}};
    if (with_wall) meshes.push_back({&wall, 1});
    const Picture p = see(meshes, camera_view({0.1f, 0.2f, 4}, {0, 0, 0}, {0, 1, 0}, 32, 2500, 2500, box));
    for (std::size_t i = 0; i < p.image.id.size(); ++i)
      ASSERT_TRUE(p.image.id[i] < 0 || p.image.front[i] == 1) << "pixel " << i << ", wall " << with_wall;
  }
}

TEST(Raster, TheNearerMeshHidesTheOtherInEitherOrder) {
  const TriangleMesh near_one = sphere({0, 0, 2}, 0.3f, 24), far_one = sphere({0, 0, 0}, 1, 24);
  const Box3 box{{-1, -1, -1}, {1, 1, 2.3f}};
  const RasterView view = camera_view({0, 0, 6}, {0, 0, 0}, {0, 1, 0}, 30, 200, 200, box);
  const Picture a = see({{&near_one, 3}, {&far_one, 9}}, view), b = see({{&far_one, 9}, {&near_one, 3}}, view);
  EXPECT_EQ(a.image.id, b.image.id);
  EXPECT_EQ(a.image.id[a.at(100, 100)], 3);
  EXPECT_EQ(a.count(3), see({{&near_one, 3}}, view).count(3));
  EXPECT_EQ(a.count(3) + a.count(9), see({{&far_one, 9}}, view).count(9));  // the small one lies inside the large disc
}

TEST(Raster, MeshesThatAlmostTouchAreToldApartFarFromTheEye) {
  // A gap of 1e-4 at a distance of 100, with something at 0.02 that pulls the near plane in.
  const TriangleMesh back = sphere({0, 0, 0}, 10, 64), front = sphere({0, 0, 0}, 10.0001f, 64);
  const Box3 box{{-10, -10, -10}, {10, 10, 99.98f}};
  const Picture p = see({{&back, 1}, {&front, 2}}, camera_view({0, 0, 100}, {0, 0, 0}, {0, 1, 0}, 8, 150, 150, box));
  EXPECT_GT(p.count(2), 20000);
  EXPECT_EQ(p.count(1), 0);
}

TEST(Raster, ParallelViewCoversTheSpheresCrossSection) {
  const glm::vec3 centre(1, 2, 3);
  const TriangleMesh mesh = sphere(centre, 0.8f);
  const int size = 500;
  for (const glm::vec3 direction : {glm::vec3(0, -1, 0), glm::vec3(1, 2, -3), glm::vec3(0, 0, 5)}) {
    const Picture p = see({{&mesh, 0}}, parallel_view(direction, centre, 1, size));
    const double pixel = 2.0 / size;
    // Lattice error of a disc of 200 pixels (some 40 pixels of 126000) and 1e-4 for the facets.
    EXPECT_NEAR(p.count(0) * pixel * pixel, kPi * 0.64, 60 * pixel * pixel + 2e-4);
    const glm::vec3 d = glm::normalize(direction);
    const glm::vec3 hit = p.image.position[p.at(size / 2, size / 2)];
    EXPECT_NEAR(glm::dot(hit - centre, d), -0.8, 1e-3);  // lit from where the light comes
    for (std::size_t i = 0; i < p.image.id.size(); ++i) ASSERT_TRUE(p.image.id[i] < 0 || p.image.front[i]);
  }
}

TEST(Raster, ConeViewOpensByTheFullAngle) {
  // From the centre of a sphere all pixels hit it; the middle of the right edge lies at half the angle off the axis.
  const TriangleMesh mesh = sphere({0, 0, 0}, 1);
  const glm::vec3 axis(0, -1, 0);  // parallel to the usual up
  const int size = 64;
  const Picture p = see({{&mesh, 0}}, cone_view({0, 0, 0}, axis, 60, size, kUnitBounds));
  ASSERT_EQ(p.count(0), size * size);
  const auto angle = [&](int x, int y) {
    return std::acos(double(glm::dot(axis, glm::normalize(p.image.position[p.at(x, y)]))));
  };
  // The edge pixel's centre is half a pixel inside, and half a pixel off the middle row.
  const double edge = std::tan(glm::radians(30.0)) * (size - 1) / size, half = std::tan(glm::radians(30.0)) / size;
  EXPECT_NEAR(angle(size - 1, size / 2), std::atan(std::hypot(edge, half)), 1e-5);
  EXPECT_NEAR(angle(size / 2, 0), std::atan(std::hypot(edge, half)), 1e-5);
}

TEST(Raster, ViewsAcceptAnUpVectorAlongTheDirection) {
  const TriangleMesh mesh = sphere({0, 0, 0}, 1, 24);
  for (const glm::vec3 eye : {glm::vec3(0, 5, 0), glm::vec3(0, -5, 0)}) {
    const Picture p = see({{&mesh, 0}}, camera_view(eye, {0, 0, 0}, {0, 1, 0}, 30, 51, 51, kUnitBounds));
    EXPECT_EQ(p.image.id[p.at(25, 25)], 0);
    EXPECT_NEAR(glm::dot(p.image.position[p.at(25, 25)], eye) / 5, 1, 1e-5);
  }
  EXPECT_THROW(camera_view({1, 1, 1}, {1, 1, 1}, {0, 1, 0}, 30, 8, 8, kUnitBounds), InputError);
}

TEST(Raster, NothingIsSeenBehindTheEyeOrWithoutMeshes) {
  const TriangleMesh mesh = sphere({0, 0, 0}, 1, 16);
  EXPECT_EQ(see({{&mesh, 0}}, camera_view({0, 0, 4}, {0, 0, 9}, {0, 1, 0}, 60, 32, 32, kUnitBounds)).count(0), 0);
  EXPECT_EQ(see({}, parallel_view({0, 0, 1}, {0, 0, 0}, 1, 16)).count(-1), 256);
}

TEST(Raster, TiledPicturesHaveNoSeamsAndCallsRepeatToTheBit) {
  // 4100 columns are three tiles; the same view a tile's width at a time must see the same.
  const TriangleMesh mesh = sphere({0, 0, 0}, 1, 64);
  const RasterView wide = camera_view({0, 0, 1.2f}, {0, 0, 0}, {0, 1, 0}, 1, 4100, 40, kUnitBounds);
  const Picture p = see({{&mesh, 0}}, wide);
  EXPECT_EQ(p.count(0), 4100 * 40);  // 1 degree high, 84 wide; the sphere spans 113
  for (int x = 1; x < 4100; ++x) {
    const glm::vec3 a = p.image.position[p.at(x - 1, 20)], b = p.image.position[p.at(x, 20)];
    ASSERT_LT(off_ray(wide, b, x, 20), 1e-6);
    ASSERT_GT(b.x, a.x);
  }
  const Picture again = see({{&mesh, 0}}, wide);
  EXPECT_EQ(p.image.id, again.image.id);
  EXPECT_EQ(p.image.position, again.image.position);
  EXPECT_EQ(p.image.normal, again.image.normal);
}

TEST(Raster, TriangleNumbersSurviveSeveralDrawCallsAndMeshes) {
  // 2 x 180000 triangles: more than one batch each, and the second mesh's numbers start in the middle of one.
  const TriangleMesh first = sphere({-1, 0, 0}, 0.9f, 300), second = sphere({1, 0, 0}, 0.9f, 300);
  const Box3 box{{-2, -1, -1}, {2, 1, 1}};
  const Picture p = see({{&first, 0}, {&second, 1}}, camera_view({0, 0, 9}, {0, 0, 0}, {0, 1, 0}, 20, 400, 200, box));
  // At the silhouette a hit may lie off its triangle by the 256th of a pixel to which GL rounds corners.
  const double snap = 8.1 * 2 * std::tan(glm::radians(10.0)) / 200 / 256;
  for (std::size_t i = 0; i < p.image.id.size(); ++i) {
    if (p.image.id[i] < 0) continue;
    const glm::vec3 centre(p.image.id[i] == 0 ? -1 : 1, 0, 0);
    ASSERT_NEAR(glm::length(p.image.position[i] - centre), 0.9, facet_depth(0.9, 300) + 2 * snap);
    ASSERT_GT(glm::dot(p.image.normal[i], p.image.position[i] - centre), 0.899f);
  }
}

}  // namespace
}  // namespace turbid
