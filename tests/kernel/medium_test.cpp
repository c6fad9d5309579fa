// SPDX-License-Identifier: Apache-2.0
// Sampling of the medium on the device: cells, interpolation, who owns a point.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/paths.h"
#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

using F = cl::Buffer<float>;
using Bytes = cl::Buffer<std::byte>;
using I = cl::Buffer<int>;

struct Sample {
  int block, node;
  glm::vec3 fraction;
  int region;
  glm::vec4 index, surface;
  float sigma_s, sigma_a, room;
};

std::vector<Sample> sample(const DeviceMedium& medium, const std::vector<glm::vec3>& points, int body = 0) {
  cl::Session& session = test::session();
  const cl::Program program = session.build(test::test_kernel("probe_medium.cl"), medium.defines());
  cl::Kernel<cl::Buffer<RegionParams>, I, I, F, Bytes, Bytes, F, F, int, int> kernel(program, "probe_point");
  std::vector<float> in;
  for (const glm::vec3& p : points) in.insert(in.end(), {p.x, p.y, p.z});
  const F input = session.upload(in);
  const F output = session.zeros<float>(17 * points.size());
  kernel.enqueue(session.march_queue(), {points.size()}, {1}, medium.regions_buffer, medium.tile_map_buffer,
                 medium.block_region_buffer, medium.distance_tiles, medium.index_tiles.bytes, medium.coefficient_tiles.bytes, input,
                 output, body, static_cast<int>(points.size()));
  const std::vector<float> out = session.read(session.march_queue(), output);
  std::vector<Sample> result;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const float* a = out.data() + 17 * i;
    result.push_back({static_cast<int>(a[0]),
                      static_cast<int>(a[1]),
                      {a[2], a[3], a[4]},
                      static_cast<int>(a[5]),
                      {a[6], a[7], a[8], a[9]},
                      {a[10], a[11], a[12], a[13]},
                      a[14],
                      a[15],
                      a[16]});
  }
  return result;
}

std::vector<glm::vec3> random_points(glm::vec3 lower, glm::vec3 upper, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<glm::vec3> points;
  for (int i = 0; i < count; ++i)
    points.push_back(lower + (upper - lower) * glm::vec3(unit(random), unit(random), unit(random)));
  return points;
}

TEST(MediumSampling, CellsCoverTheDomainAndItsFacesHoldTheOutermostNode) {
  const DeviceMedium medium = test::graded_domain({16, 24, 8}, [](glm::dvec3) { return 1.0; });
  std::vector<glm::vec3> points = random_points(glm::vec3(0), glm::vec3(16, 24, 8), 500, 3);
  points.insert(points.end(), {{0, 0, 0},
                               {16, 24, 8},
                               {0.5f, 0.5f, 0.5f},
                               {15.5f, 23.5f, 7.5f},
                               {8.5f, 8.5f, 4},
                               {8.4999f, 16.5f, 7.9f},
                               {-1e-3f, 25, 4},
                               {17, -1, 9}});
  const auto samples = sample(medium, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Sample& s = samples[i];
    ASSERT_GE(s.block, 0);
    ASSERT_LT(s.block, 2 * 3 * 1);
    const glm::ivec3 block(s.block % 2, s.block / 2 % 3, s.block / 6), node(s.node % 9, s.node / 9 % 9, s.node / 81);
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_LE(node[axis], 7);
      ASSERT_LT(8 * block[axis] + node[axis],
                medium.frame.voxels[axis] - 1);  // the cell's upper node lies in the domain
      ASSERT_GE(s.fraction[axis], 0.0f);
      ASSERT_LE(s.fraction[axis], 1.0f);
      const float expected = std::clamp(points[i][axis] - 0.5f, 0.0f, medium.frame.voxels[axis] - 1.0f);
      ASSERT_NEAR(8 * block[axis] + node[axis] + s.fraction[axis], expected, 2e-6);  // rounding of positions up to 24
    }
  }
}

TEST(MediumSampling, LinearFieldsAreReproduced) {
  // Integer slopes and positions on a grid of 1/16: every product and sum is exact in single precision.
  cl::Session& session = test::session();
  const DeviceMedium medium = test::graded_domain({16, 16, 8}, [](glm::dvec3) { return 1.0; });
  auto field = [](glm::vec3 p, int k) { return static_cast<float>(1 + k) * p.x - 2.0f * p.y + 3.0f * p.z + k; };
  std::vector<float> tiles;
  for (int block = 0; block < 4; ++block) {
    for (int i = 0; i < TURBID_TILE_NODES; ++i) {
      const glm::vec3 node(8 * (block % 2) + i % 9 + 0.5f, 8 * (block / 2) + i / 9 % 9 + 0.5f, i / 81 + 0.5f);
      for (int k = 0; k < 4; ++k) tiles.push_back(field(node, k));
    }
  }
  std::vector<glm::vec3> points;
  std::vector<float> in;
  for (const glm::vec3& p : random_points(glm::vec3(0.5f), glm::vec3(15.5f, 15.5f, 7.5f), 500, 4)) {
    points.push_back(glm::round(16.0f * p) / 16.0f);
    for (int axis = 0; axis < 3; ++axis) in.push_back(points.back()[axis]);
  }
  const cl::Program program = session.build(test::test_kernel("probe_medium.cl"), medium.defines());
  cl::Kernel<F, F, F, int> kernel(program, "probe_interpolate");
  const F nodes = session.upload(tiles), input = session.upload(in), output = session.zeros<float>(4 * points.size());
  kernel.enqueue(session.march_queue(), {points.size()}, {1}, nodes, input, output, static_cast<int>(points.size()));
  const std::vector<float> out = session.read(session.march_queue(), output);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int k = 0; k < 4; ++k) ASSERT_EQ(out[4 * i + k], field(points[i], k)) << i;
  }
}

