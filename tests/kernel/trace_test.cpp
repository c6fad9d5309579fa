// SPDX-License-Identifier: Apache-2.0
// Steps of rays: straight where the index is constant, curved by drift-kick-drift where it is graded, stopped at
// surfaces and at the domain's faces.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/paths.h"
#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

using F = cl::Buffer<float>;
using Bytes = cl::Buffer<std::byte>;
using I = cl::Buffer<int>;

struct StepResult {
  int event;
  float length;
  glm::vec3 middle;
  int next_region, surface;
  glm::vec3 beyond;
  int face;
  glm::vec3 x;
};
constexpr int kNone = 0, kSurface = 1, kFace = 2;

std::vector<StepResult> step_once(const DeviceMedium& medium, const std::vector<test::ProbeRay>& rays, float step,
                                  float grace = 0) {
  cl::Session& session = test::session();
  const cl::Program program = session.build(test::test_kernel("probe_medium.cl"), medium.defines());
  cl::Kernel<cl::Buffer<RegionParams>, I, I, F, Bytes, Bytes, F, float, F, int> kernel(program, "probe_step");
  std::vector<float> in;
  for (const auto& r : rays)
    in.insert(in.end(), {r.x.x, r.x.y, r.x.z, r.v.x, r.v.y, r.v.z, static_cast<float>(r.region), grace});
  const F input = session.upload(in), output = session.zeros<float>(16 * rays.size());
  kernel.enqueue(session.march_queue(), {rays.size()}, {1}, medium.regions_buffer, medium.tile_map_buffer,
                 medium.block_region_buffer, medium.distance_tiles, medium.index_tiles.bytes, medium.coefficient_tiles.bytes, input,
                 step, output, static_cast<int>(rays.size()));
  const std::vector<float> out = session.read(session.march_queue(), output);
  std::vector<StepResult> result;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float* a = out.data() + 16 * i;
    result.push_back({static_cast<int>(a[0]),
                      a[1],
                      {a[2], a[3], a[4]},
                      static_cast<int>(a[5]),
                      static_cast<int>(a[6]),
                      {a[7], a[8], a[9]},
                      static_cast<int>(a[10]),
                      {a[11], a[12], a[13]}});
  }
  return result;
}

DeviceMedium upload(const MediumDescription& scene) {
  const MediumVolume volume = voxelise(scene);
  return upload_medium(test::session(), volume, scene_features(volume, {}));
}

std::vector<test::ProbeRay> random_rays(glm::vec3 size, float eta, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> unit(0.02f, 0.98f);
  std::vector<test::ProbeRay> rays;
  for (int i = 0; i < count; ++i) {
    test::ProbeRay ray;
    ray.x = size * glm::vec3(unit(random), unit(random), unit(random));
    ray.v = eta * glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    rays.push_back(ray);
  }
  return rays;
}

TEST(Rays, AreStraightAtConstantIndexAndStopAtTheDomainsFaces) {
  for (bool scatters : {false, true}) {
    MediumDescription scene = test::empty_domain({40, 24, 32}, 1.0f);
    test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(scatters ? 0.1f : 0.0f), .eta = 1.3f}));
    const auto rays = random_rays({40, 24, 32}, 1.3f, 300, 1);
    const auto out = test::trace(upload(scene), rays, 0.5f, 4096);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const glm::dvec3 d = glm::normalize(glm::dvec3(rays[i].v));
      double exit = 1e9;
      int face = -1;
      for (int axis = 0; axis < 3; ++axis) {
        const double size[3] = {40, 24, 32};
        const double t = d[axis] > 0 ? (size[axis] - rays[i].x[axis]) / d[axis] : -rays[i].x[axis] / d[axis];
        if (t < exit) exit = t, face = 2 * axis + (d[axis] > 0);
      }
      ASSERT_EQ(out[i].face, face);
      ASSERT_NEAR(out[i].length, exit, 3e-4);  // up to 100 steps, each rounded at a coordinate of 40: 2e-6
      ASSERT_LT(glm::length(glm::dvec3(out[i].x) - (glm::dvec3(rays[i].x) + exit * d)), 3e-4);
      ASSERT_NEAR(glm::length(out[i].v), 1.3, 1e-6);
    }
  }
}

