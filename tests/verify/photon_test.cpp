// SPDX-License-Identifier: Apache-2.0
// The Monte Carlo reference against closed forms, an independent Monte Carlo program, equilibrium, march and steady.
//
// Comparisons allow 4 standard errors where many are made with fixed seeds and 3 where there is one, as the design asks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/test_photons.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

using test::expect_balance;
using test::follow;
using test::milk;
using test::photons;
using test::pull;
using test::source;

constexpr double kPi = std::numbers::pi;

/// A field of z alone.
class Profile final : public Field {
 public:
  explicit Profile(std::function<float(float)> f) : f_(std::move(f)) {}
  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = glm::vec3(f_(positions[i].z));
  }
  std::string describe() const override { return "profile"; }

 private:
  std::function<float(float)> f_;
};

TEST(PhotonUnscattered, LightFallsByBeerAndLambert) {
  for (float g : {0.0f, 0.8f}) {
    const auto answer = follow(test::slab(16, 0.125f, milk(0.8f, 0.2f, 1, g)), photons(60000), {source(TURBID_SOURCE_RAY, test::kLitPoint)});
    EXPECT_LT(std::abs(pull(answer.tallies().unscattered_faces[5], std::exp(-2.0))), 3) << g;
    // Per voxel: the mean of exp(-z) over its depth, times sigma_s, is what is first scattered there; it all happens in one
    // column of voxels of area 1/64.
    double chi_squared = 0;
    for (std::size_t at = 0; at < answer.region.size(); ++at) {
      const glm::ivec3 v = answer.voxel(at);
      const float deposit = answer.solution.volume.deposit[at];
      if (v.x != 3 || v.y != 3) {
        EXPECT_EQ(deposit, 0.0f);
        continue;
      }
      const double z = v.z * 0.125, expected = 64 * answer.sigma_s[at] * std::exp(-z) * (1 - std::exp(-0.125)) / 0.125;
      // Track estimator: each photon of the 60000 gives at most a voxel's length, so this bounds the variance.
      const double share = std::exp(-z), error = expected * std::sqrt((1.0 - share + 0.1) / share / 60000);
      chi_squared += std::pow((deposit - expected) / error, 2);
    }
    EXPECT_LT(chi_squared, 16 + 4 * std::sqrt(32.0)) << g;
    expect_balance(answer.solution);
  }
}

TEST(PhotonUnscattered, AbsorptionAloneNeedsNoLuck) {
  const auto answer = follow(test::slab(16, 0.125f, milk(0, 1.5f)), photons(2000), {source(TURBID_SOURCE_RAY, test::kLitPoint)});
  EXPECT_NEAR(answer.tallies().escaped_faces[5].value.x, std::exp(-3.0), 1e-6);  // float weights
  EXPECT_NEAR(answer.tallies().absorbed.value.x, 1 - std::exp(-3.0), 1e-6);
  expect_balance(answer.solution);
}

TEST(PhotonUnscattered, VaryingCoefficientsAreTrackedWithoutBias) {
  // sigma rises fivefold within a voxel and falls again: a rule of one value per step would be off by per cents. Between nodes
  // interpolation is linear, so the exact depth is the trapezoid sum over the voxels' centres and the two half cells outside.
  constexpr int kVoxels = 16;
  auto profile = [](float z) { return static_cast<int>(std::floor(z)) % 3 == 1 ? 0.4f : 0.08f; };
  for (int kind = 0; kind < 3; ++kind) {
    Material material = milk(0.05f, 0.02f);
    const FieldPtr field = std::make_shared<Profile>(profile);
    if (kind != 1) material.sigma_s = field;
    if (kind != 0) material.sigma_a = field;
    const auto answer = follow(test::slab(kVoxels, 1.0f, material), photons(60000), {source(TURBID_SOURCE_RAY, test::kLitPoint, {0.6f, 0, 0.8f})});
    double depth = 0;
    for (int i = 0; i < kVoxels; ++i) depth += profile(i + 0.5f);
    double other = kind == 0 ? 0.02 * kVoxels : kind == 1 ? 0.05 * kVoxels : depth;
    EXPECT_LT(std::abs(pull(answer.tallies().unscattered_faces[5], std::exp(-(depth + other) / 0.8))), 3) << kind;
    expect_balance(answer.solution);
  }
}

