// SPDX-License-Identifier: Apache-2.0
// See frame.h.
#include "host/profile/frame.h"

#include <algorithm>

#include "host/view/view_pass.h"

namespace turbid {

double busy_seconds(const std::vector<const cl::Command*>& commands) {
  std::vector<std::pair<double, double>> intervals;
  for (const cl::Command* command : commands) intervals.emplace_back(command->started, command->ended);
  std::sort(intervals.begin(), intervals.end());
  double sum = 0, until = 0;
  for (const auto& [begin, end] : intervals) {
    const double from = std::max(begin, until);
    if (end > from) sum += end - from;
    until = std::max(until, end);
  }
  return sum;
}

namespace {

std::vector<const cl::Command*> chosen(const Frame& frame, bool kernels_only) {
  std::vector<const cl::Command*> result;
  for (const cl::Command& command : frame.commands)
    if (!kernels_only || command.is_kernel()) result.push_back(&command);
  return result;
}

}  // namespace

double kernel_seconds(const Frame& frame) { return busy_seconds(chosen(frame, true)); }
double device_seconds(const Frame& frame) { return busy_seconds(chosen(frame, false)); }

PreparedScene::PreparedScene(cl::Session& session, const SceneOnGrid& scene, Progress& progress,
                             const SceneFeatures& features)
    : session_(session), scene_(scene), progress_(progress), features_(features) {
  solver_ = make_solver({.session = session,
                         .progress = progress,
                         .settings = scene.scene.solver,
                         .features = features,
                         .description = scene.scene.medium,
                         .surroundings = scene.scene.surroundings});
  solver_->prepare(scene.medium);
  progress.finish();
}

PreparedScene::~PreparedScene() = default;

LightSolution PreparedScene::light(const LightList& lights) {
  LightSolution solution = solver_->light(lights);
  progress_.finish();
  return solution;
}

std::optional<ViewImage> PreparedScene::look(const LightSolution& solution) {
  if (!scene_.scene.has_camera) return std::nullopt;
  return render_view(session_,
                     {.description = scene_.scene.medium,
                      .medium = scene_.medium,
                      .features = features_,
                      .solution = solution,
                      .lights = scene_.scene.lights,
                      .surroundings = scene_.scene.surroundings,
                      .settings = scene_.scene.view,
                      .first_hits = &first_hits_},
                     scene_.scene.camera, progress_);
}

Frame record(cl::Session& session, Progress& progress, const std::function<void()>& work) {
  progress.watch([&session](const std::string& stage) { session.stage(stage); });
  cl::Recorder& recorder = session.recorder();
  recorder.start();
  Frame frame;
  frame.started = wall_time();
  try {
    work();
  } catch (...) {
    recorder.stop();
    progress.watch({});
    throw;
  }
  session.march_queue().finish();
  session.lattice_queue().finish();
  frame.ended = wall_time();
  recorder.stop();
  progress.watch({});
  frame.commands = recorder.commands();
  frame.programs = recorder.programs();
  frame.stages = recorder.stages();
  return frame;
}

}  // namespace turbid