TEST(MediumSampling, WithinTheRoomOfAPointTheRegionIsTheSame) {
  // Edges and a round surface, neither along the grid's axes.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  Placement turned = test::at(glm::vec3(16, 15, 16));
  turned.rotation = glm::mat3(glm::rotate(glm::mat4(1), 0.7f, glm::normalize(glm::vec3(1, 2, 3))));
  test::add_body(scene, make_box(glm::vec3(12), turned), test::make_material({.eta = 1.3f}));
  test::add_body(scene, make_sphere(5, test::at(glm::vec3(22, 18, 17))), test::make_material({.eta = 1.5f}));
  const MediumVolume volume = voxelise(scene);
  const DeviceMedium medium = upload_medium(test::session(), volume, scene_features(volume, {}));
  const auto points = random_points(glm::vec3(1), glm::vec3(31), 40000, 6);
  const auto samples = sample(medium, points);
  const auto offsets = random_points(glm::vec3(-1), glm::vec3(1), 40000, 7);
  std::vector<glm::vec3> others;
  for (std::size_t i = 0; i < points.size(); ++i) {
    others.push_back(points[i] + 0.9999f * std::min(samples[i].room, 8.0f) * glm::normalize(offsets[i]));
  }
  const auto there = sample(medium, others);
  int asked = 0, far = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (there[i].block != samples[i].block || samples[i].room > 8.0f) continue;
    ASSERT_EQ(there[i].region, samples[i].region) << i;
    ++asked;
    far += samples[i].room > 3.0f;
  }
  EXPECT_GT(asked, 5000);
  EXPECT_GT(far, 100) << "distances reach four voxels: room should come near that";
}

TEST(MediumSampling, TheBodyThatStandsLaterInTheSceneOwnsAPoint) {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(10, test::at(glm::vec3(16))), test::make_material({.eta = 1.3f}));
  test::add_body(scene, make_sphere(6, test::at(glm::vec3(12, 16, 16))), test::make_material({.eta = 1.5f}));
  test::add_body(scene, make_box(glm::vec3(6), test::at(glm::vec3(16, 24, 16))), test::make_material({.eta = 1.7f}));
  const MediumVolume volume = voxelise(scene);
  const DeviceMedium medium = upload_medium(test::session(), volume, scene_features(volume, {}));
  const auto points = random_points(glm::vec3(1), glm::vec3(31), 4000, 5);
  const auto samples = sample(medium, points);
  int seen[4] = {0, 0, 0, 0};
  for (std::size_t i = 0; i < points.size(); ++i) {
    int expected = 0;
    bool near_surface = false;
    for (int body = 1; body <= 3; ++body) {
      const float d = scene.bodies[body - 1].solid.signed_distance(points[i]);
      if (d < 0) expected = body;
      near_surface =
          near_surface || std::abs(d) < 0.3f;  // trilinear interpolation rounds the box's edges by up to that
    }
    if (near_surface) continue;
    ASSERT_EQ(samples[i].region, expected) << i;
    ++seen[expected];
    ASSERT_NEAR(std::sqrt(2 * samples[i].index.w), volume.region(expected).eta, 1e-6);
  }
  for (int region = 0; region < 4; ++region) EXPECT_GT(seen[region], 10) << region;
}

TEST(MediumSampling, TouchingBodiesLeaveNoGapBetweenThem) {
  // Faces that coincide on a voxel's face, on its centre and where blocks of cells end, and that rounding has drawn
  // apart.
  for (const float face : {12.0f, 12.5f, 16.5f, 14.3f}) {
    for (const float gap : {0.0f, 1e-5f, 4e-3f}) {
      for (const bool reversed : {false, true}) {
        MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
        const auto layer = [&](float lower, float upper, float eta) {
          test::add_body(scene, make_box({100, 100, upper - lower}, test::at({16, 16, 0.5f * (lower + upper)})),
                         test::make_material({.sigma_s = glm::vec3(1), .eta = eta}));
        };
        if (!reversed) layer(4, face - 0.5f * gap, 1.5f);
        layer(face + 0.5f * gap, 28, 1.3f);
        if (reversed) layer(4, face - 0.5f * gap, 1.5f);
        const MediumVolume volume = voxelise(scene);
        std::vector<glm::vec3> points{{16, 16, face}};
        for (int i = -50; i <= 50; ++i) points.emplace_back(16.2f, 15.7f, face + 2e-4f * static_cast<float>(i));
        for (const Sample& s : sample(upload_medium(test::session(), volume, scene_features(volume, {})), points))
          ASSERT_GT(s.region, 0) << "face " << face << ", gap " << gap << ", reversed " << reversed;
        std::vector<int> owner(24);
        volume.read_owner({16, 16, 4}, {1, 1, 24}, owner);
        for (const int region : owner) ASSERT_GT(region, 0) << "face " << face << ", gap " << gap;
      }
    }
  }
}

