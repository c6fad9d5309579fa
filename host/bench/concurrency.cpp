// SPDX-License-Identifier: Apache-2.0
// Does it help to march and to diffuse at the same time? Whole runs by the wall clock, then the bare question: what two queues
// gain when kernels leave cores idle, and when they don't. Event times can overlap fully with no gain at all.
#include <algorithm>
#include <functional>

#include "host/bench/light_run.h"
#include "host/bench/paper.h"

namespace turbid {

Experiment concurrent_or_not(cl::Session& session, const BenchSettings& settings) {
  const int resolution = settings.quick ? 32 : 128;
  Experiment e{.id = "concurrency", .title = "Concurrent against sequential",
               .paper = "Marching of batch i + 1 while batch i diffuses is on the average 30 % faster than one marching phase "
                        "and one diffusion phase.",
               .method = figures("Bubbly cube at %d^3, solver lattice, wall time of march and diffusion, runs interleaved. Batches "
                                 "of k = 64 steps; the lattice relaxes what earlier batches left while the next one marches, "
                                 "or it waits, or all rays march first.", resolution),
               .columns = {{"time", "ms"}, {"min", "ms"}, {"max", "ms"}, {"march stage", "ms"}, {"diffuse stage", "ms"},
                           {"sweeps"}, {"time / sequential"}, {"difference", "rel-L2"}}};
  const std::vector<std::pair<std::string, std::vector<std::string>>> choices{
      {"sequential: march, then diffuse", {"solver.march.batch_steps=4096"}},
      {"batches, 4 sweeps beside each", {"solver.march.batch_steps=64", "solver.lattice.sweeps_per_batch=4"}},
      {"batches, 16 sweeps beside each", {"solver.march.batch_steps=64", "solver.lattice.sweeps_per_batch=16"}},
      {"batches, lattice waits", {"solver.march.batch_steps=64", "solver.lattice.sweeps_per_batch=0"}}};
  std::vector<std::unique_ptr<LightRun>> runs;
  std::vector<LightRun*> all;
  for (const auto& [label, keys] : choices) {
    SceneOverrides overrides;
    overrides.resolution = resolution;
    overrides.solver = "lattice";
    overrides.settings = keys;
    runs.push_back(std::make_unique<LightRun>(session, settings.scene("bubbly_cube.toml"), overrides));
    all.push_back(runs.back().get());
    e.labels.push_back(label);
  }
  run_interleaved(all, settings.repeats(), false);
  const double sequential = all[0]->seconds().median;
  for (LightRun* run : all) {
    const Spread s = run->seconds();
    e.rows.push_back({1e3 * s.median, 1e3 * s.min, 1e3 * s.max, 1e3 * run->stage("march").median,
                      1e3 * run->stage("diffuse").median, static_cast<double>(run->solution().report.iterations),
                      s.median / sequential, relative_difference(run->fluence(), all[0]->fluence())});
  }
  e.found = figures("Beside each other %.2f of the sequential time (16 sweeps: %.2f); the same batches with a waiting lattice: %.2f. ",
                    e.rows[1][6], e.rows[2][6], e.rows[3][6]);
  const double gain = 1 - std::min(e.rows[1][6], e.rows[2][6]);
  e.found += gain > 0.05 ? figures("Concurrency saves %.0f %% here.", 100 * gain)
                         : "No gain: either queue's kernels can fill this device alone (see the next table), and batches add the "
                           "hand-over of deposits by the host.";
  return e;
}

Experiment two_queues(cl::Session& session, const BenchSettings& settings) {
  using F = cl::Buffer<float>;
  Experiment e{.id = "queues", .title = "What two queues can gain on this device",
               .method = "Two equal kernels of multiply-adds, of one work-group each (cores stay idle) or of many (none does), "
                         "given to one queue or to two; wall time from enqueue to finish, interleaved.",
               .columns = {{"one queue", "ms"}, {"two queues", "ms"}, {"one / two"}}};
  cl::Program program = session.build("ceilings.cl", {});
  cl::Kernel<F, int, float, float> kernel(program, "multiply_add");
  constexpr std::size_t kGroup = 64;
  const std::size_t many = kGroup * 64 * static_cast<std::size_t>(session.device().compute_units);
  F out[2] = {session.zeros<float>(many), session.zeros<float>(many)};
  const auto time = [&](std::size_t items, int rounds, bool two) {
    cl::Queue* queues[2] = {&session.march_queue(), two ? &session.lattice_queue() : &session.march_queue()};
    const double started = wall_time();
    for (int i = 0; i < 2; ++i) {
      kernel.enqueue(*queues[i], {items}, {kGroup}, out[i], rounds, 0.5f, 0.5f);
      queues[i]->flush();
    }
    for (cl::Queue* queue : queues) queue->finish();
    return wall_time() - started;
  };
  const auto compare = [&](const std::string& label, std::size_t items) {
    int rounds = 1024;
    time(items, rounds, false);
    while (time(items, rounds, false) < 0.02 && rounds < 1 << 28) rounds *= 2;
    std::vector<double> one, two;
    for (int i = 0; i < 2 * settings.repeats(); ++i) {
      one.push_back(time(items, rounds, false));
      two.push_back(time(items, rounds, true));
    }
    const double a = spread_of(one).median, b = spread_of(two).median;
    e.labels.push_back(label);
    e.rows.push_back({1e3 * a, 1e3 * b, a / b});
    return a / b;
  };
  const double idle = compare("one work-group each", kGroup);
  const double full = compare("64 work-groups per core each", many);
  e.found = figures("Two queues are %.2f times as fast where a kernel leaves cores idle, and %.2f times where none is idle. A march "
                    "of thousands of rays and a sweep of hundreds of blocks are of the last kind.", idle, full);
  return e;
}

}  // namespace turbid
