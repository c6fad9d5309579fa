// SPDX-License-Identifier: Apache-2.0
// Hard cases: large jumps of the refractive index, and light that total reflection holds for ever.
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/hard_runs.h"
#include "host/transport/fresnel_moments.h"

namespace turbid::study {
namespace {

Case jump_case() {
  Case c{.number = 0,
         .name = "hard-jump",
         .title = "Index jumps 1 | 2.5 and 2.5 | 1 between two layers of 5 mean free paths, and a ball in a medium",
         .equation =
             "T = 4 / eta_1^2 / (17 / eta_1^2 + r + 17 / eta_2^2) for diffuse light; R and T of photons under a beam",
         .source = "Monte Carlo; numerics section 3",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const auto& [first, second] : {std::pair{1.0f, 2.5f}, std::pair{2.5f, 1.0f}}) {
      HardScene scene = lit_slab(32, 10.0f / 32, make_material({.sigma_s = glm::vec3(1), .eta = first}));
      add_body(scene.medium, make_box({40, 40, 20}, at({1.25f, 1.25f, 15})),
               make_material({.sigma_s = glm::vec3(1), .eta = second}));
      const std::string name = short_number(first) + " | " + short_number(second);
      const HardRun found = run_both(context, result, name, scene);
      const HardRun exact = run_hard(context, result, name, scene, hard_settings("photon", 40000));
      result.absolute("T, steady against photons, " + name, face_share(exact.run, 5), face_share(found.run, 5), 0.01,
                      "diffusion at 5 mean free paths, share of the light", "1", face_error(exact.run, 5));
      result.relative("R + T, " + name, 1,
                      (found.run.energy().reflected.x + found.run.energy().escaped.x) / entered(found.run), 1e-5,
                      "nothing absorbs");
    }
    for (const bool inside : {true, false}) {
      HardScene scene{empty_domain(glm::ivec3(24), 1), {sunlight({0, -0.3f, 1})}};
      set_ambient(
          scene.medium,
          make_material({.sigma_s = glm::vec3(0.3f), .sigma_a = glm::vec3(0.003f), .eta = inside ? 1.0f : 2.5f}));
      add_body(scene.medium, make_sphere(8, at(glm::vec3(12))),
               make_material({.sigma_s = glm::vec3(0.4f), .sigma_a = glm::vec3(0.002f), .eta = inside ? 2.5f : 1.0f}));
      const std::string name = inside ? "ball of 2.5 in 1" : "ball of 1 in 2.5";
      const HardRun found = run_both(context, result, name, scene);
      const HardRun exact = run_hard(context, result, name, scene, hard_settings("photon"));
      const auto absorbed = [](const Run& r) { return r.energy().absorbed.x / entered(r); };
      result.relative("absorbed share, steady against photons, " + name, absorbed(exact.run), absorbed(found.run), 0.1,
                      "diffusion at a few mean free paths", "1",
                      exact.run.solution.report.photon->absorbed.error.x / entered(exact.run));
    }
  };
  return c;
}

Case trapped_case() {
  Case c{.number = 0,
         .name = "hard-trapped",
         .title = "A lamp inside clear glass of index 2.5, most of whose light is reflected totally for ever",
         .equation = "held by an endless plate: sqrt(1 - 1 / eta^2); by a cube up to 3 sqrt(1 - 1 / eta^2) - 2",
         .source = "escape cones that do not overlap; reflections at a cube keep |d_x|, |d_y| and |d_z|",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    constexpr int kReflections = 32;
    const double cosine = std::sqrt(1 - 1 / 6.25);
    for (const bool plate : {true, false}) {
      HardScene scene{empty_domain(glm::ivec3(24), 1), {point_light({12.3f, 11.8f, 12.1f})}};
      for (std::size_t face = 0; plate && face < 4; ++face) scene.medium.faces[face] = FaceBoundary::periodic;
      const float edge = plate ? 100 : 18;
      add_body(scene.medium, make_box({edge, edge, 18}, at(glm::vec3(12))), make_material({.eta = 2.5f}));
      for (const char* solver : {"steady", "photon"}) {
        SolverSettings settings = hard_settings(solver);
        settings.photon.max_steps = kReflections;
        const std::string name = std::string(plate ? "plate, " : "cube, ") + solver;
        const HardRun found = run_hard(context, result, plate ? "plate" : "cube", scene, settings);
        const double in_flight = found.run.energy().in_flight.x / found.run.energy().emitted.x;
        if (plate)
          result.absolute("in flight at the end, " + name, cosine, in_flight, 0.01,
                          "solid angles of the lamp's rays; what Fresnel still holds after 16 bounces");
        else
          // Corners of a sampled cube are cut within half a voxel of its edges: 2 / 18 of a face's width. What meets
          // them may get out, so at least (1 - 2/18) is held per reflection: by marched rays 16 times, by photons at
          // most once per step.
          result.within("in flight at the end, " + name,
                        (3 * cosine - 2) * std::pow(1 - 2.0 / 18, std::string(solver) == "steady" ? 16 : kReflections),
                        3 * cosine - 2 + 0.01, in_flight,
                        "at most what ideal edges hold; cut ones let some of it out at every reflection");
        must_warn(result, name, found.warnings, "trapped by total reflection");
      }
    }
  };
  return c;
}

Case trapped_milk_case() {
  Case c{.number = 0,
         .name = "hard-white-cube",
         .title = "The same cube scattering, albedo 1: total reflection at every face, but all light gets out",
         .equation = "escaped + reflected = entered",
         .source = "nothing absorbs",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    HardScene scene{empty_domain(glm::ivec3(24), 1), {point_light({12.3f, 11.8f, 12.1f})}};
    add_body(scene.medium, make_box(glm::vec3(18), at(glm::vec3(12))),
             make_material({.sigma_s = glm::vec3(1), .eta = 2.5f}));
    const HardRun found = run_both(context, result, "white cube", scene);
    const double in_flight = found.run.energy().in_flight.x / entered(found.run);
    result.relative("escaped + in flight, white cube", 1, escaped_share(found.run) + in_flight, 1e-5,
                    "nothing absorbs");
    result.at_most("in flight, white cube", 1e-3, in_flight, "16 bounces through a medium of 18 mean free paths");
  };
  return c;
}

}  // namespace

std::vector<Case> hard_index_cases() {
  return {jump_case(), trapped_case(), trapped_milk_case()};
}

}  // namespace turbid::study
