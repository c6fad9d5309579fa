// SPDX-License-Identifier: Apache-2.0
// Waves and point sources in endless media, both solvers against closed forms (numerics section 8, cases 4 to 6, and
// the table of section 1). Sources are given in watts per voxel, so that nothing depends on how light enters.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/study/case_lists.h"
#include "host/study/diffusion_runs.h"

namespace turbid::study {
namespace {

constexpr double kPi = std::numbers::pi;

/// Solves for the fluence of given watts per voxel.
using Solve =
    std::function<std::vector<float>(CaseContext&, const DiffusionMedium&, const std::vector<float>&, RefinedLevel&)>;

std::vector<float> with_steady(CaseContext& context, const DiffusionMedium& medium, const std::vector<float>& q,
                               RefinedLevel& level) {
  const SteadyAnswer answer = solve_steady(context.session, medium, q);
  level.energy_imbalance = answer.imbalance;
  return answer.fluence;
}
Solve with_lattice(CollisionVariant variant) {
  return [variant](CaseContext& context, const DiffusionMedium& medium, const std::vector<float>& q, RefinedLevel&) {
    return solve_lattice(context.session, medium, q, variant);
  };
}

/// Amplitude of the fluence that 1 + cos(2 pi x / n) watts per voxel raise in a periodic box; also rel-L2 and largest
/// deviation of the voxels from the exact wave, if its amplitude is given.
double cosine_amplitude(CaseContext& context, int n, double s, double s_a, const Solve& solve, RefinedLevel& level,
                        double exact = 0) {
  const DiffusionMedium medium = uniform({n, 8, 8}, all_faces(FaceBoundary::periodic), s, s_a);
  std::vector<float> q(medium.stride());
  const auto wave = [&](std::size_t i) { return std::cos(2 * kPi * (voxel_of(medium, i).x + 0.5) / n); };
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = static_cast<float>(1 + wave(i));
  const double started = wall_time();
  const std::vector<float> fluence = solve(context, medium, q, level);
  level.stages = {{"solve", wall_time() - started}};
  double amplitude = 0, difference = 0, absolute = 0, worst = 0, norm = 0, sum = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    amplitude += 2 * wave(i) * fluence[i] / static_cast<double>(q.size());
    // The mean follows from absorption alone and is right at any resolution; the errors are the wave's.
    const double expected = exact * wave(i), error = fluence[i] - 1 / s_a - expected;
    difference += error * error;
    absolute += std::abs(error);
    worst = std::max(worst, std::abs(error));
    norm += expected * expected;
    sum += std::abs(expected);
  }
  level.l1 = absolute / sum;
  level.l2 = std::sqrt(difference / norm);
  level.linf = worst / std::abs(exact);
  return amplitude;
}

/// Amplitude per source of a cosine along x, in voxel units.
double of_diffusion(double s, double s_a, double k) {
  return 1 / (s_a + k * k / (3 * s));
}
/// Of transport along six directions only, which a single relaxation time converges to (ray effects stay: numerics
/// section 0): +-df/dx + s f = Q/6 along x, s f = Q/6 along the others, Q = s_s phi + q.
double of_six_directions(double s, double s_a, double k) {
  const double g = (s / (s * s + k * k) + 2 / s) / 3;
  return g / (1 - (s - s_a) * g);
}

constexpr double kWave = 16;  // mean free paths per wavelength

Refinement cosine_refinement(const std::string& variant, double (*exact)(double, double, double), const Solve& solve,
                             std::vector<double> voxels, double order, double low, double high) {
  Refinement r;
  r.parameter = "voxel_size";
  r.unit = "mfp";
  for (const double n : voxels) r.levels.push_back(kWave / n);
  r.order = order;
  r.order_low = low;
  r.order_high = high;
  r.error_names = {"L1 of the wave", "L2 of the wave", "L-infinity of the wave"};
  r.variant = variant;
  r.run = [exact, solve](CaseContext& context, double voxel_size) {
    const int n = 8 * std::max(1, static_cast<int>(std::lround(kWave / voxel_size / 8)));
    RefinedLevel level;
    level.h = kWave / n;
    const double s = level.h, s_a = 0.1 * s, k = 2 * kPi / n;
    cosine_amplitude(context, n, s, s_a, solve, level, exact(s, s_a, k));
    return level;
  };
  return r;
}

/// Diffusion coefficient times 3 s, from the decay of a long wave against absorption.
double found_coefficient(CaseContext& context, int n, double s, const Solve& solve, CaseResult& result) {
  const double k2 = 2 - 2 * std::cos(2 * kPi / n);  // the wave's eigenvalue on the grid
  const double s_a = std::min(0.1 * s, k2 / (3 * s));
  RefinedLevel level;
  const double amplitude = cosine_amplitude(context, n, s, s_a, solve, level, 1);
  result.note_imbalance(level.energy_imbalance);
  return (1 / amplitude - s_a) / k2 * 3 * s;
}

Case coefficient_case() {
  Case c{.number = 4,
         .name = "coefficient",
         .title = "The diffusion coefficient of a voxel of any optical thickness",
         .equation = "D = 1 / (3 sigma_t), from the amplitude 1 / (sigma_a + D k^2) of a wave of 16 voxels",
         .source = "P1 limit of transport; k^2 is the wave's eigenvalue on the grid, 2 - 2 cos k"};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const double s : {0.01, 0.1, 1.0, 10.0, 50.0}) {
      char at[32];
      std::snprintf(at, sizeof at, " at s = %g", s);
      result.relative(std::string("3 s D, steady,") + at, 1, found_coefficient(context, 16, s, with_steady, result),
                      1e-3, "float conductances and a solve to 1e-6");
      result.relative(std::string("3 s D, lattice,") + at, 1,
                      found_coefficient(context, 16, s, with_lattice(CollisionVariant::trt), result), 1e-3,
                      "float populations, relaxed to 1e-5");
    }
  };
  return c;
}