TEST(Rays, AStepEndsOnTheNearSideOfASurfaceAndKnowsWhatIsBeyond) {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(10, test::at(glm::vec3(16))),
                 test::make_material({.sigma_s = glm::vec3(0.1f), .eta = 1.5f}));
  const DeviceMedium medium = upload(scene);
  std::vector<test::ProbeRay> rays;
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 n = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    glm::vec3 d = glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    if (std::abs(glm::dot(d, n)) < 0.2f) continue;
    test::ProbeRay ray;
    ray.region = glm::dot(d, n) > 0 ? 1 : 0;  // inside, going out; or outside, going in
    ray.x = glm::vec3(16) + 10.0f * n - 0.3f * d;
    ray.v = d;
    rays.push_back(ray);
  }
  const auto out = step_once(medium, rays, 1.0f);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const StepResult& s = out[i];
    ASSERT_EQ(s.event, kSurface);
    ASSERT_EQ(s.surface, 1);
    ASSERT_EQ(s.next_region, 1 - rays[i].region);
    ASSERT_NEAR(s.length, 0.3, 0.15);                  // the sampled sphere lies within 0.03 voxel of the true one
    ASSERT_LE(glm::distance(s.x, s.beyond), 2.2e-3f);  // a thousandth of a voxel on either side
    const double before = glm::length(s.x - glm::vec3(16)) - 10, beyond = glm::length(s.beyond - glm::vec3(16)) - 10;
    ASSERT_NEAR(before, 0, 0.035);
    ASSERT_EQ(beyond > before, rays[i].region == 1);
  }
}

TEST(Rays, NoStepPassesASurface) {
  // Random walks of steps with refraction: a ray's region must be that of the point where it stands.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(11, test::at(glm::vec3(16))),
                 test::make_material({.sigma_s = glm::vec3(0.1f), .eta = 1.3f}));
  test::add_body(scene, make_box({8, 5, 6}, test::at({14, 16, 17})), test::make_material({.eta = 1.6f}));
  const DeviceMedium medium = upload(scene);
  auto rays = random_rays(glm::vec3(32), 1, 400, 3);
  for (auto& ray : rays) {  // all start outside the sphere
    const glm::vec3 d = ray.x - glm::vec3(16);
    if (glm::length(d) < 12.0f) ray.x = glm::vec3(16) + 12.0f * glm::normalize(d);
  }
  for (int steps = 1; steps < 60; steps += 7) {
    const auto out = test::trace(medium, rays, 0.5f, steps);
    int checked = 0;
    for (const auto& ray : out) {
      const float sphere = scene.bodies[0].solid.signed_distance(ray.x),
                  box = scene.bodies[1].solid.signed_distance(ray.x);
      if (std::abs(sphere) < 0.04f || std::abs(box) < 0.3f) continue;  // sampled and exact surfaces differ by that
      ASSERT_EQ(ray.region, box < 0 ? 2 : sphere < 0 ? 1 : 0);
      ++checked;
    }
    EXPECT_GT(checked, 200);
  }
}

TEST(Rays, LongStepsThroughEmptyBlocksMeetTheSameSurface) {
  // Where nothing scatters a step reaches to the block's end; the hit must not depend on it.
  std::vector<test::ProbeRay> out[2];
  for (int scatters : {0, 1}) {
    MediumDescription scene = test::empty_domain(glm::ivec3(64, 32, 32), 1.0f);
    test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(scatters ? 0.1f : 0.0f)}));
    test::add_body(scene, make_sphere(9, test::at({44, 16, 16})),
                   test::make_material({.sigma_s = glm::vec3(scatters ? 0.1f : 0.0f), .eta = 1.5f}));
    std::vector<test::ProbeRay> rays;
    for (int i = 0; i < 40; ++i) rays.push_back({{1, 8.2f + 0.37f * i, 15.3f}, {1, 0, 0}});
    out[scatters] = test::trace(upload(scene), rays, 0.5f, 4096);
  }
  for (std::size_t i = 0; i < out[0].size(); ++i) {
    ASSERT_EQ(out[0][i].surfaces, out[1][i].surfaces) << i;
    // Rounding at coordinates of 64 (4e-6) is magnified by the curvature; near grazing incidence more.
    if (std::abs(8.2f + 0.37f * i - 16) >= 8) continue;
    ASSERT_LT(glm::distance(out[0][i].x, out[1][i].x), 2e-2f) << i;
  }
}

