// SPDX-License-Identifier: Apache-2.0
// A scene computed as a library call: voxelise, solve, look at it. Commands, studies and measurements all go through
// these.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/base/progress.h"
#include "host/cl/session.h"
#include "host/scene/features.h"
#include "host/scene/scene.h"
#include "host/transport/solver.h"
#include "host/view/view_pass.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// Largest relative energy imbalance that a run may have [-].
inline constexpr double kAllowedImbalance = 1e-4;

/// A scene with its medium as voxels.
struct SceneOnGrid {
  Scene scene;
  MediumVolume medium;
  SceneFeatures features;
};

/// Stage "voxelise".
SceneOnGrid put_on_grid(Scene, Progress&);
/// The stages of the solver that the scene names.
LightSolution solve_light(cl::Session&, const SceneOnGrid&, Progress&);
/// By other settings than the scene's, once for each seed in place of theirs.
std::vector<LightSolution> solve_light(cl::Session&, const SceneOnGrid&, const SolverSettings&,
                                       const std::vector<std::uint64_t>& seeds, Progress&);
/// Ready to be looked at through any camera; refers to its arguments. The scene has a camera, or throws
/// std::invalid_argument.
ViewPass view_of(cl::Session&, const SceneOnGrid&, const LightSolution&);
/// Stage "view"; the scene has a camera, or throws std::invalid_argument.
ViewImage look_at(cl::Session&, const SceneOnGrid&, const LightSolution&, Progress&);

/// One whole run with what it cost.
struct SceneRun {
  SceneOnGrid on_grid;
  LightSolution solution;
  std::optional<ViewImage> image;  ///< if it was asked for
  std::vector<StageTime> times;    ///< in order
  std::uint64_t peak_memory = 0;   ///< largest resident set of the process while it ran [bytes]
  double seconds() const;          ///< of all stages together
};

/// Reads nothing: `scene` may have been changed since read_scene. Quiet unless `talk` says otherwise.
SceneRun run_scene(cl::Session&, Scene scene, bool picture, Verbosity talk = Verbosity::quiet);

/// Seconds of the stage of this name, all its parts together; 0 if there was none.
double seconds_of(const std::vector<StageTime>&, const std::string& stage);

}  // namespace turbid