Case cosine_case() {
  Case c{
      .number = 5,
      .name = "cosine",
      .title = "A cosine of source along x, 16 mean free paths long, albedo .9",
      .equation = "amplitude = 1 / (sigma_a + D k^2)",
      .source = "diffusion, k = 2 pi / wavelength; TRT: its steady state is the finite-volume solution (numerics 0)"};
  c.refinements = {
      cosine_refinement("steady", of_diffusion, with_steady, {32, 64, 128}, 2, 1.9, 2.1),
      cosine_refinement("lattice, trt", of_diffusion, with_lattice(CollisionVariant::trt), {16, 32, 64}, 2, 1.9, 2.1)};
  return c;
}

Case collisions_case() {
  Case c{.number = 0,
         .name = "collisions",
         .title = "What the paper's collision and its remedies converge to, and how fast",
         .equation = "amplitude = g / (1 - s_s g), g = (s / (s^2 + k^2) + 2 / s) / 3",
         .source = "transport along six directions, which one relaxation time leads to; orders: numerics section 1"};
  c.refinements = {
      cosine_refinement("paper", of_six_directions, with_lattice(CollisionVariant::paper), {32, 64, 128}, 1, 0.9, 1.15),
      cosine_refinement("exponential", of_six_directions, with_lattice(CollisionVariant::exponential), {32, 64, 128}, 1,
                        0.85, 1.15),
      cosine_refinement("trapezoid", of_six_directions, with_lattice(CollisionVariant::trapezoid), {16, 32, 64}, 2, 1.9,
                        2.1)};
  c.check = [](CaseContext& context, CaseResult& result) {
    struct Row {
      CollisionVariant variant;
      const char* name;
      double (*ratio)(double s);
    };
    const Row rows[] = {{CollisionVariant::paper, "paper", [](double s) { return 1 - s / 2; }},
                        {CollisionVariant::exponential, "exponential",
                         // (s/2) coth(s/2) for the populations, and the fluence is (1 - e^-s) / s of them
                         [](double s) { return s / 2 / std::tanh(s / 2) * s / (1 - std::exp(-s)); }},
                        {CollisionVariant::trapezoid, "trapezoid", [](double) { return 1.0; }},
                        {CollisionVariant::trt, "trt", [](double) { return 1.0; }}};
    for (const Row& row : rows)
      for (const double s : {0.5, 1.0}) {
        const double found = found_coefficient(context, 64, s, with_lattice(row.variant), result);
        char name[64];
        std::snprintf(name, sizeof name, "3 s D, %s, s = %g", row.name, s);
        const bool trt = row.variant == CollisionVariant::trt;
        result.relative(
            name, row.ratio(s), found, trt ? 1e-3 : 0.05,
            trt ? "exact on any grid" : "six directions add terms of (k / s)^2 = .01 to .04 at 64 voxels a wave");
      }
  };
  return c;
}

