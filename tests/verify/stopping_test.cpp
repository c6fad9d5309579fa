// SPDX-License-Identifier: Apache-2.0
// How soon the solvers stop, and what they then say of their own error (numerics section 8, cases 18 and 19).
#include <gtest/gtest.h>

#include <cmath>

#include "host/transport/lattice.h"
#include "host/transport/steady.h"
#include "tests/support/test_diffusion.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

TEST(LatticeStop, TellsTheTruthAboutItsErrorAtAlbedoNearlyOne) {
  // Bernabei's test on small changes stops with true errors up to 8e-2 here (numerics section 5); change * rho / (1 -
  // rho) must not, and must end.
  const DiffusionMedium medium = test::uniform(glm::ivec3(32), test::all_faces(FaceBoundary::open), 1, 1e-3);
  std::vector<float> q(medium.stride(), 0.0f);
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = test::voxel_of(medium, i).x < 4;
  const test::SteadyAnswer exact = test::solve_steady(medium, q);
  for (float tolerance : {1e-2f, 1e-3f, 1e-4f, 1e-5f}) {
    LatticeSettings settings;
    settings.tolerance = tolerance;
    Lattice lattice(test::session(), medium, settings);
    lattice.set_source(q);
    EXPECT_LT(lattice.relax(), tolerance);
    EXPECT_LT(lattice.sweeps(), settings.max_sweeps) << tolerance;
    const std::vector<float> found = lattice.read_fluence();
    double difference = 0, total = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      difference += std::abs(found[i] - exact.fluence[i]);
      total += exact.fluence[i];
    }
    RecordProperty("tolerance_" + std::to_string(tolerance), std::to_string(lattice.sweeps()) + " sweeps, true error " +
                                                                 std::to_string(1e6 * difference / total) + " ppm");
    EXPECT_LT(difference / total, 2 * tolerance + 5e-6);  // the estimate's own error; the reference's
  }
}

TEST(ConjugateGradients, NeedFewIterationsAtAlbedoNearlyOne) {
  // Case 18: <= 8 homogeneous, <= 10 at random contrast 100, to 1e-4; one or two more for the energy balance of 1e-6.
  for (bool random : {false, true}) {
    DiffusionMedium medium = test::uniform(glm::ivec3(64), test::all_faces(FaceBoundary::open), 1, 1e-4);
    if (random) {
      unsigned state = 1;
      for (std::size_t i = 0; i < medium.stride(); ++i) {
        state = state * 1664525u + 1013904223u;
        medium.s[i] = static_cast<float>(0.1 * std::pow(100.0, (state >> 8) / 16777216.0));
        medium.s_a[i] = 1e-4f * medium.s[i];
      }
    }
    std::vector<float> q(medium.stride(), 0.0f);
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (test::voxel_of(medium, i) == glm::ivec3(20, 30, 40)) q[i] = 1;
    }
    const int iterations = test::solve_steady(medium, q, 1e-4f).iterations;
    RecordProperty(random ? "random" : "homogeneous", iterations);
    EXPECT_LE(iterations, random ? 12 : 10);
  }
}

TEST(ConjugateGradients, EstimateTheirOwnErrorWithADelayOfOneStep) {
  // Case 19: what the last step added, continued as the steps fall off, estimates the error before it; .9 to 1.1 of the
  // true energy norm. What is returned is better than that.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(14, test::at(glm::vec3(16))),
                 test::make_material({.sigma_s = glm::vec3(1), .eta = 1.4f}));
  const DiffusionMedium medium = test::random_medium(scene, 0.1, 10, 3);
  const test::DenseDiffusion dense(medium, 0);
  std::vector<float> q(medium.stride(), 0.0f);
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (medium.region[i] >= 0 && test::voxel_of(medium, i).x < 8) q[i] = 1;
  }
  auto solve = [&](float tolerance, int most) {
    SteadySettings settings;
    settings.tolerance = tolerance;
    settings.max_iterations = most;
    return SteadySolve(test::session(), medium, settings).solve(q);
  };
  const SteadyResult exact = solve(1e-6f, 60);
  const auto true_error = [&](const SteadyResult& rough) {
    std::vector<double> error(q.size()), full(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      full[i] = exact.u[i];
      error[i] = static_cast<double>(rough.u[i]) - exact.u[i];
    }
    const auto ae = dense.apply(error), af = dense.apply(full);
    double e2 = 0, f2 = 0;
    for (std::size_t i = 0; i < q.size(); ++i) e2 += error[i] * ae[i], f2 += full[i] * af[i];
    return std::sqrt(e2 / f2);
  };
  std::string text;
  for (int steps : {3, 4, 5}) {
    const SteadyResult later = solve(1e-6f, steps);
    ASSERT_EQ(later.iterations, steps);
    const double before = true_error(solve(1e-6f, steps - 1));
    text += std::to_string(later.error_estimate / before) + " ";
    EXPECT_GT(later.error_estimate / before, 0.9) << steps;
    EXPECT_LT(later.error_estimate / before, 1.1) << steps;
    EXPECT_LT(true_error(later), later.error_estimate) << steps;
  }
  RecordProperty("estimate_over_true", text);
}

}  // namespace
}  // namespace turbid
