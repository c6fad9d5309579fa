// SPDX-License-Identifier: Apache-2.0
// Frames of a prepared scene: light and picture computed again and again with everything else kept, and what the device and
// the host did meanwhile.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "host/cl/session.h"
#include "host/study/scene_run.h"

namespace turbid {

/// One stretch of recorded work: a frame, or the preparation.
struct Frame {
  double started = 0, ended = 0;              ///< [s], host
  std::vector<cl::Command> commands;
  std::vector<cl::BuiltProgram> programs;
  std::vector<cl::HostStage> stages;

  double seconds() const { return ended - started; }
};

/// Time in which at least one of the commands ran [s]: overlapping ones count once.
double busy_seconds(const std::vector<const cl::Command*>&);
/// The same for a frame's kernels, without copies.
double kernel_seconds(const Frame&);
/// For all of a frame's commands, copies included.
double device_seconds(const Frame&);

/// A scene whose medium is on the device and whose solver has prepared what does not depend on light or camera. A warm frame
/// is light() and then look(), the second time or later.
class PreparedScene {
 public:
  /// Runs the stages up to and including "prepare". All arguments must outlive this.
  PreparedScene(cl::Session&, const SceneOnGrid&, Progress&, const SceneFeatures&);
  PreparedScene(cl::Session& session, const SceneOnGrid& scene, Progress& progress)
      : PreparedScene(session, scene, progress, scene.features) {}
  ~PreparedScene();

  LightSolution light(const LightList&);
  LightSolution light() { return light(scene_.scene.lights); }
  /// A picture by the scene's camera; empty if it has none.
  std::optional<ViewImage> look(const LightSolution&);

 private:
  cl::Session& session_;
  const SceneOnGrid& scene_;
  Progress& progress_;
  SceneFeatures features_;
  std::unique_ptr<TransportSolver> solver_;
  FirstHits first_hits_;
};

/// Records what `work` does, stages of `progress` included.
Frame record(cl::Session&, Progress&, const std::function<void()>& work);

}  // namespace turbid
