// SPDX-License-Identifier: Apache-2.0
// How soon the solvers stop, and what they then say of their own error (numerics section 8, cases 18 and 19; the tables
// of section 5).
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/dense_diffusion.h"
#include "host/study/diffusion_runs.h"
#include "host/transport/lattice.h"
#include "host/transport/steady.h"

namespace turbid::study {
namespace {

/// Factor of s per voxel, 1 on average in the logarithm's middle.
using Contrast = std::function<double(glm::ivec3 voxel, std::size_t i)>;

double random_contrast(std::size_t i) {
  auto state = static_cast<std::uint32_t>(i) * 2654435761u;
  state = (state ^ (state >> 15)) * 2246822519u;
  state = (state ^ (state >> 13)) * 3266489917u;
  return 0.1 * std::pow(100.0, (state >> 8) / 16777216.0);
}

DiffusionMedium contrasted(int n, double s, double albedo, const Contrast& contrast) {
  DiffusionMedium medium = uniform(glm::ivec3(n), all_faces(FaceBoundary::open), s, (1 - albedo) * s);
  for (std::size_t i = 0; contrast && i < medium.stride(); ++i) {
    medium.s[i] = static_cast<float>(s * contrast(voxel_of(medium, i), i));
    medium.s_a[i] = static_cast<float>((1 - albedo) * medium.s[i]);
  }
  return medium;
}

struct Steps {
  int needed = 0;  ///< to a true relative L2 error of 1e-4
  int done = 0;    ///< by a solve that asks for 1e-4 and judges itself
};
/// Of the light of one voxel's source.
Steps count_steps(CaseContext& context, const DiffusionMedium& medium, CaseResult& result) {
  std::vector<float> q(medium.stride(), 0.0f);
  const glm::ivec3 source = medium.frame.voxels * glm::ivec3(5, 7, 10) / 16;
  for (std::size_t i = 0; i < q.size(); ++i)
    if (voxel_of(medium, i) == source) q[i] = 1;
  const SteadyAnswer exact = solve_steady(context.session, medium, q, 1e-6f);
  const SteadyAnswer own = solve_steady(context.session, medium, q, 1e-4f);
  result.note_imbalance(own.imbalance);
  Steps steps{.done = own.iterations};
  for (double error = 1; error > 1e-4 && steps.needed < own.iterations;) {
    SteadySettings settings;
    settings.tolerance = 1e-6f;
    settings.max_iterations = ++steps.needed;
    const SteadyResult rough = SteadySolve(context.session, medium, settings).solve(q);
    double difference = 0, norm = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      difference += std::pow(static_cast<double>(rough.u[i]) - exact.fluence[i], 2);  // index 1: u is the fluence
      norm += std::pow(static_cast<double>(exact.fluence[i]), 2);
    }
    error = std::sqrt(difference / norm);
  }
  return steps;
}

const char* const kOwnStop =
    "and 1 to 4 for the energy norm, which is the stricter one, and the margin of the estimate";

Case iterations_case() {
  Case c{.number = 18,
         .name = "iterations",
         .title = "Conjugate gradients around the block multigrid need few steps to 1e-4, 64^3, albedo .9999",
         .equation = "steps until the true relative L2 error is 1e-4",
         .source = "numerics section 5"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const Steps even = count_steps(context, contrasted(64, 1, 0.9999, {}), result);
    result.at_most("steps to true 1e-4, homogeneous", 8, even.needed, "numerics section 8");
    result.at_most("steps done, homogeneous", 10, even.done, kOwnStop);
    const auto random = [](glm::ivec3, std::size_t i) { return random_contrast(i); };
    const Steps uneven = count_steps(context, contrasted(64, 1, 0.9999, random), result);
    result.at_most("steps to true 1e-4, random contrast 100", 10, uneven.needed, "numerics section 8");
    result.at_most("steps done, random contrast 100", 14, uneven.done, kOwnStop);
  };
  return c;
}

Case contrast_case() {
  Case c{.number = 0,
         .name = "contrast",
         .title = "Steps of the steady solve to 1e-4 over optical thickness, albedo and contrast, 32^3",
         .equation = "conjugate gradients, block multigrid V-cycle, two red-black sweeps per 8^3 block",
         .source = "numerics section 5: 4 homogeneous, 6-7 checker, 6-7 random, at s = .1 and 1, albedo .9 and .9999"};
  c.check = [](CaseContext& context, CaseResult& result) {
    struct Row {
      const char* name;
      Contrast contrast;
      int bound;
    };
    const Row rows[] = {
        {"homogeneous", {}, 5},
        {"checker 100", [](glm::ivec3 v, std::size_t) { return (v.x / 4 + v.y / 4 + v.z / 4) % 2 ? 10.0 : 0.1; }, 8},
        {"layers 100", [](glm::ivec3 v, std::size_t) { return (v.z / 4) % 2 ? 10.0 : 0.1; }, 8},
        {"random 100", [](glm::ivec3, std::size_t i) { return random_contrast(i); }, 9}};
    for (const Row& row : rows)
      for (const double s : {0.1, 1.0})
        for (const double albedo : {0.9, 0.9999}) {
          char name[64];
          std::snprintf(name, sizeof name, ", %s, s = %g, albedo %g", row.name, s, albedo);
          const Steps steps = count_steps(context, contrasted(32, s, albedo, row.contrast), result);
          result.at_most(std::string("steps to true 1e-4") + name, row.bound, steps.needed,
                         "the table's; 1 more as its random numbers and where the light starts are others");
          result.at_most(std::string("steps done") + name, row.bound + 6, steps.done, kOwnStop);
        }
  };
  return c;
}

Case estimate_case() {
  Case c{
      .number = 19,
      .name = "estimate",
      .title = "The steady solve's estimate of its own error, with a delay of one step",
      .equation = "est^2 = g_k / (1 - g_k / g_(k-1)) / sum_{j<=k} g_j, g_j = a_j r_j.z_j",
      .source = "Hestenes and Stiefel; Strakos and Tichy 2002. The true error is measured in the double-precision A"};
  c.check = [](CaseContext& context, CaseResult& result) {
    MediumDescription scene = empty_domain(glm::ivec3(32), 1.0f);
    add_body(scene, make_sphere(14, at(glm::vec3(16))), make_material({.sigma_s = glm::vec3(1), .eta = 1.4f}));
    const DiffusionMedium medium = random_medium(scene, 0.1, 10, 3);
    const DenseDiffusion dense(medium, 0);
    std::vector<float> q(medium.stride(), 0.0f);
    for (std::size_t i = 0; i < q.size(); ++i)
      if (medium.region[i] >= 0 && voxel_of(medium, i).x < 8) q[i] = 1;
    const auto solve = [&](float tolerance, int most) {
      SteadySettings settings;
      settings.tolerance = tolerance;
      settings.max_iterations = most;
      return SteadySolve(context.session, medium, settings).solve(q);
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
    for (const int steps : {3, 4, 5}) {
      const SteadyResult later = solve(1e-6f, steps);
      const std::string at = " after " + std::to_string(steps) + " steps";
      result.absolute("steps done", steps, later.iterations, 0, "asked for");
      result.within("estimate / true error one step before," + at, 0.9, 1.1,
                    later.error_before_last / true_error(solve(1e-6f, steps - 1)),
                    "numerics section 5 has .9 to 1.05 with a delay of two; the rest is continued geometrically");
      result.at_most("true error / bound," + at, 1, true_error(later) / later.error_estimate,
                     "what is returned is within the bound that the stopping test goes by");
      result.at_most("bound / true error," + at, 3, later.error_estimate / true_error(later),
                     "gains that all fall alike would make it 1.5; one step more than needed is a factor of 3 to 8");
    }
  };
  return c;
}

Case lattice_stop_case() {
  Case c{.number = 0,
         .name = "lattice-stop",
         .title = "The lattice's stopping test tells the truth at albedo .999",
         .equation = "estimate = change rho / (1 - rho), rho the ratio of successive changes",
         .source = "numerics section 5: Bernabei's test on small changes stops with true errors up to 8e-2"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const DiffusionMedium medium = uniform(glm::ivec3(32), all_faces(FaceBoundary::open), 1, 1e-3);
    std::vector<float> q(medium.stride(), 0.0f);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = voxel_of(medium, i).x < 4;
    const std::vector<float> exact = solve_steady(context.session, medium, q).fluence;
    for (const float tolerance : {1e-2f, 1e-3f, 1e-4f, 1e-5f}) {
      const std::vector<float> found = solve_lattice(context.session, medium, q, CollisionVariant::trt, tolerance);
      double difference = 0, total = 0;
      for (std::size_t i = 0; i < q.size(); ++i) {
        difference += std::abs(found[i] - exact[i]);
        total += exact[i];
      }
      char name[64];
      std::snprintf(name, sizeof name, "true error / sum, tolerance %.0e", static_cast<double>(tolerance));
      result.at_most(name, 2 * tolerance + 5e-6, difference / total, "twice the tolerance; the reference's own 5e-6");
    }
  };
  return c;
}

}  // namespace

std::vector<Case> stopping_cases() {
  return {iterations_case(), estimate_case(), contrast_case(), lattice_stop_case()};
}

}  // namespace turbid::study
