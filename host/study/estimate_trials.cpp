// SPDX-License-Identifier: Apache-2.0
// See estimate_trials.h.
#include "host/study/estimate_trials.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"

namespace turbid {
namespace {

/// Half of a voxel of the run: finer voxels at a surface are missing from the others.
constexpr double kLeastShare = 0.5;

Judged judge(double estimate, double squared, double spread) {
  return {estimate, std::sqrt(squared), squared > 2 * spread};
}

Coverage coverage(const std::vector<EstimateTrial>& trials, Judged EstimateTrial::*of) {
  Coverage result;
  std::vector<double> ratios;
  for (const EstimateTrial& trial : trials) {
    const Judged& v = trial.*of;
    ++result.trials;
    result.covered += v.covered();
    if (!v.resolved) continue;
    ratios.push_back(v.estimate / v.error);
    if (v.error / v.estimate > result.largest_shortfall) {
      result.largest_shortfall = v.error / v.estimate;
      result.farthest = trial.name;
    }
  }
  if (result.trials > 0) result.share = static_cast<double>(result.covered) / static_cast<double>(result.trials);
  if (ratios.empty()) return result;
  std::sort(ratios.begin(), ratios.end());
  const std::size_t n = ratios.size();
  result.median_ratio = 0.5 * (ratios[(n - 1) / 2] + ratios[n / 2]);
  result.largest_ratio = ratios.back();
  return result;
}

}  // namespace

EstimateTrial try_estimate(cl::Session& session, Scene scene, const ReferenceSettings& settings) {
  if (!scene.has_camera) throw InputError(scene.path + ": has no [camera], so there is no picture");
  if (scene.solver.solver == "photon") scene.solver.solver = "steady";
  if (scene.solver.error_estimate == EstimateEffort::off) scene.solver.error_estimate = EstimateEffort::quick;
  const double started = wall_time();
  const SceneRun run = run_scene(session, scene, true);
  Progress quiet(Verbosity::quiet);
  ViewPass view = view_of(session, run.on_grid, run.solution);
  const ErrorEstimate estimate = *estimate_error(session, run.on_grid, run.solution, &view, quiet);
  EstimateTrial trial;
  trial.name = scene.name;
  trial.fluence_parts = estimate.fluence;
  trial.image_parts = *estimate.image;
  trial.seconds = wall_time() - started;
  trial.estimate_seconds = estimate.seconds;

  ReferenceSettings reference_settings = settings;
  reference_settings.picture = true;
  reference_settings.seed += 1000;  // not that of the run, nor of its estimate
  const PhotonReference reference = photon_reference(session, finer_scene(scene, 2), reference_settings);
  const auto values = common_values(sample_fluence(run.solution.volume, run.on_grid.medium),
                                    {&reference.fluence_a, &reference.fluence_b}, kLeastShare);
  const ReferenceErrors fluence = errors_against(values[0], values[1], values[2]);
  const ReferenceErrors image = image_errors(*run.image, reference);
  trial.fluence = judge(estimate.fluence.total(), fluence.rel_l2 * fluence.rel_l2, fluence.rel_l2_spread);
  trial.image = judge(estimate.image->total(), image.relmse, image.relmse_spread);
  return trial;
}

Coverage fluence_coverage(const std::vector<EstimateTrial>& trials) {
  return coverage(trials, &EstimateTrial::fluence);
}
Coverage image_coverage(const std::vector<EstimateTrial>& trials) {
  return coverage(trials, &EstimateTrial::image);
}

}  // namespace turbid
