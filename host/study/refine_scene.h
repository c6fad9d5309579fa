// SPDX-License-Identifier: Apache-2.0
// A scene computed with one parameter from coarse to fine, the others fine enough not to mix their errors in: how fast
// its error falls, and what each level costs.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/study/convergence.h"
#include "host/study/photon_reference.h"

namespace turbid {

/// What can be refined in a scene.
struct SceneParameter {
  std::string name;
  std::string level_unit;      ///< of the levels as they are given
  std::string h_unit;          ///< of h, what the error is a power of
  bool rising = true;          ///< levels from coarse to fine rise (voxels, rays, photons) or fall (step, tolerance)
  double order = 0;            ///< expected order in h; 0: none is
  double least_order = 0;      ///< that passes
  std::string why;             ///< the least order differs from the expected one
  std::vector<double> levels;  ///< default; empty: the scene's resolution / 4, / 2 and itself
};

const std::vector<SceneParameter>& scene_parameters();
/// Throws InputError that names what there is.
const SceneParameter& find_scene_parameter(const std::string& name);
/// Throws InputError if there are fewer than two, they do not run from coarse to fine, or one is out of range.
void check_levels(const SceneParameter&, const std::vector<double>& levels);

struct RefineSettings {
  std::vector<double> levels;   ///< checked
  int repeat = 1;               ///< timed runs per level, after one that warms up; times are medians
  bool picture = false;         ///< look at each level, and compare the pictures too
  bool against_photon = false;  ///< else against finer levels
  ReferenceSettings reference;  ///< of the photons
  /// A second parameter at one of its levels; the reference keeps it fine.
  struct Beside {
    SceneParameter parameter;
    double level = 0;
  };
  std::optional<Beside> beside = {};
};

struct SceneLevel {
  double level = 0, h = 0;
  ReferenceErrors fluence = {};
  std::optional<ReferenceErrors> image = {};
  std::optional<double> flip = {};
  std::vector<StageTime> stages = {};  ///< median of the repeats
  double seconds = 0;                  ///< of all stages
  std::uint64_t peak_memory = 0;       ///< [bytes]
  std::optional<ViewImage> picture = {};
};

struct SceneRefinement {
  SceneParameter parameter;
  std::string reference = {};  ///< what the errors are against
  double noise = 0;            ///< of the reference, relative L2 of the fluence
  std::vector<SceneLevel> levels = {};
  std::optional<FittedOrder> fit = {};  ///< of the fluence's relative L2
  bool judged = false;                  ///< an order is expected here
  std::optional<ViewImage> reference_picture = {};
  std::optional<RefineSettings::Beside> beside = {};  ///< refined together with it

  bool passed() const { return !judged || (fit && fit->order >= parameter.least_order); }
};

/// read(resolution) reads the scene with so many voxels along its longest side; nothing: as it says. `level` is told
/// of each run before it begins. Throws InputError if resolutions are not multiples of the first.
using ReadScene = std::function<Scene(std::optional<int> resolution)>;
SceneRefinement refine_scene(cl::Session&, const ReadScene& read, const SceneParameter&, const RefineSettings&,
                             const std::function<void(const std::string& level)>& tell);

/// Median per stage of runs that have the same stages.
std::vector<StageTime> median_times(const std::vector<std::vector<StageTime>>& runs);

}  // namespace turbid
