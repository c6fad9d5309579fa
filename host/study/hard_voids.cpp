// SPDX-License-Identifier: Apache-2.0
// Hard cases: media in which next to nothing scatters in places, or nowhere.
#include <algorithm>
#include <cmath>
#include <random>

#include "host/study/case_lists.h"
#include "host/study/hard_runs.h"

namespace turbid::study {
namespace {

const glm::vec3 kWhite(1);

Case duct_case() {
  Case c{.number = 0,
         .name = "hard-duct",
         .title = "An empty duct 24 voxels long and 6 wide inside a medium of albedo .999, a lamp before one end",
         .equation = "fluence on the axis / Monte Carlo",
         .source = "numerics section 4: 1.01 to 1.14 with s floored in D only",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    HardScene scene{empty_domain(glm::ivec3(32), 1), {point_light({16, 16, 2})}};
    set_ambient(scene.medium, make_material({.sigma_s = 0.999f * kWhite, .sigma_a = 0.001f * kWhite}));
    Placement along_z = at(glm::vec3(16));
    along_z.rotation = glm::mat3(glm::vec3(1, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0, -1, 0));
    add_body(scene.medium, make_cylinder(3, 24, along_z), make_material({}));
    const HardRun found = run_both(context, result, "duct", scene);
    const HardRun exact = run_hard(context, result, "duct", scene, hard_settings("photon", 60000));
    for (const int end : {6, 12, 18, 24}) {
      double ours = 0, theirs = 0;
      for (int x = 15; x <= 16; ++x)
        for (int y = 15; y <= 16; ++y)
          for (int z = end - 2; z < end + 2; ++z) {
            ours += found.run.fluence({x, y, z});
            theirs += exact.run.fluence({x, y, z});
          }
      result.within("fluence on the axis / photons, z = " + std::to_string(end), end > 6 ? 0.95 : 0.75, 1.14,
                    ours / theirs,
                    end > 6 ? "numerics section 4: 1.01 to 1.14; photons within 3 %"
                            : "within two mean free paths of the lamp, where diffusion is not valid");
    }
  };
  return c;
}

Case scattered_case() {
  Case c{.number = 0,
         .name = "hard-voids",
         .title = "Voids scattered through a medium, as bodies and as voxels of s = 1e-4",
         .equation = "R and T of photons",
         .source = "Monte Carlo; numerics section 4: without the floor of s such voids break the solve",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const bool bodies : {true, false}) {
      Material milk = make_material({.sigma_s = 0.495f * kWhite, .sigma_a = 0.005f * kWhite});
      if (!bodies) {
        milk.sigma_s = expression_field("noise(0.4*x, 0.4*y, 0.4*z) > 0.1 ? 0.0001 : 0.5");
        milk.sigma_a = expression_field("noise(0.4*x, 0.4*y, 0.4*z) > 0.1 ? 0 : 0.005");
      }
      HardScene scene{empty_domain({24, 24, 24}, 1), {sunlight({0, 0, 1})}};
      set_ambient(scene.medium, milk);
      std::mt19937 random(3);
      std::uniform_real_distribution<float> place(3, 21);
      for (int i = 0; bodies && i < 12; ++i)
        add_body(scene.medium, make_sphere(2.5f, at({place(random), place(random), place(random)})), make_material({}));
      const std::string name = bodies ? "as bodies" : "as voxels";
      const HardRun found = run_both(context, result, name, scene);
      const HardRun exact = run_hard(context, result, name, scene, hard_settings("photon"));
      for (const int face : {4, 5})
        result.absolute(std::string(face == 4 ? "R" : "T") + ", steady against photons, " + name,
                        face_share(exact.run, face), face_share(found.run, face), 0.06,
                        "diffusion through voids, share of the light", "1", face_error(exact.run, face));
      result.at_most("iterations, " + name, 14, found.run.solution.report.iterations, "numerics section 5: up to 10");
    }
  };
  return c;
}

Case nothing_case() {
  Case c{.number = 0,
         .name = "hard-nothing",
         .title = "Nothing but voids: an empty domain, an empty body, clear glass",
         .equation = "all light misses or escapes; there is no fluence",
         .source = "nothing absorbs, nothing scatters",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const std::string name : {"no medium", "empty body", "clear glass"}) {
      HardScene scene{empty_domain(glm::ivec3(16), 1), {sunlight({0.3f, 0.2f, 1}), point_light({8, 8, 8})}};
      if (name != "no medium")
        add_body(scene.medium, make_sphere(5, at(glm::vec3(8))),
                 make_material({.eta = name == "clear glass" ? 1.5f : 1.0f}));
      for (const char* solver : {"steady", "lattice", "photon"}) {
        const HardRun found = run_hard(context, result, name, scene, hard_settings(solver, 2000));
        const EnergyBalance& e = found.run.energy();
        const auto& fluence = found.run.solution.volume.fluence;
        const std::string of = ", " + name + ", " + solver;
        result.at_most("largest fluence" + of, 0,
                       fluence.empty() ? 0 : *std::max_element(fluence.begin(), fluence.end()), "nothing scatters");
        result.absolute("missed + reflected + escaped + in flight" + of, 1,
                        (e.missed.x + e.reflected.x + e.escaped.x + e.in_flight.x) / e.emitted.x, 1e-5,
                        "nothing absorbs");
        result.at_most("in flight" + of, 0.02, e.in_flight.x / e.emitted.x, "most of a ball's light leaves at once");
      }
    }
  };
  return c;
}

}  // namespace

std::vector<Case> hard_void_cases() {
  return {duct_case(), scattered_case(), nothing_case()};
}

}  // namespace turbid::study
