// SPDX-License-Identifier: Apache-2.0
// bunny.toml, 512^2 pixels. Warm frame: march, solve and view of the prepared scene, the second time and later, in one
// process.
#include "host/bench/measure_frame.h"

#include <cmath>

#include "host/bench/figures.h"
#include "host/bench/light_run.h"

namespace turbid {
namespace {

SceneOverrides bunny(const BenchSettings& settings, int resolution) {
  const int edge = settings.quick ? 96 : 512;
  SceneOverrides overrides;
  overrides.resolution = resolution;
  overrides.settings = {"camera.width=" + std::to_string(edge), "camera.height=" + std::to_string(edge)};
  return overrides;
}

std::string balance_of(const SolverReport& report) {
  return figures("solve to an estimated %.1e, energy off by %.1e", report.error_estimate, report.energy.imbalance());
}

Goal frame_over_kernels(cl::Session& session, const BenchSettings& settings) {
  const int resolution = settings.quick ? 32 : 128;
  Progress progress(Verbosity::quiet);
  const SceneOnGrid scene = put_on_grid(read_scene(settings.scene("bunny.toml"), bunny(settings, resolution)), progress);
  PreparedScene prepared(session, scene, progress);
  std::vector<double> ratios, frames, kernels;
  SolverReport report;
  for (int i = 0; i <= settings.repeats(); ++i) {
    const Frame frame = record(session, progress, [&] {
      const LightSolution solution = prepared.light();
      prepared.look(solution);
      report = solution.report;
    });
    if (i == 0) continue;
    frames.push_back(frame.seconds());
    kernels.push_back(kernel_seconds(frame));
    ratios.push_back(frames.back() / kernels.back());
  }
  const Spread ratio = spread_of(ratios), frame = spread_of(frames), kernel = spread_of(kernels);
  return {.name = figures("whole frame / sum of its kernels, bunny.toml %d^3, warm", resolution),
          .ratio = ratio.median,
          .aim = 1.15,
          .at_least = false,
          .ours = figures("frame %.1f ms (%.1f to %.1f, %d repeats)", 1e3 * frame.median, 1e3 * frame.min, 1e3 * frame.max, frame.count),
          .against = figures("kernels running %.1f ms (%.1f to %.1f)", 1e3 * kernel.median, 1e3 * kernel.min, 1e3 * kernel.max),
          .error = balance_of(report)};
}

/// Turns a light by five degrees about the vertical axis through a point.
Light moved(Light light, glm::vec3 centre) {
  const float c = std::cos(0.0872665f), s = std::sin(0.0872665f);
  const auto turned = [&](glm::vec3 v) { return glm::vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
  light.position = centre + turned(light.position - centre);
  light.direction = turned(light.direction);
  return light;
}

Goal relight_over_whole(cl::Session& session, const BenchSettings& settings) {
  const int resolution = settings.quick ? 32 : 128;
  std::vector<double> whole, relight;
  SolverReport report;
  for (int i = 0; i <= settings.repeats(); ++i) {
    const double started = wall_time();
    LightRun run(session, settings.scene("bunny.toml"), bunny(settings, resolution));
    run.once(true, true);
    const double ended = wall_time();
    LightList lights = run.scene().scene.lights;
    const GridFrame& frame = run.scene().medium.frame();
    lights[0] = moved(lights[0], frame.origin + 0.5f * frame.size());
    const double moved_at = wall_time();
    const LightSolution solution = run.prepared().light(lights);
    run.prepared().look(solution);
    const double seen = wall_time();
    report = solution.report;
    if (i == 0) continue;
    whole.push_back(ended - started);
    relight.push_back(seen - moved_at);
  }
  const Spread a = spread_of(relight), b = spread_of(whole);
  return {.name = figures("relight / whole frame, bunny.toml %d^3", resolution),
          .ratio = a.median / b.median,
          .aim = 0.5,
          .at_least = false,
          .ours = figures("a light moved by 5 degrees: march, solve and picture in %.0f ms (%.0f to %.0f, %d repeats)", 1e3 * a.median,
                       1e3 * a.min, 1e3 * a.max, a.count),
          .against = figures("scene to picture, programs cached, %.0f ms (%.0f to %.0f)", 1e3 * b.median, 1e3 * b.min, 1e3 * b.max),
          .error = balance_of(report)};
}

Goal growth_with_voxels(cl::Session& session, const BenchSettings& settings) {
  const std::vector<int> levels = settings.quick ? std::vector<int>{16, 24, 32} : std::vector<int>{48, 64, 96, 128, 192, 256};
  std::vector<double> voxels, frames, solves;
  std::string list;
  double worst = 0;
  for (const int level : levels) {
    LightRun run(session, settings.scene("bunny.toml"), bunny(settings, level));
    run_interleaved({&run}, settings.quick ? 2 : 3, true);
    voxels.push_back(static_cast<double>(run.solution().report.active_voxels));
    frames.push_back(run.frame_seconds().median);
    solves.push_back(run.stage("diffuse").median);
    worst = std::max(worst, run.solution().report.error_estimate);
    list += figures("%s%d^3 %.0f", list.empty() ? "" : ", ", level, 1e3 * frames.back());
  }
  return {.name = "scaling exponent of frame time in active voxels",
          .ratio = exponent_of(voxels, frames),
          .aim = 1.05,
          .at_least = false,
          .ours = "warm frames [ms]: " + list,
          .against = figures("%.2e to %.2e active voxels; the solve alone grows with exponent %.2f", voxels.front(),
                          voxels.back(), exponent_of(voxels, solves)),
          .error = figures("each solved to an estimated %.1e or better", worst)};
}

}  // namespace

std::vector<Goal> measure_frame(cl::Session& session, const BenchSettings& settings) {
  return {frame_over_kernels(session, settings), relight_over_whole(session, settings), growth_with_voxels(session, settings)};
}

}  // namespace turbid
