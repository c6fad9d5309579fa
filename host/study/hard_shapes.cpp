// SPDX-License-Identifier: Apache-2.0
// Hard cases: bodies thinner than a voxel, a single voxel, very many bodies, very unequal lights.
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/hard_runs.h"
#include "host/study/run_warnings.h"

namespace turbid::study {
namespace {

Material milk(float sigma_s, float sigma_a, float eta = 1) {
  return make_material({.sigma_s = glm::vec3(sigma_s), .sigma_a = glm::vec3(sigma_a), .eta = eta});
}

Case sheets_case() {
  Case c{.number = 0,
         .name = "hard-sheets",
         .title = "Sheets 1, 0.5 and 0.1 voxels thin, absorbing and scattering, matched and of index 1.5",
         .equation = "T = exp(-sigma_a d) for sheets that only absorb",
         .source = "Beer and Lambert; sheets between the voxels' centres cannot be sampled",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const float thickness : {1.0f, 0.5f, 0.1f}) {
      HardScene scene{empty_domain({8, 8, 16}, 1), {sunlight({0, 0, 1})}};
      for (int face = 0; face < 4; ++face) scene.medium.faces[static_cast<std::size_t>(face)] = FaceBoundary::periodic;
      const std::string name = short_number(thickness) + " voxels";
      const auto with = [&](const Material& material, float z) {
        HardScene one = scene;
        add_body(one.medium, make_box({40, 40, thickness}, at({4, 4, z})), material);
        return one;
      };
      // Between two centres and around one. Distances are sampled at the centres: a sheet that holds some is as thick
      // as it is, one that holds none is in none of the samples and lets everything pass.
      for (const float z : {8.0f, 8.5f}) {
        const std::string place = name + (z == 8.0f ? " between centres" : " around a centre");
        const HardRun dark =
            run_hard(context, result, place + ", dark", with(milk(0, 0.7f / thickness), z), hard_settings("steady"));
        const bool sampled = z == 8.5f || thickness >= 1;
        if (sampled)
          result.relative("T, " + place, std::exp(-0.7), face_share(dark.run, 5), thickness < 0.5f ? 0.02 : 1e-3,
                          "Beer and Lambert; either face is met within 1e-3 voxels");
        else
          result.relative("T, " + place, 1, face_share(dark.run, 5), 1e-3, "not there, as a warning says");
        must_warn(result, place, dark.warnings, "voxels thick");
        const HardRun white = run_both(context, result, place + ", white", with(milk(0.5f / thickness, 0), z));
        const EnergyBalance& e = white.run.energy();
        if (e.absorbed.x > 0) must_warn(result, place, white.warnings, "no voxel's centre");
        result.relative("escaped + absorbed + in flight, white, " + place, 1,
                        (e.escaped.x + e.absorbed.x + e.in_flight.x) / entered(white.run), 1e-5,
                        "nothing else happens");
        run_both(context, result, place + ", glass", with(milk(0.5f / thickness, 0.01f, 1.5f), z));
      }
    }
    HardScene thick{empty_domain({8, 8, 16}, 1), {sunlight({0, 0, 1})}};
    for (std::size_t face = 0; face < 4; ++face) thick.medium.faces[face] = FaceBoundary::periodic;
    add_body(thick.medium, make_box({40, 40, 2}, at({4, 4, 8})), milk(0, 0.35f));
    const HardRun dark = run_hard(context, result, "2 voxels, dark", thick, hard_settings("steady"));
    result.relative("T, 2 voxels", std::exp(-0.7), face_share(dark.run, 5), 1e-3, "Beer and Lambert");
  };
  return c;
}

Case voxel_case() {
  Case c{.number = 0,
         .name = "hard-one-voxel",
         .title = "A domain with a single active voxel, and with one of 8 x 8 x 8 voxels all active",
         .equation = "escaped + absorbed + missed = emitted; albedo 1: absorbed 0",
         .source = "conservation",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const float sigma_a : {0.1f, 0.0f}) {
      const std::string absorbs = sigma_a > 0 ? ", absorbing" : ", white";
      HardScene one{empty_domain(glm::ivec3(8), 1), {sunlight({0.2f, 0.1f, 1}), point_light({4.5f, 4.5f, 4.5f})}};
      add_body(one.medium, make_box(glm::vec3(1), at(glm::vec3(4.5f))), milk(0.8f, sigma_a));
      const HardRun found = run_both(context, result, "one voxel" + absorbs, one);
      result.absolute("active voxels" + absorbs, 1, static_cast<double>(found.run.solution.report.active_voxels), 0,
                      "one was asked for");
      must_warn(result, "one voxel" + absorbs, found.warnings, "voxels thick");
      if (sigma_a == 0)
        result.at_most("absorbed, one voxel" + absorbs, 0, found.run.energy().absorbed.x, "nothing absorbs");
      run_hard(context, result, "one voxel" + absorbs, one, hard_settings("photon", 2000));
      HardScene block{empty_domain(glm::ivec3(8), 0.125f), {sunlight({0, 0, 1})}};
      set_ambient(block.medium, milk(0.8f, sigma_a, 1.4f));
      run_both(context, result, "one block" + absorbs, block);
    }
  };
  return c;
}

