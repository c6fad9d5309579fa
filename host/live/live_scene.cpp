// SPDX-License-Identifier: Apache-2.0
// See live_scene.h.
#include "host/live/live_scene.h"

#include <algorithm>

namespace turbid {

Redo LiveScene::update(const Scene& scene, bool afresh) {
  if (afresh && warm_) pending_ = std::max(pending_, Redo::light);
  const Redo redo = std::max(pending_, on_grid_ ? redo_for(on_grid_->scene, scene) : Redo::all);
  if (redo >= Redo::medium) {
    voxelise_changes(scene, redo);
  } else {
    Scene next = scene;
    next.medium = std::move(on_grid_->scene.medium);  // equal, and the meshes that solver and view refer to
    on_grid_->scene = std::move(next);
    pending_ = redo;
  }
  if (pending_ >= Redo::light) solve(afresh);
  if (pending_ >= Redo::gather) {
    progress_.stage("gather");
    view_.emplace(session_, ViewInput{.description = on_grid_->scene.medium,
                                      .medium = on_grid_->medium,
                                      .features = on_grid_->features,
                                      .solution = *solution_,
                                      .lights = on_grid_->scene.lights,
                                      .surroundings = on_grid_->scene.surroundings,
                                      .settings = on_grid_->scene.view,
                                      .first_hits = &first_hits_});
    progress_.finish();
  }
  pending_ = Redo::nothing;
  return redo;
}

void LiveScene::voxelise_changes(const Scene& scene, Redo redo) {
  progress_.stage("voxelise");
  const auto step = [&](double fraction) { progress_.update(fraction); };
  MediumVolume medium = redo == Redo::all ? voxelise(scene.medium, step)
                                          : revoxelise(on_grid_->medium, on_grid_->scene.medium, scene.medium, step);
  progress_.finish();
  // What refers to the old medium goes with it.
  view_.reset();
  solution_.reset();
  solver_.reset();
  first_hits_.clear();
  on_grid_.emplace(SceneOnGrid{scene, std::move(medium), {}});
  pending_ = Redo::prepare;
}

void LiveScene::solve(bool afresh) {
  on_grid_->features = scene_features(on_grid_->medium, on_grid_->scene.lights);
  if (!(on_grid_->features == prepared_for_)) pending_ = std::max(pending_, Redo::prepare);  // other colours of lights
  if (pending_ >= Redo::prepare) {
    view_.reset();
    solution_.reset();
    solver_ = make_solver({.session = session_,
                           .progress = progress_,
                           .settings = on_grid_->scene.solver,
                           .features = on_grid_->features,
                           .description = on_grid_->scene.medium,
                           .surroundings = on_grid_->scene.surroundings});
    solver_->prepare(on_grid_->medium);
    prepared_for_ = on_grid_->features;
    answered_ = false;
    pending_ = Redo::light;
  }
  view_.reset();
  warm_ = answered_ && !afresh;
  solver_->set_warm_start(warm_);
  solution_ = solver_->light(on_grid_->scene.lights);
  answered_ = true;
  progress_.finish();
  pending_ = Redo::gather;
}

ViewImage LiveScene::look(const Camera& camera, const std::string& stage) {
  progress_.stage(stage);
  ViewImage image = view_->look(camera, [&](double fraction) { progress_.update(fraction); });
  progress_.finish();
  return image;
}

}  // namespace turbid
