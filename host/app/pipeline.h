// SPDX-License-Identifier: Apache-2.0
// What commands share around a scene's run: reading and looking over its medium before, reporting after.
#pragma once
#include <string>
#include <vector>

#include "host/app/options.h"
#include "host/base/progress.h"
#include "host/study/medium_survey.h"
#include "host/report/run_report.h"
#include "host/study/scene_run.h"

namespace turbid::app {

/// A scene on its grid, looked over.
struct VoxelisedScene : SceneOnGrid {
  MediumSurvey survey;
  std::vector<std::string> warnings;  ///< of reading and of the survey
};

VoxelisedScene read_and_voxelise(const SceneOptions&, Progress&);

/// What every run reports; the command adds its outputs, checksums of its own and the exposure. Refers to its arguments.
RunReport run_report(const VoxelisedScene&, const cl::DeviceChoice&, const LightSolution&, const Progress&);

/// Throws VerificationError if the run lost or made energy.
void require_balance(const EnergyBalance&);

}  // namespace turbid::app