TEST(PhotonUnscattered, ColoursGoTheirOwnWays) {
  MediumDescription scene = test::slab(8, 0.25f, test::make_material({.sigma_s = {0.2f, 0.5f, 1.0f}, .sigma_a = {0.3f, 0.0f, 0.1f}}));
  const auto answer = follow(scene, photons(60000), {source(TURBID_SOURCE_RAY, test::kLitPoint)});
  const double expected[3] = {std::exp(-1.0), std::exp(-1.0), std::exp(-2.2)};
  for (int c = 0; c < 3; ++c) EXPECT_LT(std::abs(pull(answer.tallies().unscattered_faces[5], expected[c], c)), 3) << c;
  expect_balance(answer.solution);
}

TEST(PhotonSurfaces, LightTrappedInGlassEndsAsInFlight) {
  // At 45 degrees to four faces of a cube of index 2.5 and parallel to the others, light is totally reflected for ever. It meets
  // the faces between their middles and edges (edges are rounded by sampling).
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 1.0f);
  test::add_body(scene, make_box({10, 10, 10}, test::at({8, 8, 8})), milk(0, 0, 2.5f));
  SolverSettings settings = photons(1000);
  settings.photon.max_steps = 2000;
  const auto answer = follow(scene, settings, {source(TURBID_SOURCE_RAY, {5.5f, 8, 8}, {1, 0, 1}, 1)});
  EXPECT_EQ(answer.tallies().in_flight.value.x, 1.0);
  expect_balance(answer.solution);
}

TEST(PhotonSlab, ScattersForwardsLikeOneOfItsTransportCoefficient) {
  // T = (4/3) / (10 + 2 * 0.710446) as in case 7; by similarity sigma_s (1 - g) counts, to a few per cent.
  const auto answer = follow(test::slab(16, 0.625f, milk(2, 0, 1, 0.5f)), photons(80000), {source(TURBID_SOURCE_LAMBERT, test::kLitPoint)});
  const auto& faces = answer.tallies().escaped_faces;
  EXPECT_NEAR(faces[4].value.x + faces[5].value.x, 1, 1e-12);
  EXPECT_NEAR(faces[5].value.x, 4.0 / 3 / (10 + 2 * 0.710446), 3 * faces[5].error.x + 0.002);
  expect_balance(answer.solution);
}

TEST(PhotonSlab, LayersWhoseFacesCoincideAreCrossedWithoutAGap) {
  // Layers of index 1.5, 1.33 and 1.4 that end where the next one begins, on faces of voxels, under a beam. Expected: an own
  // Monte Carlo program for plane layers in double precision, 1.5e6 photons. Light that crossed a sliver of vacuum between the
  // layers lost 9 % of what is transmitted and a third of the fluence behind a face.
  MediumDescription scene = test::slab(24, 1, milk(0, 0));
  const auto layer = [&](float lower, float thickness, const Material& material) {
    test::add_body(scene, make_box({100, 100, thickness}, test::at({4, 4, lower + 0.5f * thickness})), material);
  };
  layer(2, 4, milk(2, 0.02f, 1.5f));
  layer(6, 6, milk(0.5f, 0.005f, 1.33f));
  layer(12, 10, milk(1, 0.01f, 1.4f));
  const auto answer = follow(scene, photons(50000), {source(TURBID_SOURCE_RAY, {3.5f, 3.5f, 0.5f})});
  const auto& faces = answer.tallies().escaped_faces;
  EXPECT_NEAR(faces[4].value.x, 0.6066, 3 * std::hypot(faces[4].error.x, 0.0004));
  EXPECT_NEAR(faces[5].value.x, 0.01477, 3 * std::hypot(faces[5].error.x, 0.0001));
  EXPECT_NEAR(answer.tallies().absorbed.value.x, 0.3786, 3 * std::hypot(answer.tallies().absorbed.error.x, 0.0004));
  // Mean fluence over the slice behind either interface, per watt per area [1].
  double behind[2] = {0, 0};
  for (std::size_t at = 0; at < answer.region.size(); ++at) {
    const int z = answer.voxel(at).z;
    if (z == 6) behind[0] += answer.fluence(at);
    if (z == 12) behind[1] += answer.fluence(at);
  }
  EXPECT_NEAR(behind[0], 1.443, 0.05);  // some 4 standard errors of 50000 photons
  EXPECT_NEAR(behind[1], 0.858, 0.04);
  expect_balance(answer.solution);
}