Case lights_case() {
  Case c{.number = 0,
         .name = "hard-lights",
         .title = "Two lamps of 1 MW and 1 uW, of one colour and of two",
         .equation = "fluence of both = sum of either",
         .source = "linearity",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    const auto with = [](const LightList& lights) {
      HardScene scene{empty_domain(glm::ivec3(16), 1), lights};
      set_ambient(scene.medium, milk(0.4f, 0.02f));
      return scene;
    };
    const auto colours = [](float red, float blue) {
      return LightList{point_light({5, 5, 5}, {red, 0, 0}), point_light({11, 11, 11}, {0, 0, blue})};
    };
    const HardRun both = run_both(context, result, "1 kW red and 1 mW blue", with(colours(1e3f, 1e-3f)));
    const HardRun alone = run_hard(context, result, "1 mW blue", with(colours(0, 1e-3f)), hard_settings("steady"));
    for (const int i : {2, 8, 11, 14})
      result.relative("blue fluence beside red, voxel " + std::to_string(i), alone.run.fluence(glm::ivec3(i), 2),
                      both.run.fluence(glm::ivec3(i), 2), 2e-3,
                      "fixed point of 2^-60 of the brightest; two solves to 1e-4");
    const auto white = [](float strong, float weak) {
      return LightList{point_light({5, 5, 5}, glm::vec3(strong)), point_light({11, 11, 11}, glm::vec3(weak))};
    };
    const HardRun grey = run_both(context, result, "1 MW and 1 uW, white", with(white(1e6f, 1e-6f)));
    const HardRun strong = run_hard(context, result, "1 MW, white", with(white(1e6f, 0)), hard_settings("steady"));
    result.relative("white fluence at the weak lamp", strong.run.fluence(glm::ivec3(11)),
                    grey.run.fluence(glm::ivec3(11)), 1e-4, "1e-12 of the light changes nothing");
    // Colours share one fixed point: at 1e-12 of the brightest, single steps of the blue rays fall below its unit.
    const HardScene torn = with(colours(1e6f, 1e-6f));
    const Run lost = run(context.session, torn.medium, torn.lights, hard_settings("steady"));
    must_warn(result, "1 MW red and 1 uW blue", run_warnings(lost.solution.report, hard_settings("steady")),
              "far below the brightest");
  };
  return c;
}

Case shells_case() {
  Case c{.number = 0,
         .name = "hard-shells",
         .title = "256 nested shells",
         .equation = "absorbed by shells of one material <= by a single ball of it",
         .source = "a boundary between equal media is none",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    const auto shells = [](int count, float contrast) {
      HardScene scene{empty_domain(glm::ivec3(16), 1), {sunlight({1, 0.2f, 0.1f})}};
      for (int i = 0; i < count; ++i) {
        const float radius = 7.0f * (1.0f - static_cast<float>(i) / static_cast<float>(count + 1));
        add_body(scene.medium, make_sphere(radius, at(glm::vec3(8))),
                 milk(i % 2 ? 0.5f * contrast : 0.5f / contrast, 0.01f, i % 2 ? 1.25f + 0.05f * contrast : 1.3f));
      }
      return scene;
    };
    const auto absorbed = [](const Run& r) { return r.energy().absorbed.x / entered(r); };
    const HardRun single = run_hard(context, result, "one ball", shells(1, 1), hard_settings("steady"));
    const HardRun many = run_hard(context, result, "256 equal shells", shells(256, 1), hard_settings("steady"));
    result.within("absorbed share, 256 equal shells / one ball", 0.1, 1.01, absorbed(many.run) / absorbed(single.run),
                  "shells of 0.03 voxels: what is cut off after 16 surfaces is missing");
    must_warn(result, "256 equal shells", many.warnings, "still on its way");
    run_hard(context, result, "256 shells of two media", shells(256, 2), hard_settings("lattice"));
  };
  return c;
}

}  // namespace

std::vector<Case> hard_shape_cases() {
  return {sheets_case(), voxel_case(), lights_case(), shells_case()};
}

}  // namespace turbid::study
