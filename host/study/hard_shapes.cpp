// SPDX-License-Identifier: Apache-2.0
// Hard cases: bodies thinner than a voxel, a single voxel, very many bodies, very unequal lights.
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/hard_runs.h"

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
         .source = "Beer and Lambert",
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
      // Between two centres and around one.
      for (const float z : {8.0f, 8.5f}) {
        const std::string place = name + (z == 8.0f ? " between centres" : " around a centre");
        const HardRun dark = run_hard(context, result, place + ", dark", with(milk(0, 0.7f / thickness), z), hard_settings("steady"));
        result.relative("T, " + place, std::exp(-0.7), face_share(dark.run, 5), 0.02, "surfaces to a few hundredths of a voxel");
        const HardRun white = run_both(context, result, place + ", white", with(milk(0.5f / thickness, 0), z));
        result.relative("R + T + in flight, white, " + place, 1,
                        escaped_share(white.run) + white.run.energy().in_flight.x / entered(white.run), 1e-5, "nothing absorbs");
        must_warn(result, place, white, "voxels thick");
        run_both(context, result, place + ", glass", with(milk(0.5f / thickness, 0.01f, 1.5f), z));
      }
    }
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
      result.absolute("active voxels" + absorbs, 1, static_cast<double>(found.run.solution.report.active_voxels), 0, "one was asked for");
      must_warn(result, "one voxel" + absorbs, found, "voxels thick");
      if (sigma_a == 0) result.at_most("absorbed, one voxel" + absorbs, 0, found.run.energy().absorbed.x, "nothing absorbs");
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
         .title = "A lamp of 1 MW of red light beside one of 1 uW of blue",
         .equation = "the blue fluence is what the blue lamp makes alone",
         .source = "linearity",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    const auto with = [](const LightList& lights) {
      HardScene scene{empty_domain(glm::ivec3(16), 1), lights};
      set_ambient(scene.medium, milk(0.4f, 0.02f));
      return scene;
    };
    const Light red = point_light({5, 5, 5}, {1e6f, 0, 0}), blue = point_light({11, 11, 11}, {0, 0, 1e-6f});
    const HardRun both = run_both(context, result, "both lamps", with({red, blue}));
    const HardRun alone = run_hard(context, result, "blue alone", with({blue}), hard_settings("steady"));
    const auto sum = [](const Run& r, glm::ivec3 at) { return static_cast<double>(r.fluence(at, 2)); };
    for (const int i : {2, 8, 11, 14})
      result.relative("blue fluence beside red, voxel " + std::to_string(i), sum(alone.run, glm::ivec3(i)),
                      sum(both.run, glm::ivec3(i)), 2e-3, "fixed point of 2^-60 of the brightest; two solves to 1e-4");
    const HardRun grey = run_both(context, result, "1 MW and 1 uW, white",
                                  with({point_light({5, 5, 5}, glm::vec3(1e6f)), point_light({11, 11, 11}, glm::vec3(1e-6f))}));
    const HardRun strong = run_hard(context, result, "1 MW, white", with({point_light({5, 5, 5}, glm::vec3(1e6f))}), hard_settings("steady"));
    result.relative("white fluence at the weak lamp", strong.run.fluence(glm::ivec3(11)), grey.run.fluence(glm::ivec3(11)), 1e-4,
                    "1e-12 of the light changes nothing");
  };
  return c;
}

Case shells_case() {
  Case c{.number = 0,
         .name = "hard-shells",
         .title = "256 nested shells",
         .equation = "of one material: the light of a single ball; of two: the mean of either",
         .source = "a boundary between equal media is none",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    const auto shells = [](int count, float eta_step, float contrast) {
      HardScene scene{empty_domain(glm::ivec3(32), 1), {sunlight({1, 0.2f, 0.1f})}};
      for (int i = 0; i < count; ++i) {
        const bool odd = i % 2 != 0;
        const float radius = 14.0f * (1.0f - static_cast<float>(i) / static_cast<float>(count + 1));
        add_body(scene.medium, make_sphere(radius, at(glm::vec3(16))),
                 milk(odd ? 0.3f * contrast : 0.3f / contrast, 0.005f, odd ? 1.3f + eta_step : 1.3f));
      }
      return scene;
    };
    const HardRun single = run_hard(context, result, "one ball", shells(1, 0, 1), hard_settings("steady"));
    const HardRun equal = run_both(context, result, "256 equal shells", shells(256, 0, 1));
    const auto absorbed = [](const Run& r) { return r.energy().absorbed.x / entered(r); };
    result.relative("absorbed share, 256 equal shells", absorbed(single.run), absorbed(equal.run), 0.01,
                    "a ray moves on by a little at each surface that it meets");
    const HardRun mixed = run_both(context, result, "256 shells of two media", shells(256, 0.05f, 2));
    result.notes.push_back("in flight after 16 surfaces: " + short_number(mixed.run.energy().in_flight.x / entered(mixed.run)) +
                           " of the light that entered");
  };
  return c;
}

}  // namespace

std::vector<Case> hard_shape_cases() {
  return {sheets_case(), voxel_case(), lights_case(), shells_case()};
}

}  // namespace turbid::study
