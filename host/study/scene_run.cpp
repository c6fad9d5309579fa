// SPDX-License-Identifier: Apache-2.0
// See scene_run.h.
#include "host/study/scene_run.h"

#include <stdexcept>

#include "host/base/memory.h"
#include "host/view/view_pass.h"

namespace turbid {

SceneOnGrid put_on_grid(Scene scene, Progress& progress) {
  progress.stage("voxelise");
  MediumVolume medium = voxelise(scene.medium, [&](double fraction) { progress.update(fraction); });
  const SceneFeatures features = scene_features(medium, scene.lights);
  progress.finish();
  return {std::move(scene), std::move(medium), features};
}

LightSolution solve_light(cl::Session& session, const SceneOnGrid& in, const SolverSettings& settings,
                          Progress& progress) {
  const auto solver = make_solver({.session = session,
                                   .progress = progress,
                                   .settings = settings,
                                   .features = in.features,
                                   .description = in.scene.medium,
                                   .surroundings = in.scene.surroundings});
  solver->prepare(in.medium);
  LightSolution solution = solver->light(in.scene.lights);
  progress.finish();
  return solution;
}

LightSolution solve_light(cl::Session& session, const SceneOnGrid& in, Progress& progress) {
  return solve_light(session, in, in.scene.solver, progress);
}

ViewImage look_at(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution, const Camera& camera,
                  Progress& progress) {
  if (!in.scene.has_camera) throw std::invalid_argument("look_at: the scene has no camera");
  ViewImage image = render_view(session,
                                {.description = in.scene.medium,
                                 .medium = in.medium,
                                 .features = in.features,
                                 .solution = solution,
                                 .lights = in.scene.lights,
                                 .surroundings = in.scene.surroundings,
                                 .settings = in.scene.view},
                                camera, progress);
  progress.finish();
  return image;
}

ViewImage look_at(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution, Progress& progress) {
  return look_at(session, in, solution, in.scene.camera, progress);
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
