// SPDX-License-Identifier: Apache-2.0
// See light_run.h.
#include "host/bench/light_run.h"

namespace turbid {

LightRun::LightRun(cl::Session& session, const std::string& scene_file, const SceneOverrides& overrides,
                   const std::function<void(Scene&)>& change) {
  Scene scene = read_scene(scene_file, overrides);
  if (change) change(scene);
  scene_ = std::make_unique<SceneOnGrid>(put_on_grid(std::move(scene), *progress_));
  prepared_ = std::make_unique<PreparedScene>(session, *scene_, *progress_);
}

LightRun::LightRun(cl::Session& session, const LightRun& like, const std::function<void(Scene&)>& change,
                   const std::function<SceneFeatures(SceneFeatures)>& features_of) {
  Scene scene = like.scene_->scene;
  if (change) change(scene);
  MediumVolume medium = revoxelise(like.scene_->medium, like.scene_->scene.medium, scene.medium);
  SceneFeatures features = scene_features(medium, scene.lights);
  if (features_of) features = features_of(features);
  scene_ = std::make_unique<SceneOnGrid>(SceneOnGrid{std::move(scene), std::move(medium), features});
  prepared_ = std::make_unique<PreparedScene>(session, *scene_, *progress_);
}

void LightRun::once(bool picture, bool keep) {
  const std::size_t before = progress_->times().size();
  const double processor = processor_time();
  const double started = wall_time();
  solution_ = prepared_->light();
  const double lit = wall_time();
  if (picture) image_ = prepared_->look(*solution_);
  const double ended = wall_time();
  if (!keep) return;
  seconds_.push_back(lit - started);
  view_.push_back(ended - lit);
  processor_.push_back(processor_time() - processor);
  stages_.emplace_back(progress_->times().begin() + static_cast<std::ptrdiff_t>(before), progress_->times().end());
}

void LightRun::forget_times() {
  seconds_.clear();
  view_.clear();
  processor_.clear();
  stages_.clear();
}

Spread LightRun::frame_seconds() const {
  std::vector<double> sums;
  for (std::size_t i = 0; i < seconds_.size(); ++i) sums.push_back(seconds_[i] + view_[i]);
  return spread_of(sums);
}

double LightRun::cores_busy(int cores) const {
  double processor = 0, wall = 0;
  for (std::size_t i = 0; i < seconds_.size(); ++i) {
    processor += processor_[i];
    wall += seconds_[i] + view_[i];
  }
  return processor / (wall * cores);
}

Spread LightRun::stage(const std::string& name) const {
  std::vector<double> values;
  for (const std::vector<StageTime>& times : stages_) values.push_back(seconds_of(times, name));
  return spread_of(values);
}

void Runs::add(const std::function<void(Scene&)>& change) {
  owned_.push_back(owned_.empty() ? std::make_unique<LightRun>(session_, file_, overrides_, change)
                                  : std::make_unique<LightRun>(session_, *owned_[0], change));
  all_.push_back(owned_.back().get());
}

void run_interleaved(const std::vector<LightRun*>& runs, int repeats, bool picture, double most_seconds) {
  constexpr double kLong = 5;
  const double started = wall_time();
  bool all_timed = true;
  for (LightRun* run : runs) {
    run->once(picture, true);
    if (run->frame_seconds().median < kLong) {
      run->forget_times();
      all_timed = false;
    }
  }
  for (int i = 0; i < repeats; ++i) {
    if ((all_timed || i > 0) && wall_time() - started > most_seconds) return;
    for (LightRun* run : runs)
      if (i > 0 || !run->timed() || wall_time() - started < most_seconds) run->once(picture, true);
  }
}

}  // namespace turbid
