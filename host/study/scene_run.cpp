// SPDX-License-Identifier: Apache-2.0
// See scene_run.h.
#include "host/study/scene_run.h"

#include <stdexcept>

#include "host/base/memory.h"

namespace turbid {

SceneOnGrid put_on_grid(Scene scene, Progress& progress) {
  progress.stage("voxelise");
  MediumVolume medium = voxelise(scene.medium, [&](double fraction) { progress.update(fraction); });
  const SceneFeatures features = scene_features(medium, scene.lights);
  progress.finish();
  return {std::move(scene), std::move(medium), features};
}

std::vector<LightSolution> solve_light(cl::Session& session, const SceneOnGrid& in, const SolverSettings& settings,
                                       const std::vector<std::uint64_t>& seeds, Progress& progress) {
  const auto solver = make_solver({.session = session,
                                   .progress = progress,
                                   .settings = settings,
                                   .features = in.features,
                                   .description = in.scene.medium,
                                   .surroundings = in.scene.surroundings});
  solver->prepare(in.medium);
  std::vector<LightSolution> solutions;
  for (const std::uint64_t seed : seeds) {
    solver->set_seed(seed);
    solutions.push_back(solver->light(in.scene.lights));
  }
  progress.finish();
  return solutions;
}

LightSolution solve_light(cl::Session& session, const SceneOnGrid& in, Progress& progress) {
  const SolverSettings& settings = in.scene.solver;
  return std::move(solve_light(session, in, settings, {settings.seed}, progress).front());
}

ViewPass view_of(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution) {
  if (!in.scene.has_camera) throw std::invalid_argument("view_of: the scene has no camera");
  return {session,
          {.description = in.scene.medium,
           .medium = in.medium,
           .features = in.features,
           .solution = solution,
           .lights = in.scene.lights,
           .surroundings = in.scene.surroundings,
           .settings = in.scene.view}};
}

ViewImage look_at(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution, Progress& progress) {
  progress.stage("view");
  ViewImage image =
      view_of(session, in, solution).look(in.scene.camera, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  return image;
}

double SceneRun::seconds() const {
  double sum = 0;
  for (const StageTime& stage : times) sum += stage.seconds;
  return sum;
}

SceneRun run_scene(cl::Session& session, Scene scene, bool picture, Verbosity talk) {
  reset_peak_memory();
  Progress progress(talk);
  SceneOnGrid on_grid = put_on_grid(std::move(scene), progress);
  LightSolution solution = solve_light(session, on_grid, progress);
  std::optional<ViewImage> image;
  if (picture) image = look_at(session, on_grid, solution, progress);
  return {std::move(on_grid), std::move(solution), std::move(image), progress.times(), peak_memory()};
}

double seconds_of(const std::vector<StageTime>& times, const std::string& stage) {
  double sum = 0;
  for (const StageTime& time : times)
    if (time.name == stage) sum += time.seconds;
  return sum;
}

}  // namespace turbid
