// SPDX-License-Identifier: Apache-2.0
// Stability, energy, stopping tests and cost of the lattice: the paper's, and with each remedy.
#include <algorithm>
#include <cmath>
#include <random>

#include "host/base/errors.h"
#include "host/study/case.h"
#include "host/study/dense_diffusion.h"
#include "host/study/diffusion_runs.h"
#include "host/study/error_measures.h"
#include "host/study/paper_scheme.h"
#include "host/study/printed_lattice.h"
#include "host/transport/lattice.h"
#include "host/transport/steady.h"

namespace turbid::study {
namespace {

constexpr std::array kVariants{CollisionVariant::paper, CollisionVariant::exponential, CollisionVariant::trapezoid,
                               CollisionVariant::trt};

double total_size(const DenseDiffusion::Populations& f) {
  double squares = 0;
  for (const auto& voxel : f)
    for (const double population : voxel) squares += population * population;
  return std::sqrt(squares);
}

/// By power iteration from a random state: every mode is in it.
double growth(double s, CollisionVariant variant) {
  const DiffusionMedium medium = uniform(glm::ivec3(8), all_faces(FaceBoundary::periodic), s, 0.1 * s);
  const DenseDiffusion dense(medium, 0);
  DenseDiffusion::Populations f(medium.stride());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (auto& voxel : f)
    for (double& population : voxel) population = unit(random);
  const std::vector<double> q(medium.stride(), 0.0);
  constexpr int kWarmUp = 80, kSteps = 20;
  double before = 0;
  for (int i = 0; i < kWarmUp + kSteps; ++i) {
    if (i == kWarmUp) before = total_size(f);
    dense.step(f, variant, q);
    const double size = total_size(f);
    if (i >= kWarmUp || size == 0) continue;
    for (auto& voxel : f)
      for (double& population : voxel) population /= size;
  }
  return std::pow(total_size(f) / before, 1.0 / kSteps);
}

std::string engine_answer(CaseContext& context, double s) {
  const DiffusionMedium medium = uniform(glm::ivec3(8), all_faces(FaceBoundary::open), s, 0.1 * s);
  std::vector<float> q(medium.stride(), 0.0f);
  q[0] = 1;
  LatticeSettings settings;
  settings.collision = CollisionVariant::paper;
  Lattice lattice(context.session, medium, settings);
  lattice.set_source(q);
  try {
    return lattice.relax() <= settings.tolerance ? "relaxes" : "does not relax";
  } catch (const InputError&) {
    return "refused: the collision diverges";
  }
}

LatticeSettings plain_steps(CollisionVariant variant, float tolerance = 1e-4f) {
  LatticeSettings settings;
  settings.collision = variant;
  settings.inner_iterations = 1;  // one step of the whole lattice per sweep
  settings.tolerance = tolerance;
  return settings;
}

/// Sparse probes of the paper's test: one voxel in 64.
bool probe(const DiffusionMedium& medium, std::size_t i) {
  const glm::ivec3 v = voxel_of(medium, i) % 4;
  return v == glm::ivec3(1, 1, 1);
}

/// Steps until no probe changes by more than 1e-4 of itself between two of them.
int paper_stop(Lattice& lattice, const DiffusionMedium& medium, std::vector<float>& fluence) {
  std::vector<float> last(medium.stride(), 0.0f);
  while (lattice.sweeps() < 20000) {
    lattice.enqueue_sweeps(1);
    fluence = lattice.read_fluence();
    double worst = 0;
    for (std::size_t i = 0; i < fluence.size(); ++i)
      if (probe(medium, i))
        worst = std::max(worst, fluence[i] > 0 ? std::abs(fluence[i] - last[i]) / static_cast<double>(fluence[i]) : 1);
    if (worst < 1e-4) break;
    last = fluence;
  }
  return lattice.sweeps();
}

/// Plain steps to a true error of 1e-4 against the lattice's own end, looked at every 8, and their time.
int sweeps_to(CaseContext& context, const DiffusionMedium& medium, const std::vector<float>& q,
              CollisionVariant variant, double& seconds) {
  Lattice reference(context.session, medium, plain_steps(variant, 1e-6f));
  reference.set_source(q);
  reference.relax();
  const std::vector<float> exact = reference.read_fluence();
  Lattice lattice(context.session, medium, plain_steps(variant));
  lattice.set_source(q);
  seconds = 0;
  while (lattice.sweeps() < 20000) {
    const double started = wall_time();
    lattice.enqueue_sweeps(8);
    lattice.read_change();
    seconds += wall_time() - started;
    if (relative_l2(lattice.read_fluence(), exact) < 1e-4) break;
  }
  return lattice.sweeps();
}

}  // namespace

std::vector<Stability> stability(CaseContext& context) {
  std::vector<Stability> all;
  for (const double s : {0.25, 0.5, 1.0, 1.5, 1.9, 2.1, 2.5, 3.0, 4.0, 6.0, 10.0}) {
    Stability row{s, {}, engine_answer(context, s)};
    for (std::size_t v = 0; v < kVariants.size(); ++v) row.growth[v] = growth(s, kVariants[v]);
    all.push_back(row);
  }
  return all;
}

ClosedBox closed_box() {
  constexpr double kS = 0.5;
  ClosedBox box{0.1 * kS, {}, {}, {}, {}};
  PrintedLattice printed(8, kS - box.s_a, box.s_a);
  printed.populations()[0] = {0, 1, 1, 1, 1, 1, 1};
  const DiffusionMedium medium = uniform(glm::ivec3(8), all_faces(FaceBoundary::periodic), kS, box.s_a);
  const DenseDiffusion dense(medium, 0);
  DenseDiffusion::Populations f(medium.stride(), {0, 0, 0, 0, 0, 0});
  f[0] = {1, 1, 1, 1, 1, 1};
  const std::vector<double> q(medium.stride(), 0.0);
  for (int step = 0; step <= 60; ++step) {
    double sum = 0;
    for (const auto& voxel : f)
      for (const double population : voxel) sum += population;
    box.step.push_back(step);
    box.printed.push_back(printed.total() / 6);
    box.sink.push_back(sum / 6);
    box.exact.push_back(std::exp(-box.s_a * step));
    printed.step();
    dense.step(f, CollisionVariant::paper, q);
  }
  return box;
}

std::vector<Stopping> stopping(CaseContext& context) {
  std::vector<Stopping> all;
  const int n = context.quick ? 24 : 64;
  for (const double absorption : {0.1, 1e-2, 1e-3, 1e-4}) {
    std::array<FaceBoundary, 6> slab = all_faces(FaceBoundary::periodic);
    slab[4] = slab[5] = FaceBoundary::open;
    const DiffusionMedium medium = uniform({8, 8, n}, slab, 1, absorption);
    std::vector<float> q(medium.stride(), 0.0f);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = voxel_of(medium, i).z < n / 8;
    Stopping row{1 - absorption, 0, 0, 0, 0, 0, 0};
    Lattice end(context.session, medium, plain_steps(CollisionVariant::paper, 1e-6f));
    end.set_source(q);
    end.relax();
    const std::vector<float> exact = end.read_fluence();
    Lattice paper(context.session, medium, plain_steps(CollisionVariant::paper));
    paper.set_source(q);
    std::vector<float> fluence;
    row.paper_sweeps = paper_stop(paper, medium, fluence);
    row.paper_error = relative_l2(fluence, exact);
    Lattice estimate(context.session, medium, plain_steps(CollisionVariant::paper));
    estimate.set_source(q);
    estimate.relax();
    row.estimate_sweeps = estimate.sweeps();
    row.estimate_error = relative_l2(estimate.read_fluence(), exact);
    const SteadyAnswer steady = solve_steady(context.session, medium, q, 1e-4f);
    row.steady_iterations = steady.iterations;
    row.steady_error = relative_l2(steady.fluence, solve_steady(context.session, medium, q, 1e-6f).fluence);
    all.push_back(row);
    context.progress.update(static_cast<double>(all.size()) / 4);
  }
  return all;
}

std::vector<Cost> cost(CaseContext& context) {
  std::vector<Cost> all;
  for (const double absorption : {0.1, 1e-2, 1e-3, 1e-4}) {
    const DiffusionMedium medium =
        uniform(glm::ivec3(context.quick ? 16 : 32), all_faces(FaceBoundary::open), 1, absorption);
    std::vector<float> q(medium.stride(), 0.0f);
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = voxel_of(medium, i).x < 4;
    Cost row{1 - absorption, 0, 0, 0, 0, 0, 0};
    row.paper_sweeps = sweeps_to(context, medium, q, CollisionVariant::paper, row.paper_seconds);
    row.trt_sweeps = sweeps_to(context, medium, q, CollisionVariant::trt, row.trt_seconds);
    const std::vector<float> exact = solve_steady(context.session, medium, q, 1e-6f).fluence;
    for (row.steady_iterations = 1; row.steady_iterations < 60; ++row.steady_iterations) {
      SteadySettings settings;
      settings.tolerance = 1e-6f;
      settings.max_iterations = row.steady_iterations;
      SteadySolve solve(context.session, medium, settings);
      SteadyResult found = solve.solve(q);
      row.steady_seconds = 1e9;
      for (int repeat = 0; repeat < 3; ++repeat) {
        const double started = wall_time();
        found = solve.solve(q);
        row.steady_seconds = std::min(row.steady_seconds, wall_time() - started);
      }
      if (relative_l2(found.u, exact) < 1e-4) break;
    }
    all.push_back(row);
    context.progress.update(static_cast<double>(all.size()) / 4);
  }
  return all;
}

}  // namespace turbid::study