/// Rel-L2 error between 2 and 12 mean free paths from a point source: of single voxels, and of means over shells half a
/// mean free path thick. In an eighth of space by mirrors the source fills the eight voxels about the origin and is
/// compared with eight points.
struct GreenError {
  double voxels, shells;
};
GreenError green_error(CaseContext& context, double s, bool eighth, double& imbalance) {
  const auto open = FaceBoundary::open, mirror = FaceBoundary::mirror;
  const double s_a = 0.01 * s;
  const DiffusionMedium medium = eighth ? uniform(glm::ivec3(64), {mirror, open, mirror, open, mirror, open}, s, s_a)
                                        : uniform(glm::ivec3(64), all_faces(open), s, s_a);
  const glm::ivec3 source(eighth ? 0 : 32);
  std::vector<float> q(medium.stride(), 0.0f);
  for (std::size_t i = 0; i < q.size(); ++i)
    if (voxel_of(medium, i) == source) q[i] = eighth ? 0.125f : 1.0f;
  const SteadyAnswer answer = solve_steady(context.session, medium, q);
  imbalance = std::max(imbalance, answer.imbalance);
  const double d = 1 / (3 * s), kappa = std::sqrt(s_a / d);
  double difference = 0, norm = 0;
  std::array<double, 20> found{}, wanted{}, count{};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const glm::dvec3 x = glm::dvec3(voxel_of(medium, i)) + 0.5;
    const double distance = eighth ? glm::length(x) : glm::length(x - glm::dvec3(32.5));
    if (distance * s < 2 || distance * s > 12) continue;
    double expected = 0;
    for (int image = 0; image < 8; ++image) {
      const glm::dvec3 point(image & 1 ? -0.5 : 0.5, image & 2 ? -0.5 : 0.5, image & 4 ? -0.5 : 0.5);
      const double r = eighth ? glm::length(x - point) : distance;
      expected += 0.125 * std::exp(-kappa * r) / (4 * kPi * d * r);
    }
    difference += std::pow(answer.fluence[i] - expected, 2);
    norm += expected * expected;
    const int shell = std::min(static_cast<int>(2 * (distance * s - 2)), 19);
    found[shell] += answer.fluence[i];
    wanted[shell] += expected;
    count[shell] += 1;
  }
  double shell_difference = 0, shell_norm = 0;
  for (int k = 0; k < 20; ++k) {
    shell_difference += std::pow(found[k] - wanted[k], 2) / count[k];
    shell_norm += wanted[k] * wanted[k] / count[k];
  }
  return {std::sqrt(difference / norm), std::sqrt(shell_difference / shell_norm)};
}

Case green_case() {
  Case c{.number = 6,
         .name = "green",
         .title = "Point source in an infinite medium, albedo .99, between 2 and 12 mean free paths",
         .equation = "phi = exp(-kappa r) / (4 pi D r), kappa^2 = sigma_a / D",
         .source = "Green's function of diffusion; eight of them where mirrors leave an eighth of space"};
  c.check = [](CaseContext& context, CaseResult& result) {
    double imbalance = 0;
    const GreenError coarse = green_error(context, 0.75, true, imbalance),
                     fine = green_error(context, 0.375, true, imbalance),
                     single = green_error(context, 0.75, false, imbalance);
    result.note_imbalance(imbalance);
    const std::string grid = "the grid's own Green function is not round: (-3 + 5 sum n_i^4) / 8 (h/r)^2";
    result.at_most("rel-L2 of shell means, s = .75", 5e-3, coarse.shells, "numerics case 6");
    result.at_most("rel-L2 of shell means, s = .375", 1.5e-3, fine.shells, "numerics case 6");
    result.at_most("the same from a single voxel, s = .75", 5e-3, single.shells, "numerics case 6");
    result.at_most("rel-L2 of single voxels, s = .75", 9e-3, coarse.voxels, grid);
    result.at_most("rel-L2 of single voxels, s = .375", 3e-3, fine.voxels, grid);
    result.at_most("rel-L2 of single voxels from a single one, s = .75", 1.3e-2, single.voxels, grid);
  };
  return c;
}

}  // namespace

std::vector<Case> wave_cases() {
  return {coefficient_case(), cosine_case(), green_case(), collisions_case()};
}

}  // namespace turbid::study
