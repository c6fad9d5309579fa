// SPDX-License-Identifier: Apache-2.0
// Settings of the solvers that change the way to the answer: the lattice's blocks and inner steps must not change it,
// and a solve errs by about the tolerance it was given (numerics section 5).
#include <cmath>
#include <random>

#include "host/study/case_lists.h"
#include "host/study/diffusion_runs.h"
#include "host/transport/lattice.h"

namespace turbid::study {
namespace {

/// 16^3 voxels of s between .3 and 3 at random, albedo .95, lit in one corner.
DiffusionMedium cloud(std::vector<float>& q) {
  DiffusionMedium medium = uniform(glm::ivec3(16), all_faces(FaceBoundary::open), 1, 0);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> power(-0.5, 0.5);
  q.assign(medium.stride(), 0.0f);
  for (std::size_t i = 0; i < medium.stride(); ++i) {
    medium.s[i] = static_cast<float>(std::pow(10, power(random)));
    medium.s_a[i] = 0.05f * medium.s[i];
    q[i] = glm::all(glm::lessThan(voxel_of(medium, i), glm::ivec3(4)));
  }
  return medium;
}

using Solve = std::function<std::vector<float>(CaseContext&, const DiffusionMedium&, const std::vector<float>&)>;

/// Errors against the steady solve at its finest tolerance, relative to the mean, the rms and the largest fluence.
RefinedLevel against_finest(CaseContext& context, double h, const Solve& solve) {
  std::vector<float> q;
  const DiffusionMedium medium = cloud(q);
  const std::vector<float> exact = solve_steady(context.session, medium, q, 1e-6f).fluence;
  const double started = wall_time();
  const std::vector<float> found = solve(context, medium, q);
  RefinedLevel level{.h = h, .l1 = 0, .l2 = 0, .linf = 0, .stages = {{"solve", wall_time() - started}}};
  double sum = 0, square = 0, largest = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const double error = std::abs(static_cast<double>(found[i]) - exact[i]), value = exact[i];
    level.l1 += error;
    level.l2 += error * error;
    level.linf = std::max(level.linf, error);
    sum += value;
    square += value * value;
    largest = std::max(largest, value);
  }
  level.l1 /= sum;
  level.l2 = std::sqrt(level.l2 / square);
  level.linf /= largest;
  return level;
}

Refinement refinement(const std::string& parameter, const std::string& unit, std::vector<double> levels) {
  Refinement r;
  r.parameter = parameter;
  r.unit = unit;
  r.levels = std::move(levels);
  r.error_names = {"L1 of the fluence", "L2 of the fluence", "L-infinity of the fluence"};
  return r;
}

/// Blocks or inner steps of a lattice that is relaxed to 1e-5.
Refinement lattice_refinement(const std::string& parameter, const std::string& unit, std::vector<double> levels) {
  Refinement r = refinement(parameter, unit, std::move(levels));
  for (const double level : r.levels)
    r.limits.push_back({level, 3e-5, "the steady state is one and the same; relaxed to an estimated 1e-5"});
  r.run = [parameter](CaseContext& context, double value) {
    return against_finest(
        context, value, [&](CaseContext& c, const DiffusionMedium& medium, const std::vector<float>& q) {
          LatticeSettings settings;
          settings.tolerance = 1e-5f;
          (parameter == "block" ? settings.block_edge : settings.inner_iterations) = static_cast<int>(value);
          Lattice lattice(c.session, medium, settings);
          lattice.set_source(q);
          lattice.relax();
          return lattice.read_fluence();
        });
  };
  return r;
}

/// The true error of a solve that was asked for so much. It has no order in it: either solver goes on until its energy
/// balance closes as well, and ends after whole steps or tests.
Refinement tolerance_refinement(const std::string& solver) {
  Refinement r = refinement("tolerance", "1", {1e-1, 1e-2, 1e-3, 1e-4});
  r.variant = solver;
  for (const double level : r.levels) r.limits.push_back({level, level, "what was asked for"});
  r.run = [solver](CaseContext& context, double tolerance) {
    return against_finest(context, tolerance,
                          [&](CaseContext& c, const DiffusionMedium& medium, const std::vector<float>& q) {
                            const auto t = static_cast<float>(tolerance);
                            return solver == "steady" ? solve_steady(c.session, medium, q, t).fluence
                                                      : solve_lattice(c.session, medium, q, CollisionVariant::trt, t);
                          });
  };
  return r;
}

Case settings_case() {
  Case c{.number = 0,
         .name = "settings",
         .title = "Blocks and inner steps do not change the answer, tolerances do by what they say; random medium 16^3",
         .equation = "steady state of the lattice = solution of A u = q; error <= tolerance",
         .source = "numerics sections 0 and 5; exact: the steady solve to 1e-6"};
  c.refinements = {lattice_refinement("block", "voxels", {4, 8}),
                   lattice_refinement("inner", "steps", {1, 2, 4, 8, 16}), tolerance_refinement("steady"),
                   tolerance_refinement("lattice")};
  return c;
}

}  // namespace

std::vector<Case> settings_cases() {
  return {settings_case()};
}

}  // namespace turbid::study
