// SPDX-License-Identifier: Apache-2.0
// See pipeline.h.
#include "host/app/pipeline.h"

#include <cstdio>

#include "host/base/errors.h"
#include "host/report/checksum.h"

namespace turbid::app {

VoxelisedScene read_and_voxelise(const SceneOptions& options, Progress& progress) {
  progress.stage("read");
  Scene scene = read_scene(options.scene, options.overrides);
  scene.solver.photon.checkpoint = options.checkpoint;
  SceneOnGrid on_grid = put_on_grid(std::move(scene), progress);
  progress.stage("survey");
  const MediumSurvey survey = survey_medium(on_grid.medium);
  std::vector<std::string> warnings = on_grid.scene.warnings;
  for (const std::string& sentence : survey_warnings(on_grid.scene, on_grid.medium, survey))
    warnings.push_back(sentence);
  progress.finish();
  return {std::move(on_grid), survey, std::move(warnings)};
}

RunReport run_report(const VoxelisedScene& in, const cl::DeviceChoice& choice, const LightSolution& solution,
                     std::optional<ErrorEstimate> error, const Progress& progress) {
  return {.command_line = command_line(),
          .scene = in.scene,
          .features = in.features,
          .survey = in.survey,
          .device = choice,
          .solver = solution.report,
          .error = std::move(error),
          .allowed_imbalance = kAllowedImbalance,
          .times = progress.times(),
          .warnings = progress.warnings(),
          .outputs = {},
          .checksums = {{"fluence", checksum(solution.volume.fluence, solution.volume.deposit)}},
          .exposure = {}};
}

std::map<std::string, float> error_metadata(const std::optional<ErrorEstimate>& estimate) {
  std::map<std::string, float> numbers;
  const auto add = [&](const std::string& name, const ErrorParts& parts) {
    numbers[name] = static_cast<float>(parts.total());
    for (const auto& [part, value] :
         {std::pair("grid", parts.grid), std::pair("steps", parts.steps), std::pair("rays", parts.rays),
          std::pair("solve", parts.solve), std::pair("model", parts.model)})
      numbers[name + ":" + part] = static_cast<float>(value);
  };
  if (estimate) add("turbid:error:fluence", estimate->fluence);
  if (estimate && estimate->image) add("turbid:error:picture", *estimate->image);
  return numbers;
}

void require_balance(const EnergyBalance& energy) {
  const double imbalance = energy.imbalance();
  if (imbalance <= kAllowedImbalance) return;
  char text[160];
  std::snprintf(text, sizeof text, "the energy balance is off by %.2g of what was emitted, more than the %.0e allowed",
                imbalance, kAllowedImbalance);
  throw VerificationError(text);
}

}  // namespace turbid::app
