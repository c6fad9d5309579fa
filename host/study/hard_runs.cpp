// SPDX-License-Identifier: Apache-2.0
// See hard_runs.h.
#include "host/study/hard_runs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/scene/scene.h"
#include "host/study/medium_survey.h"
#include "host/study/run_warnings.h"

namespace turbid::study {
namespace {

constexpr double kBalance = 1e-5;

std::vector<std::string> warnings_of(const HardScene& scene, const Run& run, const SolverSettings& settings) {
  Scene described;
  described.medium = scene.medium;
  described.lights = scene.lights;
  std::vector<std::string> warnings = survey_warnings(described, run.medium, survey_medium(run.medium));
  for (std::string& sentence : run_warnings(run.solution.report, settings)) warnings.push_back(std::move(sentence));
  return warnings;
}

}  // namespace

SolverSettings hard_settings(const std::string& solver, std::int64_t photons) {
  SolverSettings settings;
  settings.solver = solver;
  settings.lattice.tolerance = 1e-3f;
  settings.photon.photons = photons;
  return settings;
}

HardRun run_hard(CaseContext& context, CaseResult& result, const std::string& name, const HardScene& scene,
                 const SolverSettings& settings) {
  HardRun hard{run(context.session, scene.medium, scene.lights, settings), {}};
  hard.warnings = warnings_of(scene, hard.run, settings);
  const EnergyBalance& energy = hard.run.energy();
  const std::string of = ", " + settings.solver + ", " + name;
  result.note_imbalance(energy.imbalance());
  result.at_most("energy imbalance" + of, kBalance, energy.imbalance(), "single precision, sums in double");
  double lowest = 0, highest = 0, wrong = 0;
  for (const float value : hard.run.solution.volume.fluence) {
    wrong += !std::isfinite(value);
    lowest = std::min(lowest, static_cast<double>(value));
    highest = std::max(highest, static_cast<double>(value));
  }
  result.at_most("voxels that are not finite" + of, 0, wrong, "every number is a number");
  if (highest > 0)
    result.at_least("least / largest fluence" + of, -1e-4, lowest / highest,
                    "the exact solution of an M-matrix is not negative; a solve to 1e-4 of its norm");
  return hard;
}

HardRun run_both(CaseContext& context, CaseResult& result, const std::string& name, const HardScene& scene) {
  run_hard(context, result, name, scene, hard_settings("lattice"));
  return run_hard(context, result, name, scene, hard_settings("steady"));
}

void must_warn(CaseResult& result, const std::string& name, const std::vector<std::string>& warnings,
               const std::string& part) {
  double found = 0;
  for (const std::string& sentence : warnings)
    if (sentence.find(part) != std::string::npos) {
      ++found;
      result.notes.push_back("warns, " + name + ": " + sentence);
    }
  result.at_least("warnings of it, " + name, 1, found, "a run that cannot meet its bound says so");
}

double entered(const Run& run) {
  return run.energy().emitted.x - run.energy().missed.x;
}
double escaped_share(const Run& run) {
  return run.energy().escaped.x / entered(run);
}
double face_share(const Run& run, int face) {
  return run.energy().escaped_faces[static_cast<std::size_t>(face)].x / entered(run);
}
double face_error(const Run& run, int face) {
  return run.solution.report.photon->escaped_faces[static_cast<std::size_t>(face)].error.x / entered(run);
}

HardScene lit_slab(int n, float voxel_size, const Material& material, glm::vec3 direction) {
  HardScene scene{empty_domain({8, 8, n}, voxel_size), {sunlight(direction)}};
  for (int face = 0; face < 4; ++face) scene.medium.faces[static_cast<std::size_t>(face)] = FaceBoundary::periodic;
  set_ambient(scene.medium, material);
  return scene;
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

}  // namespace turbid::study
