// SPDX-License-Identifier: Apache-2.0
// First flight and diffusion together (numerics section 8, cases 10 and 21; section 7 for the deposit).
#include <algorithm>
#include <cmath>

#include "host/study/case_lists.h"
#include "host/study/energy_media.h"
#include "host/study/photon_runs.h"

namespace turbid::study {
namespace {

/// Mean fluence over shells of [2,3], [4,5], [6,7] mean free paths about a unit point source, albedo .9, in an eighth
/// of space by mirrors.
std::array<double, 3> point_shells(CaseContext& context, double& imbalance) {
  MediumDescription scene = empty_domain(glm::ivec3(64), 0.25f);
  scene.faces = {FaceBoundary::mirror, FaceBoundary::open,   FaceBoundary::mirror,
                 FaceBoundary::open,   FaceBoundary::mirror, FaceBoundary::open};
  set_ambient(scene, make_material({.sigma_s = glm::vec3(0.9f), .sigma_a = glm::vec3(0.1f)}));
  const Run found = run(context.session, scene, {point_light(glm::vec3(0.01f), glm::vec3(0.125f))});
  imbalance = found.energy().imbalance();
  std::array<double, 3> sum{}, count{};
  for (int i = 0; i < 32 * 32 * 32; ++i) {
    const glm::ivec3 voxel(i % 32, i / 32 % 32, i / 1024);
    const double r = 0.25 * glm::length(glm::dvec3(voxel) + 0.5);
    const int shell = r >= 2 && r < 3 ? 0 : r >= 4 && r < 5 ? 1 : r >= 6 && r < 7 ? 2 : -1;
    if (shell < 0) continue;
    sum[shell] += found.fluence(voxel) + found.deposit(voxel) / 0.9;  // diffuse plus unscattered
    count[shell] += 1;
  }
  for (int shell = 0; shell < 3; ++shell) sum[shell] /= count[shell];
  return sum;
}

Case point_case() {
  Case c{
      .number = 10,
      .name = "point",
      .title = "Unit point source in an infinite medium, albedo .9: means over shells in mean free paths",
      .equation = "transport: 2.196e-2, 4.212e-3, 1.0195e-3 over [2,3], [4,5], [6,7]",
      .source = "exact transport (numerics section 8); first flight marched, remainder diffused: D = 1 / (3 sigma_tr)"};
  c.check = [](CaseContext& context, CaseResult& result) {
    double imbalance = 0;
    const std::array<double, 3> found = point_shells(context, imbalance);
    const double expected[3] = {2.196e-2, 4.212e-3, 1.0195e-3};
    for (int shell = 0; shell < 3; ++shell)
      result.relative(
          "fluence at " + std::to_string(2 * shell + 2) + " to " + std::to_string(2 * shell + 3) + " mfp, steady",
          expected[shell], found[shell], 0.1, "what diffusion reaches at albedo .9 (numerics section 2)", "1/mfp^2");
    result.note_imbalance(imbalance);
  };
  return c;
}

Case account_case() {
  Case c{.number = 21,
         .name = "account",
         .title = "Every watt of the first flight is deposited, absorbed, reflected or lets itself be counted outside",
         .equation = "deposited + absorbed + reflected + opaque + in flight + escaped - emitted = 0",
         .source = "P_old - P_new telescopes along every ray; photons' weights telescope in integers"};
  c.check = [](CaseContext& context, CaseResult& result) {
    double worst = 0;
    for (const EnergyMedium& medium : energy_media()) {
      if (medium.lights.empty()) continue;
      const Marched marched = march(context.session, medium.scene, medium.lights);
      const MarchTallies& t = marched.tallies;
      glm::dvec3 found = t.deposited + t.absorbed + t.reflected + t.opaque + t.in_flight;
      for (const glm::dvec3& face : t.escaped) found += face;
      for (int colour = 0; colour < 3; ++colour)
        if (marched.carried[colour] > 0) worst = std::max(worst, std::abs(found[colour] / marched.carried[colour] - 1));
    }
    result.absolute("worst of 13 media, march", 0, worst, 1e-5, "single precision per step; numerics: 1e-5");
    MediumDescription scene = empty_domain(glm::ivec3(16), 1.0f, FaceBoundary::open, true);
    add_body(scene, make_sphere(6, {}),
             make_material({.sigma_s = {0.3f, 0.5f, 0.2f}, .sigma_a = {0.1f, 0.05f, 0.2f}, .eta = 1.4f, .g = 0.5f}));
    const PhotonAnswer answer =
        follow(context.session, scene, photons(30000), LightList{sunlight({1, -0.5f, 0.3f}, {1, 0.8f, 0.6f})});
    result.absolute("photons, scattering included", 0, answer.solution.report.energy.imbalance(), 1e-12,
                    "integers; nothing but their conversion to watts is rounded");
  };
  return c;
}

Case balance_case() {
  Case c{.number = 0,
         .name = "balance",
         .title = "The energy balance of complete runs in 14 kinds of media, both solvers",
         .equation = "emitted = missed + reflected + absorbed + escaped + in flight, per colour",
         .source = "what every run prints"};
  c.check = [](CaseContext& context, CaseResult& result) {
    for (const char* solver : {"steady", "lattice"})
      for (const EnergyMedium& medium : energy_media()) {
        SolverSettings settings;
        settings.solver = solver;
        const EnergyBalance e = run(context.session, medium.scene, medium.lights, settings).energy();
        double in_flight = 0;
        for (int colour = 0; colour < 3; ++colour)
          if (e.emitted[colour] > 0) in_flight = std::max(in_flight, std::abs(e.in_flight[colour]) / e.emitted[colour]);
        result.at_most(medium.name + ", " + solver, 1e-5, e.imbalance(),
                       "single precision and a solve's residual of 1e-6");
        result.at_most("in flight, " + medium.name + ", " + solver, 0.02, in_flight,
                       "paths cut by max_bounces and min_power");
      }
  };
  return c;
}

/// Root mean square error of the fluence before the first scattering, sunlight across a cube of one absorbing and
/// scattering medium, against exp(-sigma l), l the distance back to where light enters; three voxels of rim left out.
double deposit_error(CaseContext& context, double rays_per_face) {
  const int n = 40;
  const double sigma = 0.05, albedo = 0.8;
  const glm::dvec3 d = glm::normalize(glm::dvec3(0.6, 0.48, 0.64));
  MediumDescription scene = empty_domain(glm::ivec3(n), 1.0f);
  set_ambient(scene, make_material({.sigma_s = glm::vec3(static_cast<float>(sigma * albedo)),
                                    .sigma_a = glm::vec3(static_cast<float>(sigma * (1 - albedo)))}));
  SolverSettings settings;
  settings.march.rays_per_face = static_cast<float>(rays_per_face);
  settings.steady.tolerance = 0.1f;  // only the deposit is looked at
  const Run found = run(context.session, scene, {sunlight(d)}, settings);
  double sum = 0, square = 0, count = 0;
  for (int i = 0; i < n * n * n; ++i) {
    const glm::ivec3 voxel(i % n, i / n % n, i / (n * n));
    if (glm::any(glm::lessThan(voxel, glm::ivec3(3))) || glm::any(glm::greaterThanEqual(voxel, glm::ivec3(n - 3))))
      continue;
    double expected = 0;  // mean over the voxel
    for (int part = 0; part < 64; ++part) {
      const glm::dvec3 x = glm::dvec3(voxel) + (glm::dvec3(part & 3, part >> 2 & 3, part >> 4) + 0.5) / 4.0;
      expected += std::exp(-sigma * std::min({x.x / d.x, x.y / d.y, x.z / d.z})) / 64;
    }
    const double error = found.deposit(voxel) / (sigma * albedo) / expected - 1;
    sum += error;
    square += error * error;
    count += 1;
  }
  return std::sqrt(square / count - sum * sum / (count * count));
}

Case deposit_case() {
  Case c{.number = 0,
         .name = "deposit",
         .title = "The light rays' deposit in a cube over rays per voxel face",
         .equation = "fluence = exp(-sigma l)",
         .source = "numerics section 7: trilinear, step .5: rms .034, .008, .008, .005 at 1, 2, 4, 16 rays per face"};
  Refinement r;
  r.parameter = "rays";
  r.unit = "per face";
  r.levels = {1, 2, 4, 16};
  r.error_names = {"", "rms error of the unscattered fluence", ""};
  const std::string why = "numerics section 7, and the regular grid meets the voxels in another phase";
  r.limits = {{1, 0.06, why}, {2, 0.016, why}, {4, 0.012, why}, {16, 0.008, why}};
  r.run = [](CaseContext& context, double rays) {
    RefinedLevel level{.h = 1 / std::sqrt(rays)};
    level.l2 = deposit_error(context, rays);
    return level;
  };
  c.refinements = {r};
  return c;
}

}  // namespace

std::vector<Case> transport_cases() {
  return {point_case(), account_case(), balance_case(), deposit_case()};
}

}  // namespace turbid::study
