// SPDX-License-Identifier: Apache-2.0
// What the Monte Carlo reference says of itself: its account of the energy, and its standard errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

TEST(PhotonAccount, EveryWattIsFoundAgainWhateverHappensToIt) {
  MediumDescription scene = test::empty_domain(glm::ivec3(24), 0.5f);
  scene.faces[0] = FaceBoundary::mirror;
  test::set_ambient(scene, test::make_material({.sigma_s = {0.2f, 0.4f, 0.8f}, .sigma_a = {0.5f, 0.1f, 0.0f}, .emission = {0.1f, 0, 0}, .g = -0.4f}));
  test::add_body(scene, make_sphere(3, test::at({5, 5, 6})), test::make_material({.sigma_s = glm::vec3(1), .eta = 1.4f}));
  test::add_body(scene, make_sphere(1.5f, test::at({9, 9, 6})), test::make_material({}));
  scene.materials.back().opaque = true;
  Light spot = test::point_light({6, 6, -20}, {1, 2, 3});
  spot.kind = LightKind::spot;
  spot.direction = {0, 0, 1};
  spot.cone_angle = 30;
  Light inner = test::point_light({2, 2, 2}, {3, 2, 1});
  inner.kind = LightKind::spot;
  inner.direction = {0, 1, 0};
  const auto answer =
      follow(scene, photons(30000), LightList{test::sunlight({0.1f, -1, 0.2f}), test::point_light({40, 6, 6}), spot, inner},
             Surroundings{.ground = Ground{.height = -1}});
  const EnergyBalance& energy = answer.solution.report.energy;
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(energy.absorbed_opaque[c], 0);
    EXPECT_GT(energy.escaped[c], 0);
    EXPECT_GT(energy.missed[c], 0);
    // Roulette takes as much as it gives.
    EXPECT_LE(std::abs(energy.roulette[c]), 4 * answer.tallies().roulette.error[c]) << c;
  }
  EXPECT_GT(energy.absorbed.r, 0);
  expect_balance(answer.solution);
}

TEST(PhotonErrors, FallAsOneOverTheRootOfThePhotons) {
  // True errors of transmission against Milne's value, rms over seeds, and the errors that the runs state themselves.
  const double expected = 4.0 / 3 / (10 + 2 * 0.710446);
  double logs[4][2];
  for (int level = 0; level < 4; ++level) {
    const std::int64_t count = 500 << (2 * level);
    double squares = 0, stated = 0;
    constexpr int kSeeds = 12;
    for (int seed = 0; seed < kSeeds; ++seed) {
      const auto answer = follow(test::slab(8, 1.25f, milk(1, 0)), photons(count, 100 + seed, 16), {source(TURBID_SOURCE_LAMBERT, test::kLitPoint)});
      squares += std::pow(answer.tallies().escaped_faces[5].value.x - expected, 2);
      stated += std::pow(answer.tallies().escaped_faces[5].error.x, 2);
    }
    logs[level][0] = 0.5 * std::log(squares / kSeeds);
    logs[level][1] = 0.5 * std::log(stated / kSeeds);
  }
  // Slope over the three factors of 4. An rms of 12 values is uncertain by 20 %: 0.28 / 4.2 on the slope's outer points.
  for (int kind : {0, 1}) {
    const double slope = (3 * (logs[3][kind] - logs[0][kind]) + (logs[2][kind] - logs[1][kind])) / (10 * std::log(4.0));
    EXPECT_NEAR(slope, -0.5, kind == 0 ? 0.15 : 0.05) << (kind == 0 ? "true error" : "stated error");
  }
}

TEST(PhotonErrors, PullsOfManySeedsLookNormal) {
  // 100 seeds: (value - exact) / stated error of the transmission follows Student's t with 31 degrees of freedom. Eight cells of
  // equal probability; chi-square with 7 degrees of freedom exceeds 24.3 once in a thousand (the seeds are fixed).
  const double expected = 4.0 / 3 / (10 + 2 * 0.710446);
  const double bounds[7] = {-1.1758, -0.6825, -0.3216, 0, 0.3216, 0.6825, 1.1758};  // octiles of t(31)
  int cells[8] = {};
  double mean = 0;
  constexpr int kSeeds = 100;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto answer = follow(test::slab(8, 1.25f, milk(1, 0)), photons(3000, 1 + seed, 32), {source(TURBID_SOURCE_LAMBERT, test::kLitPoint)});
    const double value = pull(answer.tallies().escaped_faces[5], expected);
    ++cells[std::upper_bound(bounds, bounds + 7, value) - bounds];
    mean += value / kSeeds;
  }
  double chi_squared = 0;
  for (int count : cells) chi_squared += std::pow(count - kSeeds / 8.0, 2) / (kSeeds / 8.0);
  EXPECT_LT(chi_squared, 24.3);
  EXPECT_LT(std::abs(mean), 3 / std::sqrt(static_cast<double>(kSeeds)));
}

TEST(PhotonErrors, OfVoxelsCoverTheDifferencesBetweenRuns) {
  MediumDescription scene = test::slab(8, 0.5f, milk(0.8f, 0.2f));
  const auto one = follow(scene, photons(100000, 1, 64), {source(TURBID_SOURCE_LAMBERT, test::kLitPoint)});
  const auto other = follow(scene, photons(100000, 2, 64), {source(TURBID_SOURCE_LAMBERT, test::kLitPoint)});
  double squares = 0;
  for (std::size_t at = 0; at < one.region.size(); ++at)
    squares += std::pow(one.fluence(at) - other.fluence(at), 2) / (std::pow(one.error(at), 2) + std::pow(other.error(at), 2));
  // Mean of 512 squared pulls, hardly correlated: 1 with a spread of about 0.07 (heavier tails in dim voxels).
  EXPECT_NEAR(squares / one.region.size(), 1, 0.25);
}

TEST(PhotonErrors, ARunStopsOnceItsErrorIsAsAskedFor) {
  SolverSettings settings = photons(4'000'000, 3);
  settings.photon.error = 0.05f;
  const auto answer = follow(test::slab(8, 0.5f, milk(0.8f, 0.2f)), settings, {source(TURBID_SOURCE_LAMBERT, test::kLitPoint)});
  EXPECT_LT(answer.solution.report.error_estimate, 0.05);
  EXPECT_GT(answer.solution.report.error_estimate, 0.01);
  EXPECT_LT(answer.tallies().photons, 1'000'000u);
  EXPECT_GE(answer.tallies().batches, 8);
}

}  // namespace
}  // namespace turbid
