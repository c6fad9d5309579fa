// SPDX-License-Identifier: Apache-2.0
// The engine's own solvers as they are run, without a scene around them.
#include "host/bench/measure_lattice.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "host/bench/figures.h"
#include "host/bench/hard_media.h"
#include "host/bench/measure_blocks.h"
#include "host/profile/ceilings.h"
#include "host/profile/spread.h"
#include "host/study/error_measures.h"
#include "host/transport/lattice_scheme.h"
#include "host/transport/steady.h"

namespace turbid {
namespace {

constexpr double kTrueError = 1e-4;

LatticeSettings global_lattice() {
  LatticeSettings settings;
  settings.block_edge = 0;
  return settings;
}

/// 160 bytes per voxel and step of three colours (performance notes): populations read and written, and the source.
Goal single_step(cl::Session& session, int voxels, int repeats) {
  constexpr int kSteps = 32, kNominalBytes = 160;
  const DiffusionMedium medium = hard_medium(HardMedium::homogeneous, voxels, 1, 0.9999, 3);
  const auto lattice = make_lattice(session, medium, global_lattice());
  lattice->set_source(beam_source(medium));
  const auto steps = [&] {
    lattice->enqueue_sweeps(kSteps);
    session.lattice_queue().finish();
  };
  steps();
  CeilingMeter meter(session);
  meter.measure(1);
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    meter.measure(1);
    seconds.push_back(seconds_of(steps) / kSteps);
  }
  const double triad = meter.ceilings().triad.median, step = spread_of(seconds).median;
  const double bandwidth = kNominalBytes * std::pow(voxels, 3) / step;
  return {.name = figures("single lattice step %d^3, nominal bandwidth / triad", voxels),
          .ratio = bandwidth / triad,
          .aim = 1.3,
          .ours = figures("%.1f GB/s nominal, %.0f million RGB updates/s", 1e-9 * bandwidth,
                          1e-6 * std::pow(voxels, 3) / step),
          .against = figures("triad %.1f GB/s", 1e-9 * triad),
          .error = "none: the step is checked against double precision by the tests"};
}

/// The same steps with populations in half precision, in turn with single precision.
Goal half_step(cl::Session& session, int voxels, int repeats) {
  constexpr int kSteps = 32;
  const DiffusionMedium medium = hard_medium(HardMedium::homogeneous, voxels, 1, 0.9999, 3);
  std::unique_ptr<LatticeScheme> lattices[2];
  std::vector<double> seconds[2];
  std::vector<float> fluence[2];
  for (int half = 0; half < 2; ++half) {
    LatticeSettings settings = global_lattice();
    if (half) settings.storage = Storage::half_precision;
    lattices[half] = make_lattice(session, medium, settings);
    lattices[half]->set_source(beam_source(medium));
  }
  for (int i = 0; i <= repeats; ++i) {
    for (int half = 0; half < 2; ++half) {
      const double time = seconds_of([&] {
        lattices[half]->enqueue_sweeps(kSteps);
        session.lattice_queue().finish();
      });
      if (i > 0) seconds[half].push_back(time / kSteps);  // the first one warms up
    }
  }
  for (int half = 0; half < 2; ++half) fluence[half] = lattices[half]->read_fluence();
  const double single = spread_of(seconds[0]).median, half = spread_of(seconds[1]).median;
  return {.name = figures("lattice step %d^3, single / half-precision storage (time)", voxels),
          .ratio = single / half,
          .aim = 1.2,
          .ours = figures("half %.2f ms, %.0f MB", 1e3 * half, 1e-6 * static_cast<double>(lattices[1]->device_bytes())),
          .against =
              figures("single %.2f ms, %.0f MB", 1e3 * single, 1e-6 * static_cast<double>(lattices[0]->device_bytes())),
          .error = figures("the two fluences differ by %.1e", relative_l2(fluence[1], fluence[0]))};
}

/// Albedo .9999, s = 1: plain steps are done until the true error is small, and timed; then the solve.
Goal plain_steps_against_solve(cl::Session& session, int voxels, int repeats) {
  constexpr int kBetweenLooks = 64, kMostSteps = 20000;
  const DiffusionMedium medium = hard_medium(HardMedium::homogeneous, voxels, 1, 0.9999, 3);
  const std::vector<float> q = beam_source(medium);
  SteadySettings deep;
  deep.tolerance = 1e-6f;
  const std::vector<float> exact = SteadySolve(session, medium, deep).solve(q).u;
  const auto lattice = make_lattice(session, medium, global_lattice());
  lattice->set_source(q);
  double plain = 0, plain_error = 1;
  int steps = 0;
  while (plain_error > kTrueError && steps < kMostSteps) {
    plain += seconds_of([&] {
      lattice->enqueue_sweeps(kBetweenLooks);
      session.lattice_queue().finish();
    });
    steps += kBetweenLooks;
    plain_error = relative_l2(lattice->read_fluence(), exact);
  }
  SteadySolve solve(session, medium, {});
  SteadyResult result = solve.solve(q);
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) seconds.push_back(seconds_of([&] { result = solve.solve(q); }));
  const double steady = spread_of(seconds).median;
  return {.name = figures("plain lattice steps to true 1e-4 / steady solve, w = .9999, %d^3 (time)", voxels),
          .ratio = plain / steady,
          .aim = 200,
          .ours = figures("steady %.1f ms, %d iterations", 1e3 * steady, result.iterations),
          .against = figures("%d global steps in %.0f ms", steps, 1e3 * plain),
          .error = figures("true rel-L2: steps %.1e, steady %.1e", plain_error, relative_l2(result.u, exact))};
}

