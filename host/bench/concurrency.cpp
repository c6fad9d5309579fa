// SPDX-License-Identifier: Apache-2.0
// Does it help to march and to diffuse at the same time? Whole runs by the wall clock beside the share of the time that
// the cores were busy, which bounds what any arrangement can save; then two frames at once; then the bare question:
// what two queues gain when kernels leave cores idle, and when they don't. Event times can overlap fully with no gain
// at all.
#include <algorithm>
#include <functional>
#include <thread>

#include "host/bench/filled_cube.h"
#include "host/bench/light_run.h"
#include "host/bench/paper.h"
#include "host/study/error_measures.h"

namespace turbid {
namespace {

constexpr double kGain = 0.05;  // a smaller difference of times is not called one

/// How the two passes share the device.
struct Arrangement {
  std::string label;
  int batch_steps;  ///< 0: all rays march first
  int sweeps;       ///< beside each batch
  int workers;      ///< work-items that march; 0: one per core
};

}  // namespace

Experiment concurrent_or_not(cl::Session& session, const BenchSettings& settings) {
  const int cores = session.device().compute_units, some = std::max(1, cores / 2);
  Experiment e{
      .id = "concurrency",
      .title = "Concurrent against sequential",
      .paper =
          "Marching of batch i + 1 while batch i diffuses is on the average 30 % faster than one marching phase "
          "and one diffusion phase.",
      .method =
          figures("Bubbly cube at %d^3, solver lattice, wall time of march and diffusion, runs interleaved. The "
                  "lattice relaxes what earlier batches left while the next one marches; or it waits; or all rays "
                  "march first. Fewer workers: the march leaves cores idle.",
                  cube_resolution(settings)),
      .columns = {{"time", "ms"},
                  {"min", "ms"},
                  {"max", "ms"},
                  {"march stage", "ms"},
                  {"diffuse stage", "ms"},
                  {"sweeps"},
                  {"time / sequential"},
                  {"cores busy"},
                  {"difference", "rel-L2"}}};
  std::vector<Arrangement> arrangements{{"sequential: march, then diffuse", 0, 0, 0},
                                        {"batches of 64, 4 sweeps beside each", 64, 4, 0},
                                        {"batches of 64, 16 sweeps beside each", 64, 16, 0},
                                        {"batches of 64, lattice waits", 64, 0, 0}};
  if (cores > 1) {
    const std::string who = figures(", march on %d of %d cores", some, cores);
    arrangements.push_back({"batches of 64, 16 sweeps beside each" + who, 64, 16, some});
    arrangements.push_back({"sequential" + who, 0, 0, some});
  }
  Runs runs(session, filled_cube(settings), cube_overrides(settings));
  for (const Arrangement& a : arrangements) {
    runs.add([&a](Scene& scene) {
      MarchSettings& march = scene.solver.march;
      march.batch_steps = a.batch_steps > 0 ? a.batch_steps : march.max_steps;
      march.workers = a.workers;
      scene.solver.lattice.sweeps_per_batch = a.sweeps;
    });
    e.labels.push_back(a.label);
  }
  run_interleaved(runs.all(), settings.repeats(), false, kMostSeconds);
  const LightRun& sequential = *runs.all()[0];
  std::size_t best = 1;
  for (std::size_t i = 0; i < arrangements.size(); ++i) {
    const LightRun& run = *runs.all()[i];
    const Spread s = run.seconds();
    e.rows.push_back({1e3 * s.median, 1e3 * s.min, 1e3 * s.max, 1e3 * run.stage("march").median,
                      1e3 * run.stage("diffuse").median, static_cast<double>(run.solution().report.iterations),
                      s.median / sequential.seconds().median, run.cores_busy(cores),
                      relative_l2(run.fluence(), sequential.fluence())});
    if (arrangements[i].sweeps > 0 && e.rows[i][6] < e.rows[best][6]) best = i;
  }
  const double ratio = e.rows[best][6], busy = e.rows[0][7];
  e.found =
      figures("Best beside each other (%s): %.2f of the sequential time. ", arrangements[best].label.c_str(), ratio);
  e.found += ratio < 1 - kGain ? figures("Concurrency saves %.0f %% here. ", 100 * (1 - ratio))
                               : "Concurrency saves nothing here. ";
  if (session.device().cpu)
    e.found += figures(
        "The sequential run keeps the cores %.0f %% busy: without less work, no arrangement can save more than %.0f "
        "%%. ",
        100 * busy, std::max(0.0, 100 * (1 - busy)));
  if (cores > 1) {
    const double idle = e.rows[4][0] / e.rows[5][0];
    e.found += figures(
        "Where the march leaves cores idle, as in the last two rows, marching beside the lattice takes %.2f of the "
        "time "
        "of one after the other.",
        idle);
  }
  return e;
}

Experiment frames_at_once(cl::Session& session, const BenchSettings& settings) {
  const int cores = session.device().compute_units;
  Experiment e{
      .id = "frames",
      .title = "Two frames at once",
      .method =
          "Bubbly cube, steady solver, light and picture: two frames one after the other, then both at once by two "
          "host "
          "threads with a context and queues each, so that the host's work of one frame meets the kernels of the "
          "other.",
      .columns = {{"two frames", "ms"}, {"min", "ms"}, {"max", "ms"}, {"cores busy"}, {"time / one after the other"}},
      .labels = {"one after the other", "at once"}};
  const cl::DeviceInfo& device = session.device();
  cl::Session other(cl::choose_device(figures("%d:%d", device.platform_index, device.device_index)));
  SceneOverrides overrides = cube_overrides(settings);
  overrides.solver = "steady";
  LightRun a(session, filled_cube(settings), overrides);
  LightRun b(other, a, [](Scene&) {});
  std::vector<double> seconds[2], busy[2];
  for (int i = 0; i <= settings.repeats(); ++i) {
    for (const int at_once : {0, 1}) {
      const double processor = processor_time();
      const double started = wall_time();
      if (at_once) {
        std::thread second([&] { b.once(true, false); });
        a.once(true, false);
        second.join();
      } else {
        a.once(true, false);
        b.once(true, false);
      }
      const double wall = wall_time() - started;
      if (i == 0) continue;
      seconds[at_once].push_back(wall);
      busy[at_once].push_back((processor_time() - processor) / (wall * cores));
    }
  }
  for (const int k : {0, 1}) {
    const Spread s = spread_of(seconds[k]);
    e.rows.push_back(
        {1e3 * s.median, 1e3 * s.min, 1e3 * s.max, spread_of(busy[k]).median, s.median / spread_of(seconds[0]).median});
  }
  e.found = figures("At once two frames take %.2f of the time; the cores were %.0f %% busy before, %.0f %% then.",
                    e.rows[1][4], 100 * e.rows[0][3], 100 * e.rows[1][3]);
  return e;
}

Experiment two_queues(cl::Session& session, const BenchSettings& settings) {
  using F = cl::Buffer<float>;
  Experiment e{
      .id = "queues",
      .title = "What two queues can gain on this device",
      .method =
          "Two equal kernels of multiply-adds, of one work-group each (cores stay idle) or of many (none does), "
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
  e.found =
      figures("Two queues are %.2f times as fast where a kernel leaves cores idle, and %.2f times where none is idle.",
              idle, full);
  if (session.device().cpu)
    e.found +=
        " A march has one work-group per core (unless march.workers is smaller) and a sweep one per block and colour: "
        "of "
        "the second kind.";
  return e;
}

}  // namespace turbid
