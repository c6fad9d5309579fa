// SPDX-License-Identifier: Apache-2.0
// Repeated light() of prepared scenes, interleaved where several are compared, so that drift meets all alike.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/profile/frame.h"
#include "host/profile/spread.h"

namespace turbid {

/// A scene file with overrides, prepared, and what its runs took.
class LightRun {
 public:
  /// `change` may alter the scene after reading.
  LightRun(cl::Session&, const std::string& scene_file, const SceneOverrides&,
           const std::function<void(Scene&)>& change = {});
  /// The same voxels as `like`, shared with it, under other settings: `change` may alter the solver, lights and camera
  /// only; `features_of` may ask for more physics than the scene needs.
  LightRun(cl::Session&, const LightRun& like, const std::function<void(Scene&)>& change,
           const std::function<SceneFeatures(SceneFeatures)>& features_of = {});

  /// One light(), and a picture if asked for; its times are kept if `keep`.
  void once(bool picture, bool keep);
  void forget_times();
  bool timed() const { return !seconds_.empty(); }
  Spread seconds() const { return spread_of(seconds_); }    ///< of light() [s]
  Spread view_seconds() const { return spread_of(view_); }  ///< of the picture [s]
  Spread frame_seconds() const;                             ///< of both [s]
  Spread stage(const std::string& name) const;              ///< of one stage [s]
  /// Processor time of all threads over wall time and cores, of the runs kept [1]: what is missing to 1 is all that any
  /// arrangement of the same work could save. Of use where the device is the host's own processor.
  double cores_busy(int cores) const;
  const LightSolution& solution() const { return *solution_; }
  const ViewImage& image() const { return *image_; }
  const SceneOnGrid& scene() const { return *scene_; }
  PreparedScene& prepared() { return *prepared_; }
  const std::vector<float>& fluence() const { return solution_->volume.fluence; }

 private:
  std::unique_ptr<Progress> progress_ = std::make_unique<Progress>(Verbosity::quiet);
  std::unique_ptr<SceneOnGrid> scene_;
  std::unique_ptr<PreparedScene> prepared_;
  std::optional<LightSolution> solution_;
  std::optional<ViewImage> image_;
  std::vector<double> seconds_, view_, processor_;
  std::vector<std::vector<StageTime>> stages_;
};

/// Several runs of one scene on the same voxels.
class Runs {
 public:
  Runs(cl::Session& session, const std::string& scene_file, const SceneOverrides& overrides)
      : session_(session), file_(scene_file), overrides_(overrides) {}
  /// One more, with the solver's settings changed.
  void add(const std::function<void(Scene&)>& change);
  /// In the order in which they were added.
  const std::vector<LightRun*>& all() const { return all_; }

 private:
  cl::Session& session_;
  std::string file_;
  SceneOverrides overrides_;
  std::vector<std::unique_ptr<LightRun>> owned_;
  std::vector<LightRun*> all_;
};

/// One run of each to warm up, then `repeats` rounds of all in turn, but no further round once `most_seconds` have
/// passed and each was timed once.
void run_interleaved(const std::vector<LightRun*>&, int repeats, bool picture, double most_seconds = 1e9);

}  // namespace turbid