TEST(PhotonEquilibrium, InAClosedBoxTheFluenceFollowsTheSquareOfTheIndex) {
  // With emission sigma_a eta^2 everywhere and nothing leaving, the radiance is that of a cavity: fluence = eta^2, whatever
  // scatters, refracts or reflects. A ball of glass, its surface cutting voxels; a clear ball; a slab that meets another index
  // across a periodic seam; anisotropic scattering; mirrors.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 0.5f, FaceBoundary::mirror);
  scene.faces[0] = scene.faces[1] = FaceBoundary::periodic;
  test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(0.1f), .sigma_a = glm::vec3(0.1f), .emission = glm::vec3(0.1f), .g = 0.5f}));
  test::add_body(scene, make_sphere(5, test::at({8, 8, 8})),
                 test::make_material({.sigma_s = glm::vec3(0.2f), .sigma_a = glm::vec3(0.2f), .emission = glm::vec3(0.45f), .eta = 1.5f}));
  test::add_body(scene, make_sphere(2, test::at({13, 2.5f, 2.5f})), milk(0, 0, 1.2f));
  test::add_body(scene, make_box({4, 100, 100}, test::at({0, 8, 8})),
                 test::make_material({.sigma_s = glm::vec3(0.3f), .sigma_a = glm::vec3(0.1f), .emission = glm::vec3(0.169f), .eta = 1.3f}));
  const auto answer = follow(scene, photons(600000), LightList{});
  double mean[5] = {}, count[5] = {};
  for (std::size_t at = 0; at < answer.region.size(); ++at) {
    const glm::vec3 x = 0.5f * (glm::vec3(answer.voxel(at)) + 0.5f) - 8.0f;
    if (answer.region[at] < 0) continue;
    const int part = answer.region[at] == 1 && glm::length(x) > 4 ? 4 : answer.region[at];
    mean[part] += answer.fluence(at);
    count[part] += 1;
  }
  // Statistical errors are 0.001 to 0.002. The clear ball (region 2) has a test of its own.
  EXPECT_NEAR(mean[0] / count[0], 1.0, 0.004);
  EXPECT_NEAR(mean[1] / count[1], 2.25, 0.01);
  EXPECT_NEAR(mean[4] / count[4], 2.25, 0.01);
  EXPECT_NEAR(mean[3] / count[3], 1.69, 0.01);
  expect_balance(answer.solution);
}

TEST(PhotonEquilibrium, AClearBallHoldsTheRadianceOfWhatSurroundsIt) {
  // Little is absorbed, so the surroundings are even whatever the emission; within R / 1.2 of the centre every direction leads
  // outside, beyond that total reflection holds modes that nothing fills.
  constexpr int kSeeds = 6;
  double sum = 0, square = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    MediumDescription scene = test::empty_domain(glm::ivec3(24), 1, FaceBoundary::mirror, true);
    test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(0.2f), .sigma_a = glm::vec3(0.02f), .emission = glm::vec3(0.02f)}));
    test::add_body(scene, make_sphere(10, {}), milk(0, 0, 1.2f));
    const auto answer = follow(scene, photons(12000, seed, 4), LightList{});
    double inside = 0, inside_count = 0, around = 0, around_count = 0;
    for (std::size_t at = 0; at < answer.region.size(); ++at) {
      const glm::vec3 x = glm::abs(glm::vec3(answer.voxel(at)) - 11.5f);
      if (glm::length(x + 0.5f) < 9.9f / 1.2f) inside += answer.fluence(at), ++inside_count;
      if (glm::length(x) > 11 && answer.region[at] == 0) around += answer.fluence(at), ++around_count;
    }
    const double ratio = inside / inside_count / (around / around_count);
    sum += ratio / kSeeds;
    square += ratio * ratio / kSeeds;
    expect_balance(answer.solution);
  }
  const double error = std::sqrt((square - sum * sum) / (kSeeds - 1));
  EXPECT_NEAR(sum, 1.44, 3 * error);
  EXPECT_LT(error, 0.006);
}

