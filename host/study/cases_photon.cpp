// SPDX-License-Identifier: Apache-2.0
// The Monte Carlo reference against closed forms and itself: what `turbid verify photon --photons 1e7` tells of it.
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/photon_checks.h"
#include "host/study/photon_runs.h"

namespace turbid::study {
namespace {

/// Errors of the voxels' fluence in a closed box whose medium emits what it absorbs: the fluence is 1 everywhere.
RefinedLevel cavity_errors(CaseContext& context, double photon_count) {
  MediumDescription scene = empty_domain(glm::ivec3(16), 0.5f, FaceBoundary::mirror);
  set_ambient(scene, make_material({.sigma_s = glm::vec3(1), .sigma_a = glm::vec3(0.5f), .emission = glm::vec3(0.5f)}));
  const PhotonAnswer answer =
      follow(context.session, scene, photons(static_cast<std::int64_t>(photon_count), 3), LightList{});
  RefinedLevel level{.h = 1 / std::sqrt(photon_count)};
  level.l1 = level.l2 = level.linf = 0;
  for (std::size_t i = 0; i < answer.region.size(); ++i) {
    const double error = std::abs(answer.fluence(i) - 1);
    level.l1 += error;
    level.l2 += error * error;
    level.linf = std::max(level.linf, error);
  }
  const auto voxels = static_cast<double>(answer.region.size());
  level.l1 /= voxels;
  level.l2 = std::sqrt(level.l2 / voxels);
  level.energy_imbalance = answer.solution.report.energy.imbalance();
  return level;
}

Refinement cavity_refinement() {
  Refinement r;
  r.parameter = "photons";
  r.unit = "1/sqrt(photons)";
  r.levels = {2e3, 8e3, 3.2e4, 1.28e5};
  r.order = 1;
  r.order_low = 0.9;  // 4096 voxels, neighbours alike: the errors of their rms scatter by a few per cent
  r.order_high = 1.1;
  r.error_names = {"L1 of the fluence", "L2 of the fluence", "L-infinity of the fluence"};
  r.run = cavity_errors;
  return r;
}

Case photon_case() {
  Case c{.number = 0,
         .name = "photon",
         .title = "Photons against closed forms, within 3 standard errors (--photons 1e7 for small ones)",
         .equation =
             "T = e^-2; fluence of transport around a point; Fresnel; T of a slab of albedo 1, R + T = 1; fluence 1",
         .source =
             "Beer and Lambert; Case, de Hoffmann and Placzek 1953; Born and Wolf 1.5; Milne; equilibrium in a cavity"};
  c.refinements = {cavity_refinement()};
  c.check = [](CaseContext& context, CaseResult& result) {
    check_unscattered_photons(context, result);
    check_fresnel_photons(context, result);
    check_slab_photons(context, result);
    check_point_photons(context, result);
  };
  return c;
}

}  // namespace

std::vector<Case> photon_cases() {
  return {photon_case()};
}

}  // namespace turbid::study