/// Iterations until the energy norm's error, from the gains of a much deeper solve, is below 1e-4.
int iterations_needed(const SteadyResult& deep) {
  double rest = 0;
  for (const auto& gain : deep.gains) rest += gain[0];
  const double small = kTrueError * kTrueError * rest;
  int count = 0;
  for (const auto& gain : deep.gains) {
    if (rest <= small) break;
    rest -= gain[0];
    ++count;
  }
  return count;
}

/// What iterations are counted on.
struct HardCase {
  int n;
  HardMedium kind;
  double albedo, s;
};

/// All media at 32^3 and `largest`^3, and even and random coefficients at twice that, where the multigrid has one level
/// more.
std::vector<HardCase> hard_cases(int largest) {
  std::vector<HardCase> cases;
  for (const double albedo : {0.9, 0.9999}) {
    for (const double s : {0.1, 1.0}) {
      for (const HardMedium kind : {HardMedium::homogeneous, HardMedium::checker, HardMedium::random,
                                    HardMedium::layers, HardMedium::duct, HardMedium::voids, HardMedium::sphere}) {
        for (const int n : std::set<int>{32, largest}) cases.push_back({n, kind, albedo, s});
      }
      for (const HardMedium kind : {HardMedium::homogeneous, HardMedium::random}) {
        if (largest > 32) cases.push_back({2 * largest, kind, albedo, s});
      }
    }
  }
  return cases;
}

/// Of a contrast of 100 or of none.
struct Worst {
  int needed = 0, done = 0;
  std::string where;
};

std::vector<Goal> iterations(cl::Session& session, int largest) {
  SteadySettings deep;
  deep.tolerance = 1e-6f;
  Worst even, uneven;
  for (const HardCase& c : hard_cases(largest)) {
    const DiffusionMedium medium = hard_medium(c.kind, c.n, c.s, c.albedo, 1);
    Worst& worst = c.kind == HardMedium::homogeneous ? even : uneven;
    SteadySolve exact(session, medium, deep), usual(session, medium, {});
    for (const std::vector<float>& q : {beam_source(medium), point_source(medium)}) {
      const int needed = iterations_needed(exact.solve(q));
      worst.done = std::max(worst.done, usual.solve(q).iterations);
      if (needed <= worst.needed) continue;
      worst.needed = needed;
      worst.where = figures("%s, %d^3, w = %g, s = %g", name_of(c.kind).c_str(), c.n, c.albedo, c.s);
    }
  }
  const auto goal = [&](const char* media, const Worst& worst, double aim) {
    return Goal{.name = figures("steady iterations to true 1e-4, worst of %s, 32^3 to %d^3", media,
                                largest > 32 ? 2 * largest : 32),
                .ratio = static_cast<double>(worst.needed),
                .aim = aim,
                .at_least = false,
                .ours = worst.where,
                .against = figures("its stopping test does up to %d", worst.done),
                .error = "energy norm, against a solve to 1e-6"};
  };
  return {goal("even media", even, 8), goal("6 uneven media", uneven, 10)};
}

}  // namespace

std::vector<Goal> measure_lattice(cl::Session& session, int voxels, int solve_voxels, int repeats) {
  std::vector<Goal> goals{single_step(session, voxels, repeats), blocked_steps(session, voxels, repeats),
                          half_step(session, voxels, repeats),
                          plain_steps_against_solve(session, solve_voxels, repeats)};
  for (Goal& goal : iterations(session, solve_voxels)) goals.push_back(std::move(goal));
  return goals;
}

}  // namespace turbid