TEST(MediumSampling, SignedDistancesOfASphereAreSecondOrder) {
  // Trilinear interpolation of |x| - R: error <= h^2/8 times the curvatures' sum 2/R, 0.03 voxel at R = 8.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(8, test::at(glm::vec3(16))), test::make_material({.eta = 1.3f}));
  const MediumVolume volume = voxelise(scene);
  const DeviceMedium medium = upload_medium(test::session(), volume, scene_features(volume, {}));
  std::vector<glm::vec3> points;
  for (const glm::vec3& p : random_points(glm::vec3(-1), glm::vec3(1), 500, 6)) {
    if (glm::length(p) > 0.1f) points.push_back(glm::vec3(16) + 8.0f * glm::normalize(p));
  }
  const auto samples = sample(medium, points, 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NEAR(samples[i].surface.w, 0, 0.032);
    const glm::vec3 normal = glm::normalize(glm::vec3(samples[i].surface));
    ASSERT_GT(glm::dot(normal, glm::normalize(points[i] - glm::vec3(16))), 0.9998f);  // 1.1 degrees at R = 8
  }
}

TEST(MediumSampling, VaryingCoefficientsAreInterpolatedPerVoxelEdge) {
  // A linear field must come back linear, in units of one voxel edge (h = 0.5).
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 0.5f);
  Material material = test::make_material({});
  material.sigma_s = expression_field("1 + x");
  material.sigma_a = expression_field("2 + y");
  test::set_ambient(scene, material);
  const MediumVolume volume = voxelise(scene);
  const DeviceMedium medium = upload_medium(test::session(), volume, scene_features(volume, {}));
  const auto points = random_points(glm::vec3(0.5f), glm::vec3(15.5f), 200, 7);
  const auto samples = sample(medium, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NEAR(samples[i].sigma_s, 0.5f * (1 + 0.5f * points[i].x), 2e-6);  // rounding of values up to 5
    ASSERT_NEAR(samples[i].sigma_a, 0.5f * (2 + 0.5f * points[i].y), 2e-6);
  }
}

TEST(MediumSampling, HalfPrecisionKeepsElevenBitsOfIndexAndCoefficientsHoweverSmall) {
  // Rounding to nearest errs by at most 2^-11 of a node's value; weights are positive. Grey, and three colours.
  for (const int channels : {1, 3}) {
    MediumDescription scene = test::empty_domain(glm::ivec3(16), 0.5f);
    Material material = test::make_material({});
    material.sigma_s = expression_field("3e-4 * exp(x)");
    material.sigma_a = expression_field("1e-7 * (2 + y)");
    material.eta = expression_field("1.3 + 0.01*x*x + 0.02*y");
    test::set_ambient(scene, material);
    const MediumVolume volume = voxelise(scene);
    SceneFeatures features = scene_features(volume, {});
    features.channels = channels;
    const DeviceMedium full = upload_medium(test::session(), volume, features);
    const DeviceMedium half = upload_medium(test::session(), volume, features, Storage::half_precision);
    EXPECT_EQ(2 * half.coefficient_tiles.bytes.bytes(), full.coefficient_tiles.bytes.bytes());
    EXPECT_EQ(2 * half.index_tiles.bytes.bytes(), full.index_tiles.bytes.bytes());
    EXPECT_EQ(full.storage_error(), 0);
    EXPECT_GT(half.coefficient_tiles.rounding, 5e-5) << "a quarter of 2^-11 is the root mean square of rounding errors, about";
    EXPECT_LT(half.coefficient_tiles.rounding, 4.9e-4);
    const auto points = random_points(glm::vec3(0), glm::vec3(16), 200, 8);
    const auto exact = sample(full, points), rounded = sample(half, points);
    constexpr float kRound = 1.001f / 2048;
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(rounded[i].sigma_s, exact[i].sigma_s, kRound * exact[i].sigma_s);
      ASSERT_NEAR(rounded[i].sigma_a, exact[i].sigma_a, kRound * exact[i].sigma_a);
      for (int k = 0; k < 4; ++k) ASSERT_NEAR(rounded[i].index[k], exact[i].index[k], kRound * std::abs(exact[i].index[k]) + 1e-8f);
    }
    EXPECT_NE(rounded[0].sigma_s, exact[0].sigma_s);
  }
}

}  // namespace
}  // namespace turbid
