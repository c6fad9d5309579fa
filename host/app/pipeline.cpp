// SPDX-License-Identifier: Apache-2.0
// Scene file to light solution.
#include "host/app/pipeline.h"

#include <cstdio>

#include "host/base/errors.h"
#include "host/report/checksum.h"

namespace turbid::app {

VoxelisedScene read_and_voxelise(const SceneOptions& options, Progress& progress) {
  progress.stage("read");
  Scene scene = read_scene(options.scene, options.overrides);
  scene.solver.photon.checkpoint = options.checkpoint;
  progress.stage("voxelise");
  MediumVolume medium = voxelise(scene.medium, [&](double fraction) { progress.update(fraction); });
  progress.stage("survey");
  const SceneFeatures features = scene_features(medium, scene.lights);
  const MediumSurvey survey = survey_medium(medium);
  std::vector<std::string> warnings = scene.warnings;
  for (const std::string& sentence : survey_warnings(scene, medium, survey)) warnings.push_back(sentence);
  progress.finish();
  return {std::move(scene), std::move(medium), features, survey, std::move(warnings)};
}

LightSolution solve_light(cl::Session& session, const VoxelisedScene& in, Progress& progress) {
  const auto solver = make_solver({.session = session,
                                   .progress = progress,
                                   .settings = in.scene.solver,
                                   .features = in.features,
                                   .description = in.scene.medium,
                                   .surroundings = in.scene.surroundings});
  solver->prepare(in.medium);
  LightSolution solution = solver->light(in.scene.lights);
  progress.finish();
  return solution;
}

RunReport run_report(const VoxelisedScene& in, const cl::DeviceChoice& choice, const LightSolution& solution,
                     const Progress& progress) {
  return {.command_line = command_line(),
          .scene = in.scene,
          .features = in.features,
          .survey = in.survey,
          .device = choice,
          .solver = solution.report,
          .allowed_imbalance = kAllowedImbalance,
          .times = progress.times(),
          .warnings = progress.warnings(),
          .outputs = {},
          .checksums = {{"fluence", checksum(solution.volume.fluence, solution.volume.deposit)}},
          .exposure = {}};
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
