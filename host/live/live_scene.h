// SPDX-License-Identifier: Apache-2.0
// A scene that is kept prepared on the device: a change does again only what depends on it.
#pragma once
#include <memory>
#include <optional>

#include "host/base/progress.h"
#include "host/cl/session.h"
#include "host/live/redo.h"
#include "host/study/scene_run.h"
#include "host/view/view_pass.h"

namespace turbid {

class LiveScene {
 public:
  /// Keeps the references.
  LiveScene(cl::Session& session, Progress& progress) : session_(session), progress_(progress) {}

  /// Brings everything up to a picture to `scene`, and says which stages that took. What is thrown (bad coefficients, a
  /// stage stopped by Progress) leaves what was finished; the next call goes on from there.
  /// A solve starts from the last answer where only the lights changed; if `afresh`, the answer is one that was solved from
  /// nothing, as in a first run, so that pictures equal those of `turbid render` in every bit.
  Redo update(const Scene& scene, bool afresh = false);
  /// Whether the solution began from an earlier one.
  bool warm() const { return warm_; }
  /// The scene of the last update() seen by a camera, as a stage of that name; may be stopped by Progress.
  ViewImage look(const Camera&, const std::string& stage);

  const LightSolution& solution() const { return *solution_; }
  const SceneOnGrid& on_grid() const { return *on_grid_; }

 private:
  void voxelise_changes(const Scene& scene, Redo redo);
  void solve(bool afresh);

  cl::Session& session_;
  Progress& progress_;
  Redo pending_ = Redo::all;  ///< the first stage that is not up to on_grid_->scene
  std::optional<SceneOnGrid> on_grid_;
  SceneFeatures prepared_for_;
  std::unique_ptr<TransportSolver> solver_;
  std::optional<LightSolution> solution_;
  bool answered_ = false;                 ///< solver_ has an answer to start from
  bool warm_ = false;
  FirstHits first_hits_;                  ///< in on_grid_
  std::optional<ViewPass> view_;  ///< refers to on_grid_, solution_ and first_hits_
};

}  // namespace turbid
