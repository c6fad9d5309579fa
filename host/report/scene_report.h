// SPDX-License-Identifier: Apache-2.0
// What check and voxelise report: the effective scene, what it needs, its grid, and what is doubtful.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/cl/device.h"
#include "host/study/medium_survey.h"
#include "host/scene/features.h"
#include "host/scene/scene.h"

namespace turbid {

struct SceneReport {
  const Scene& scene;
  const SceneFeatures& features;
  const MediumSurvey& survey;
  std::vector<std::string> warnings;
  std::string output;  ///< file written; empty: none
  std::optional<cl::DeviceChoice> device = {};
};

std::string scene_json(const SceneReport&);
/// The effective scene as TOML, everything else in its comments.
std::string scene_text(const SceneReport&);
/// Voxels, active blocks, optical thickness, memory: one line each.
std::string grid_text(const SceneReport&);

/// "123 MB"
std::string megabytes(std::uint64_t bytes);

}  // namespace turbid