TEST(PhotonEquilibrium, AlsoWhereTheIndexIsGraded) {
  // Level at the mirrors, so that the mirror image goes on smoothly.
  auto eta = [](float z) { return 1.35f + 0.3f * std::cos(z * static_cast<float>(kPi) / 8); };
  MediumDescription scene = test::empty_domain({8, 8, 16}, 1.0f, FaceBoundary::mirror);
  Material material = milk(0.1f, 0.1f);
  material.eta = std::make_shared<Profile>(eta);
  material.emission = std::make_shared<Profile>([&](float z) { return 0.1f * eta(z) * eta(z); });
  test::set_ambient(scene, material);
  const auto answer = follow(scene, photons(120000), LightList{});
  for (int layer = 0; layer < 16; ++layer) {
    double ratio = 0;
    int count = 0;
    for (std::size_t at = 0; at < answer.region.size(); ++at) {
      if (answer.voxel(at).z != layer) continue;
      ratio += answer.fluence(at) / std::pow(eta(layer + 0.5f), 2);
      ++count;
    }
    // A layer's statistical error is about half a per cent; linear interpolation and central differences of eta over voxels
    // of a sixteenth of its period are off by (2 pi / 16)^2 / 8 of its amplitude: up to 3 per cent of eta^2 between them.
    EXPECT_NEAR(ratio / count, 1, 0.04) << layer;
  }
  expect_balance(answer.solution);
}

TEST(PhotonAndMarch, DepositTheSameFirstScatteredLight) {
  // Refracting ball under the sun: per voxel the marched deposit and the photons' agree within their noise and the difference
  // between trilinear splat and voxel mean, both small against the field.
  MediumDescription scene = test::empty_domain(glm::ivec3(24), 1.0f);
  test::add_body(scene, make_sphere(9, test::at({12, 12, 12})), milk(0.08f, 0.02f, 1.3f));
  const LightList lights{test::sunlight({0.2f, -1, 0.1f})};
  const auto answer = follow(scene, photons(200000), lights);
  const test::Run marched = test::run(scene, lights);
  double difference = 0, norm = 0, total[2] = {};
  for (std::size_t at = 0; at < answer.region.size(); ++at) {
    if (answer.region[at] < 0) continue;
    const double a = answer.solution.volume.deposit[at], b = marched.solution.volume.deposit[at];
    difference += (a - b) * (a - b);
    norm += b * b;
    total[0] += a;
    total[1] += b;
  }
  EXPECT_LT(std::sqrt(difference / norm), 0.12);
  EXPECT_NEAR(total[0] / total[1], 1, 0.01);
  EXPECT_NEAR(answer.solution.report.energy.reflected.x / marched.energy().reflected.x, 1, 1e-3);
  EXPECT_NEAR(answer.solution.report.energy.emitted.x, marched.energy().emitted.x, 1e-6 * marched.energy().emitted.x);
}

TEST(PhotonAndSteady, AgreeWhereDiffusionHolds) {
  // Albedo .999, a ball of radius 8 mean free paths in refracting milk: diffusion is good to a few per cent (numerics section 2).
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 2.2f / 32, FaceBoundary::open, true);
  test::add_body(scene, make_sphere(1, {}), milk(7.992f, 0.008f, 1.3f));
  const LightList lights{test::point_light({0, 0, 0})};
  const auto answer = follow(scene, photons(60000), lights);
  const test::Run steady = test::run(scene, lights);
  double difference = 0, norm = 0;
  for (std::size_t at = 0; at < answer.region.size(); ++at) {
    if (answer.region[at] < 0) continue;
    const glm::vec3 x = glm::vec3(answer.voxel(at)) + 0.5f - 16.0f;
    if (glm::length(x) * 2.2f / 32 < 0.3f) continue;  // two mean free paths around the source are not diffusive
    const double a = answer.fluence(at), b = steady.solution.volume.fluence[at] + steady.solution.volume.deposit[at] / answer.sigma_s[at];
    difference += (a - b) * (a - b);
    norm += a * a;
  }
  EXPECT_LT(std::sqrt(difference / norm), 0.08);
  EXPECT_NEAR(steady.energy().escaped.x, answer.tallies().escaped.value.x, 0.01);
}

}  // namespace
}  // namespace turbid
