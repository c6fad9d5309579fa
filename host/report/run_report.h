// SPDX-License-Identifier: Apache-2.0
// What render and solve report, as JSON for scripts and as text for people.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/base/progress.h"
#include "host/cl/device.h"
#include "host/study/medium_survey.h"
#include "host/report/named_texts.h"
#include "host/scene/features.h"
#include "host/scene/scene.h"
#include "host/study/error_estimate.h"
#include "host/transport/solver.h"

namespace turbid {

struct RunReport {
  const std::string& command_line;
  const Scene& scene;
  const SceneFeatures& features;
  const MediumSurvey& survey;
  const cl::DeviceChoice& device;
  const SolverReport& solver;
  std::optional<ErrorEstimate> error;  ///< how wrong it is, by its own estimate
  double allowed_imbalance = 0;  ///< above it the run counts as failed [-]
  const std::vector<StageTime>& times;
  const std::vector<std::string>& warnings;
  NamedTexts outputs;             ///< files written
  NamedTexts checksums;           ///< of the results' bits
  std::optional<float> exposure;  ///< of the preview [stops]; render only
  std::string chosen = {};        ///< settings that --error chose, and why; empty: none were
};

std::string report_json(const RunReport&);
/// Files, numbers, times and the energy table; only the files if `brief`.
std::string report_text(const RunReport&, bool brief);

}  // namespace turbid