TEST(Rays, GoFromABodyStraightIntoOneThatTouchesIt) {
  // One interface from 1.5 to 1.3 at z = 16, seen at once: steps of half a voxel end on it.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_box({100, 100, 12}, test::at({16, 16, 10})),
                 test::make_material({.sigma_s = glm::vec3(0.1f), .eta = 1.5f}));
  test::add_body(scene, make_box({100, 100, 12}, test::at({16, 16, 22})),
                 test::make_material({.sigma_s = glm::vec3(0.1f), .eta = 1.3f}));
  const DeviceMedium medium = upload(scene);
  const glm::vec3 down = 1.5f * glm::normalize(glm::vec3(0.5f, 0.2f, 1)), up = down * glm::vec3(1, 1, -1) * (1.3f / 1.5f);
  const std::vector<test::ProbeRay> rays{{{16, 16, 14}, {0, 0, 1.5f}, 1}, {{16, 16, 18}, {0, 0, -1.3f}, 2},
                                         {{15, 16, 14}, down, 1}, {{15, 16, 18}, up, 2}};
  const auto out = test::trace(medium, rays, 0.5f, 8);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const int beyond = 3 - rays[i].region;
    EXPECT_EQ(out[i].region, beyond) << i;
    EXPECT_EQ(out[i].surfaces, 1) << i;
    // eta sin(theta) goes on unchanged.
    EXPECT_NEAR(out[i].v.x, rays[i].v.x, 1e-4) << i;
    EXPECT_NEAR(out[i].v.y, rays[i].v.y, 1e-4) << i;
    EXPECT_NEAR(glm::length(out[i].v), beyond == 1 ? 1.5 : 1.3, 1e-5) << i;
  }
}

TEST(Rays, AStartJustOutsideTheSampledSurfaceIsForgiven) {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(10, test::at(glm::vec3(16))),
                 test::make_material({.sigma_s = glm::vec3(0.1f), .eta = 1.5f}));
  const DeviceMedium medium = upload(scene);
  std::vector<test::ProbeRay> rays{{{5.95f, 16, 16}, {1, 0, 0}, 1}};
  rays[0].v = {0.1f, 0.99f, 0};  // its first step ends outside, but it heads inwards
  EXPECT_EQ(step_once(medium, rays, 0.5f, 1.5f)[0].event, kNone);
  EXPECT_EQ(step_once(medium, rays, 0.5f, 0.0f)[0].event, kNone);
  rays[0].v = {-0.02f, 0.99f, 0};  // outwards, within the sampling's ripples
  EXPECT_EQ(step_once(medium, rays, 0.5f, 1.5f)[0].event, kNone);
  EXPECT_EQ(step_once(medium, rays, 0.5f, 0.0f)[0].event, kSurface);
  rays[0].v = {-0.5f, 0.8f, 0};  // and beyond them
  EXPECT_EQ(step_once(medium, rays, 0.5f, 1.5f)[0].event, kSurface);
  rays[0] = {{0.1f, 16, 16}, {-1, 0, 0}, 0};
  EXPECT_EQ(step_once(medium, rays, 0.5f, 1.5f)[0].event, kFace);
}

/// Largest | |v| / eta - 1 | at the end of paths of one length through a graded index, eta^2 quadratic in the position,
/// so that the samples' interpolation is exact and the step alone errs.
double speed_error(float step) {
  const auto eta_squared = [](glm::dvec3 x) { return 2.0 - glm::dot(x - 16.0, x - 16.0) / (24.0 * 24.0); };
  const DeviceMedium medium = test::graded_domain(glm::ivec3(32), eta_squared);
  std::vector<test::ProbeRay> rays;
  for (test::ProbeRay ray : random_rays(glm::vec3(32), 1, 200, 4)) {
    ray.x = glm::vec3(16) + 0.1f * (ray.x - glm::vec3(16));
    ray.v *= static_cast<float>(std::sqrt(eta_squared(ray.x)));
    rays.push_back(ray);
  }
  double worst = 0;
  for (const auto& ray : test::trace(medium, rays, step, static_cast<int>(std::lround(12 / step)))) {
    EXPECT_EQ(ray.face, -1);
    worst = std::max(worst, std::abs(glm::length(ray.v) / std::sqrt(eta_squared(ray.x)) - 1));
  }
  return worst;
}

TEST(Eikonal, SpeedStaysTheIndexWithSecondOrderInTheStep) {
  const double errors[3] = {speed_error(4), speed_error(2), speed_error(1)};
  EXPECT_LT(errors[2], 1e-3);  // (step / R)^2 / 4
  EXPECT_NEAR(test::observed_order(errors[0], errors[1]), 2, 0.1);
  EXPECT_NEAR(test::observed_order(errors[1], errors[2]), 2, 0.1);
}

}  // namespace
}  // namespace turbid
