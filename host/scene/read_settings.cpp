// SPDX-License-Identifier: Apache-2.0
// Reads [solver] with its sub-tables march, lattice, steady and photon, and [view]: names, defaults and ranges of
// settings.h.
#include "host/scene/parts.h"

namespace turbid::scene {
namespace {

const toml::table kNone;

int count(const TableReader& table, std::string_view key, int lower, int upper, int fallback) {
  return static_cast<int>(table.integer(key, Range::closed(lower, upper), fallback));
}

const toml::table& sub_table(const TableReader& solver, std::string_view key) {
  if (!solver.has(key)) return kNone;
  if (!solver.find(key)->is_table()) solver.fail(key, "expected a table, [solver." + std::string(key) + "]");
  return *solver.find(key)->as_table();
}

MarchSettings read_march(const TableReader& table) {
  table.allow({"step_in_voxels", "rays_per_face", "max_steps", "batch_steps", "workers", "max_bounces", "min_power"});
  MarchSettings s;
  s.step_in_voxels = table.number("step_in_voxels", Range::half_open(0, 2, "voxels"), s.step_in_voxels);
  s.rays_per_face = table.number("rays_per_face", Range::half_open(0, 64), s.rays_per_face);
  s.max_steps = count(table, "max_steps", 1, 1 << 30, s.max_steps);
  s.batch_steps = count(table, "batch_steps", 1, 1 << 30, s.batch_steps);
  s.workers = count(table, "workers", 0, 4096, s.workers);
  s.max_bounces = count(table, "max_bounces", 0, 1 << 16, s.max_bounces);
  s.min_power = table.number("min_power", Range::closed(0, 0.1), s.min_power);
  return s;
}

LatticeSettings read_lattice(const TableReader& table, float tolerance) {
  table.allow({"collision", "block_edge", "inner_iterations", "sweeps_per_batch", "max_sweeps", "tolerance"});
  LatticeSettings s;
  s.collision = table.choice<CollisionVariant>("collision",
                                               {{"paper", CollisionVariant::paper},
                                                {"exponential", CollisionVariant::exponential},
                                                {"trapezoid", CollisionVariant::trapezoid},
                                                {"trt", CollisionVariant::trt}},
                                               "trt");
  s.block_edge = count(table, "block_edge", 0, 8, s.block_edge);
  if (s.block_edge != 0 && s.block_edge != 4 && s.block_edge != 8) {
    table.fail("block_edge", "must be 4 or 8 [voxels], or 0 for one global lattice");
  }
  s.inner_iterations = count(table, "inner_iterations", 1, 1024, s.inner_iterations);
  s.sweeps_per_batch = count(table, "sweeps_per_batch", 0, 1 << 20, s.sweeps_per_batch);
  s.max_sweeps = count(table, "max_sweeps", 1, 1 << 30, s.max_sweeps);
  s.tolerance = table.number("tolerance", Range::closed(1e-6, 0.1), tolerance);
  return s;
}

SteadySettings read_steady(const TableReader& table, float tolerance) {
  table.allow({"tolerance", "max_iterations", "smoothing_sweeps"});
  SteadySettings s;
  s.tolerance = table.number("tolerance", Range::closed(1e-6, 0.1), tolerance);
  s.max_iterations = count(table, "max_iterations", 1, 1 << 20, s.max_iterations);
  s.smoothing_sweeps = count(table, "smoothing_sweeps", 1, 8, s.smoothing_sweeps);
  return s;
}

PhotonSettings read_photon(const TableReader& table) {
  table.allow({"photons", "error", "batches", "max_steps"});
  PhotonSettings s;
  s.photons = table.integer("photons", Range::closed(1, 1e12), s.photons);
  s.error = table.number("error", Range::closed(0, 1), s.error);
  s.batches = count(table, "batches", 2, 4096, s.batches);
  s.max_steps = count(table, "max_steps", 1, 1 << 30, s.max_steps);
  return s;
}

ViewSettings read_view(const TableReader& table) {
  table.allow({"step_in_voxels", "max_steps", "max_branches", "min_weight"});
  ViewSettings s;
  s.step_in_voxels = table.number("step_in_voxels", Range::half_open(0, 1, "voxels"), s.step_in_voxels);
  s.max_steps = count(table, "max_steps", 1, 1 << 30, s.max_steps);
  s.max_branches = count(table, "max_branches", 1, 15, s.max_branches);
  s.min_weight = table.number("min_weight", Range::closed(0, 0.1), s.min_weight);
  return s;
}

}  // namespace

void read_settings(Reading& reading, const toml::table& root) {
  EffectiveScene& effective = reading.effective;
  SolverSettings& s = reading.scene.solver;
  const toml::table* node = table_at(root, "solver");
  const TableReader solver(node ? *node : kNone, "[solver]", effective.section("[solver]"));
  solver.allow({"name", "tolerance", "seed", "error_estimate", "storage", "march", "lattice", "steady", "photon"});
  s.solver = solver.word("name", {"steady", "lattice", "photon"}, s.solver);
  const float tolerance = solver.number("tolerance", Range::closed(1e-6, 0.1), s.steady.tolerance);
  s.seed = static_cast<std::uint64_t>(solver.integer("seed", Range::at_least(0), static_cast<std::int64_t>(s.seed)));
  s.error_estimate = solver.choice<EstimateEffort>(
      "error_estimate",
      {{"off", EstimateEffort::off}, {"quick", EstimateEffort::quick}, {"full", EstimateEffort::full}}, "quick");
  const Storage storage = solver.choice<Storage>(
      "storage", {{"float", Storage::single_precision}, {"half", Storage::half_precision}}, "float");
  s.march = read_march({sub_table(solver, "march"), "[solver.march]", effective.section("[solver.march]")});
  s.lattice = read_lattice({sub_table(solver, "lattice"), "[solver.lattice]", effective.section("[solver.lattice]")},
                           tolerance);
  s.march.storage = s.lattice.storage = storage;
  s.steady =
      read_steady({sub_table(solver, "steady"), "[solver.steady]", effective.section("[solver.steady]")}, tolerance);
  s.photon = read_photon({sub_table(solver, "photon"), "[solver.photon]", effective.section("[solver.photon]")});
  node = table_at(root, "view");
  reading.scene.view = read_view({node ? *node : kNone, "[view]", effective.section("[view]")});
}

}  // namespace turbid::scene
