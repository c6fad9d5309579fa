// SPDX-License-Identifier: Apache-2.0
// Hard cases: rays that run exactly along faces, edges and diagonals of voxels, that graze a surface, that turn round.
#include <cmath>
#include <numbers>

#include "host/study/case_lists.h"
#include "host/study/hard_runs.h"
#include "host/study/ray_paths.h"

namespace turbid::study {
namespace {

Case aligned_case() {
  Case c{
      .number = 0,
      .name = "hard-aligned",
      .title =
          "Light exactly along the faces, edges and diagonals of voxels, through an absorbing cube; a lamp on a corner",
      .equation = "T = e^-a; (1 - e^-a) / a, a = sqrt(2) sigma L; 2 / a - 2 (1 - e^-a) / a^2, a = sqrt(3) sigma L",
      .source = "Beer and Lambert over the chords of a cube along (1,0,0), (1,1,0), (1,1,1)",
      .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    const double depth = 1.6;
    struct Row {
      glm::vec3 direction;
      double expected;
    };
    const auto edge = [&] {
      const double a = std::sqrt(2.0) * depth;
      return (1 - std::exp(-a)) / a;
    };
    const auto corner = [&] {
      const double a = std::sqrt(3.0) * depth;
      return 2 / a - 2 * (1 - std::exp(-a)) / (a * a);
    };
    for (const Row& row : {Row{{1, 0, 0}, std::exp(-depth)}, Row{{0, -1, 0}, std::exp(-depth)}, Row{{1, 0, 1}, edge()},
                           Row{{0, -1, 1}, edge()}, Row{{1, 1, 1}, corner()}, Row{{-1, 1, -1}, corner()}}) {
      const std::string name = "along (" + short_number(row.direction.x) + ", " + short_number(row.direction.y) + ", " +
                               short_number(row.direction.z) + ")";
      HardScene scene{empty_domain(glm::ivec3(16), 1), {sunlight(row.direction)}};
      set_ambient(scene.medium, make_material({.sigma_a = glm::vec3(static_cast<float>(depth / 16))}));
      const HardRun found = run_hard(context, result, name, scene, hard_settings("steady"));
      const bool straight = row.direction.x * row.direction.z == 0 && row.direction.y * row.direction.z == 0;
      const double bound = straight ? 1e-5 : 2e-3;
      const std::string why =
          straight ? "all chords are equal; single precision"
                   : "midpoint rule over 32 rays along edges where T falls by a factor of 10: 1 / 24 (2.8 / 32)^2 "
                     "of it, and as much again for the rim";
      result.relative("T, steady, " + name, row.expected, escaped_share(found.run), bound, why);
      const HardRun photons = run_hard(context, result, name, scene, hard_settings("photon", 20000));
      result.relative("T, photon, " + name, row.expected, escaped_share(photons.run), bound,
                      "photons start on the same rays", "1",
                      photons.run.solution.report.photon->escaped.error.x / entered(photons.run));
      scene.medium.materials[0] = make_material({.sigma_s = glm::vec3(0.3f), .sigma_a = glm::vec3(0.01f), .eta = 1.5f});
      run_both(context, result, name + ", glass", scene);
    }
    // A lamp on the corner that eight voxels share.
    HardScene scene{empty_domain(glm::ivec3(16), 1), {point_light(glm::vec3(8))}};
    set_ambient(scene.medium, make_material({.sigma_s = glm::vec3(0.5f), .sigma_a = glm::vec3(0.01f)}));
    const HardRun found = run_both(context, result, "lamp on a corner", scene);
    for (int octant = 0; octant < 8; ++octant) {
      double share = 0, total = 0;
      for (int i = 0; i < 16 * 16 * 16; ++i) {
        const glm::ivec3 v(i % 16, i / 16 % 16, i / 256);
        const double value = found.run.fluence(v);
        total += value;
        if ((v.x > 7) + 2 * (v.y > 7) + 4 * (v.z > 7) == octant) share += value;
      }
      result.relative("share of octant " + std::to_string(octant), 0.125, share / total, 0.01,
                      "the lamp's rays lie on a grid that is not symmetric");
    }
  };
  return c;
}

/// Fresnel reflectance of index 1.5, unpolarised.
double reflectance(double angle) {
  const double c1 = std::cos(angle), c2 = std::sqrt(1 - std::pow(std::sin(angle) / 1.5, 2));
  const double s = (c1 - 1.5 * c2) / (c1 + 1.5 * c2), p = (c2 - 1.5 * c1) / (c2 + 1.5 * c1);
  return 0.5 * (s * s + p * p);
}

Case grazing_case() {
  Case c{
      .number = 0,
      .name = "hard-grazing",
      .title = "Light at 60, 80, 89 and 89.9 degrees onto a flat box of glass milk",
      .equation =
          "reflected = (a cos t R(t) + b sin t R(90 - t)) / (a cos t + b sin t), a and b the top's and a side's areas",
      .source = "Fresnel, index 1.5",
      .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const double degrees : {60.0, 80.0, 89.0, 89.9}) {
      const double angle = degrees * std::numbers::pi / 180;
      HardScene scene{empty_domain({32, 16, 16}, 1), {sunlight({std::sin(angle), -std::cos(angle), 0})}};
      add_body(scene.medium, make_box({28, 6, 12}, at({16, 8, 8})),
               make_material({.sigma_s = glm::vec3(0.5f), .sigma_a = glm::vec3(0.01f), .eta = 1.5f}));
      const std::string name = short_number(degrees) + " degrees";
      const HardRun found = run_both(context, result, name, scene);
      const double top = 28 * std::cos(angle), side = 6 * std::sin(angle);
      result.absolute("reflected at entry, " + name,
                      (top * reflectance(angle) + side * reflectance(std::numbers::pi / 2 - angle)) / (top + side),
                      found.run.energy().reflected.x / entered(found.run), 0.05,
                      "a row of rays more or less; edges are rounded over a voxel");
    }
  };
  return c;
}

Case turning_case() {
  Case c{.number = 0,
         .name = "hard-turning",
         .title = "An index that falls linearly turns a ray round",
         .equation = "eta(z) = C cosh(g (x - x_t) / C), C = eta cos(angle) all along, x_t where the ray is level",
         .source = "Fermat: the catenary of eta = 2 - g z",
         .hard = true};
  c.check = [](CaseContext& context, CaseResult& result) {
    const double g = 0.02, angle = std::numbers::pi / 6, x0 = 3, z0 = 2, eta0 = 2 - g * z0;
    const DeviceMedium medium =
        graded_domain(context.session, {104, 8, 24}, [g](glm::dvec3 x) { return std::pow(2 - g * x.z, 2); });
    const double level = eta0 * std::cos(angle), turn = x0 + std::acosh(eta0 / level) * level / g;
    PathRay start;
    start.x = glm::vec3(x0, 4, z0);
    start.v = static_cast<float>(eta0) * glm::vec3(std::cos(angle), 0, std::sin(angle));
    for (const int steps : {50, 100, 150, 200}) {
      const PathRay end = trace(context.session, medium, {start}, 0.5f, steps)[0];
      const double z = (2 - level * std::cosh(g * (end.x.x - turn) / level)) / g;
      result.absolute("height after " + std::to_string(steps) + " steps", z, end.x.z, 2e-3, "KDK in single precision",
                      "voxels");
    }
    HardScene scene{empty_domain({48, 16, 16}, 1), {sunlight({1, 0, 0.35f})}};
    Material graded = make_material({.sigma_s = glm::vec3(0.02f), .sigma_a = glm::vec3(0.001f)});
    graded.eta = linear_index(glm::vec3(24, 8, 8), 1.3f, {0, 0, -0.015f});
    set_ambient(scene.medium, graded);
    const HardRun found = run_both(context, result, "sun on a graded slab", scene);
    result.at_least("leaves downwards / upwards", 0.2, face_share(found.run, 4) / face_share(found.run, 5),
                    "part of the light turns round before it reaches the top");
    run_hard(context, result, "sun on a graded slab", scene, hard_settings("photon", 5000));
  };
  return c;
}

}  // namespace

std::vector<Case> hard_ray_cases() {
  return {aligned_case(), grazing_case(), turning_case()};
}

}  // namespace turbid::study
