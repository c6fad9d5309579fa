// SPDX-License-Identifier: Apache-2.0
// See photon_checks.h.
#include "host/study/photon_checks.h"

#include <cmath>

#include "host/study/photon_runs.h"

namespace turbid::study {
namespace {

constexpr glm::vec3 kCentre(3.5f, 3.5f, 0);  // of the face that slabs are lit through

Material milk(float sigma_s, float sigma_a, float eta = 1) {
  return make_material({.sigma_s = glm::vec3(sigma_s), .sigma_a = glm::vec3(sigma_a), .eta = eta});
}

}  // namespace

void check_slab_photons(CaseContext& context, CaseResult& result) {
  const PhotonAnswer answer =
      follow(context.session, slab(16, 0.625f, milk(1, 0)), photons(80000), {source(TURBID_SOURCE_LAMBERT, kCentre)});
  const Estimate& back = answer.tallies().escaped_faces[4];
  const Estimate& through = answer.tallies().escaped_faces[5];
  result.absolute("T, photons", 4.0 / 3 / (10 + 2 * 0.710446), through.value.x, 0,
                  "Milne's problem from either side, exact up to e^-10", "1", through.error.x);
  result.absolute("R + T, photons", 1, back.value.x + through.value.x, 1e-12, "nothing is absorbed; integer sums");
  result.note_imbalance(answer.solution.report.energy.imbalance());
}

void check_layer_photons(CaseContext& context, CaseResult& result) {
  const double expected[2] = {0.15488, 0.06888};
  for (const int reversed : {0, 1}) {
    MediumDescription scene = slab(32, 0.3125f, milk(1, 0, reversed ? 1.5f : 1.0f));
    add_body(scene, make_box({100, 100, 10}, at({0, 0, 10})), milk(1, 0, reversed ? 1.0f : 1.5f));
    const PhotonAnswer answer =
        follow(context.session, scene, photons(80000), {source(TURBID_SOURCE_LAMBERT, kCentre)});
    const Estimate& through = answer.tallies().escaped_faces[5];
    result.absolute(reversed ? "T, 1.5 | 1, photons" : "T, 1 | 1.5, photons", expected[reversed], through.value.x, 0,
                    "independent Monte Carlo program", "1", std::hypot(through.error.x, 0.00008));
    result.note_imbalance(answer.solution.report.energy.imbalance());
  }
}

void check_sphere_photons(CaseContext& context, CaseResult& result, bool glass) {
  MediumDescription scene = empty_domain(glm::ivec3(32), 2.2f / 32, FaceBoundary::open, true);
  add_body(scene, make_sphere(1, {}), milk(9.9f, 0.1f, glass ? 1.5f : 1.0f));
  const PhotonAnswer answer = follow(context.session, scene, photons(100000), LightList{point_light({0, 0, 0})});
  const Estimate& escaped = answer.tallies().escaped;
  result.absolute("escape, photons", glass ? 0.53433 : 0.59712, escaped.value.x, 1e-4,
                  "independent Monte Carlo program; the sampled radius may be off by a few 1e-3 of a voxel", "1",
                  std::hypot(escaped.error.x, 0.00005));
  result.note_imbalance(answer.solution.report.energy.imbalance());
}

void check_point_photons(CaseContext& context, CaseResult& result) {
  // The domain ends after 12 mean free paths. Voxels that a shell cuts count by their share of it: with voxels of a
  // quarter that leaves less than half a per cent. Five seeds give the standard errors of the shells' means.
  constexpr int kSeeds = 5;
  double mean[3][kSeeds] = {};
  for (int seed = 0; seed < kSeeds; ++seed) {
    MediumDescription scene = empty_domain(glm::ivec3(96), 0.25f, FaceBoundary::open, true);
    set_ambient(scene, milk(0.9f, 0.1f));
    const PhotonAnswer answer =
        follow(context.session, scene, photons(30000, seed, 2), LightList{point_light({0, 0, 0})});
    result.note_imbalance(answer.solution.report.energy.imbalance());
    double volume[3] = {};
    for (std::size_t i = 0; i < answer.region.size(); ++i) {
      const glm::vec3 corner = glm::vec3(answer.voxel(i) - 48);
      const float middle = 0.25f * glm::length(corner + 0.5f);
      if (middle < 1.7f || middle > 7.3f) continue;
      const double fluence = answer.fluence(i);
      for (int part = 0; part < 8; ++part) {
        const glm::vec3 point = corner + (glm::vec3(part & 1, part >> 1 & 1, part >> 2) + 0.5f) * 0.5f;
        const int shell = static_cast<int>(0.25f * glm::length(point));
        if (shell != 2 && shell != 4 && shell != 6) continue;
        mean[shell / 2 - 1][seed] += fluence;
        volume[shell / 2 - 1] += 1;
      }
    }
    for (int shell = 0; shell < 3; ++shell) mean[shell][seed] /= volume[shell];
  }
  const double expected[3] = {2.196e-2, 4.212e-3, 1.0195e-3};
  for (int shell = 0; shell < 3; ++shell) {
    double sum = 0, square = 0;
    for (const double value : mean[shell]) {
      sum += value / kSeeds;
      square += value * value / kSeeds;
    }
    result.relative(
        "fluence at " + std::to_string(2 * shell + 2) + " to " + std::to_string(2 * shell + 3) + " mfp, photons",
        expected[shell], sum, 0.005, "shells cut voxels of a quarter mean free path", "1/mfp^2",
        std::sqrt((square - sum * sum) / (kSeeds - 1)));
  }
}

}  // namespace turbid::study
