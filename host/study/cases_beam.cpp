// SPDX-License-Identifier: Apache-2.0
// Beams into optically thick voxels and into forward-scattering media (numerics section 8, cases 12 and 13): where the
// first flight leaves its light, and which way that was going.
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/small_media.h"

namespace turbid::study {
namespace {

/// Share of a normal beam from -z that a plate gives back towards -z and lets through towards +z.
struct Shares {
  double reflected = 0, transmitted = 0, imbalance = 0;
};
/// `voxels` of optical thickness s = sigma_t h; matched index.
Shares plate(CaseContext& context, const std::string& solver, int voxels, double s, double albedo, double g) {
  MediumDescription scene = empty_domain({8, 8, 8 * ((voxels + 15) / 8)}, 1.0f, FaceBoundary::periodic);
  scene.faces[4] = scene.faces[5] = FaceBoundary::open;
  const float thickness = static_cast<float>(voxels);
  add_body(scene, make_box({100, 100, thickness}, at({4, 4, 4 + 0.5f * thickness})),
           make_material({.sigma_s = glm::vec3(static_cast<float>(albedo * s)),
                          .sigma_a = glm::vec3(static_cast<float>((1 - albedo) * s)),
                          .g = static_cast<float>(g)}));
  SolverSettings settings;
  settings.solver = solver;
  settings.lattice.tolerance = 1e-5f;
  settings.steady.tolerance = 1e-5f;
  const EnergyBalance e = run(context.session, scene, {sunlight({0, 0, 1})}, settings).energy();
  const double entered = e.emitted.x - e.missed.x;
  return {e.escaped_faces[4].x / entered, e.escaped_faces[5].x / entered, e.imbalance()};
}

Case half_space_case() {
  Case c{.number = 12,
         .name = "half-space",
         .title = "Half-space, normal beam, albedo .99, in voxels of several mean free paths",
         .equation = "R = .7526",
         .source = "exact transport (numerics section 8); beyond s = 5 a run warns"};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const double s : {1.0, 2.0, 5.0}) {
      const Shares found = plate(context, "steady", s < 2 ? 64 : s < 5 ? 40 : 16, s, 0.99, 0);
      char name[32];
      std::snprintf(name, sizeof name, "R at s = %g", s);
      result.relative(name, 0.7526, found.reflected, 0.015, "numerics, case 12");
      result.note_imbalance(found.imbalance);
    }
  };
  return c;
}

Case forward_case() {
  Case c{.number = 13,
         .name = "forward",
         .title = "Slab of 100 mean free paths that scatters forwards, g = .9, albedo .999, normal beam",
         .equation =
             "sigma' = (1 - w g^2) sigma on first flight, g* = g / (1 + g); its first moment Q1 drives "
             "J = (Q1 - grad phi / 3) / sigma_tr",
         .source = "Monte Carlo R .734, T .0836 (numerics section 8); delta-Eddington, Joseph et al. 1976"};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const char* solver : {"steady", "lattice"}) {
      const Shares found = plate(context, solver, 40, 2.5, 0.999, 0.9);
      result.relative(std::string("R, ") + solver, 0.734, found.reflected, 0.03, "numerics, case 13");
      result.relative(std::string("T, ") + solver, 0.0836, found.transmitted, 0.03, "numerics, case 13");
      result.note_imbalance(found.imbalance);
    }
  };
  return c;
}

}  // namespace

std::vector<Case> beam_cases() {
  return {half_space_case(), forward_case()};
}

}  // namespace turbid::study
