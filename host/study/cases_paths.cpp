// SPDX-License-Identifier: Apache-2.0
// Paths of light through graded indices against exact optics (numerics section 8, cases 14 and 16).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/study/case_lists.h"
#include "host/study/ray_paths.h"

namespace turbid::study {
namespace {

constexpr double kPi = std::numbers::pi;

/// Mean, root mean square and largest of the rays' misses.
void take_norms(const std::vector<double>& misses, RefinedLevel& level) {
  level.l1 = level.l2 = level.linf = 0;
  for (const double miss : misses) {
    level.l1 += miss / static_cast<double>(misses.size());
    level.l2 += miss * miss / static_cast<double>(misses.size());
    level.linf = std::max(level.linf, miss);
  }
  level.l2 = std::sqrt(level.l2);
}

/// A ray that left the domain has no error.
double or_none(const PathRay& ray, double miss) {
  return ray.face == -1 ? miss : kNone;
}

/// Distance from the focus after a quarter period, relative to the radius R = 24 voxels; step in radii.
RefinedLevel luneburg(CaseContext& context, double step) {
  const double radius = 24;
  const glm::dvec3 centre(32, 32, 12);
  const DeviceMedium medium = graded_domain(context.session, {64, 64, 24}, [&](glm::dvec3 x) {
    return 2 - glm::dot(x - centre, x - centre) / (radius * radius);
  });
  std::vector<PathRay> rays;
  for (const double b : {-0.9, -0.6, -0.3, 0.0, 0.2, 0.5, 0.8, 0.95})
    rays.push_back({centre + radius * glm::dvec3(-std::sqrt(1 - b * b), b, 0), {1, 0, 0}});
  // In tau the path is a harmonic oscillation of frequency 1/R: all rays meet after pi R / 2.
  const int steps = std::max(1, static_cast<int>(std::lround(kPi / 2 * std::sqrt(2.0) / step)));  // arc at largest eta
  const double dtau = kPi / 2 * radius / steps;
  std::vector<double> misses;
  for (const PathRay& ray :
       trace(context.session, medium, rays, static_cast<float>(dtau / medium.region_params[0].tau_per_arc), steps))
    misses.push_back(or_none(ray, glm::length(glm::dvec3(ray.x) - (centre + glm::dvec3(radius, 0, 0))) / radius));
  RefinedLevel level{.h = kPi / 2 * std::sqrt(2.0) / steps};
  take_norms(misses, level);
  return level;
}

Case luneburg_case() {
  Case c{.number = 14,
         .name = "luneburg",
         .title = "Luneburg lens: parallel light meets in the focus",
         .equation = "dx/dtau = v, dv/dtau = grad(eta^2 / 2), eta^2 = 2 - (r/R)^2: a harmonic oscillation",
         .source = "Luneburg 1944; kick-drift-kick, numerics section 6: 3.0e-4 at .05 R, order 2"};
  Refinement r;
  r.parameter = "step";
  r.unit = "R";
  r.levels = {0.1, 0.05, 0.025, 0.0125};
  r.order = 2;
  r.order_low = 1.9;
  r.order_high = 2.1;
  r.error_names = {"mean distance from the focus / R", "rms distance from the focus / R",
                   "largest distance from the focus / R"};
  r.judged = Refinement::Norm::linf;
  r.limits = {{0.05, 4e-4, "numerics, case 14"}};
  r.run = luneburg;
  c.refinements = {r};
  return c;
}

/// Grid, step and sampling refined together: eta = 1.6 / (1 + r^2 / a^2), rays are circles. The voxel is 1 / n of the
/// domain, a = .3.
RefinedLevel fisheye(CaseContext& context, double voxel) {
  const int n = 8 * std::max(2, static_cast<int>(std::lround(1 / voxel / 8)));
  const double a = 0.3 * n, r0 = 0.15 * n;
  const glm::dvec3 centre(0.5 * n, 0.5 * n, 8);
  const auto eta_squared = [&](glm::dvec3 x) {
    return std::pow(1.6 / (1 + glm::dot(x - centre, x - centre) / (a * a)), 2);
  };
  const DeviceMedium medium = graded_domain(context.session, {n, n, 16}, eta_squared);
  const double middle = 0.5 * (r0 - a * a / r0), rho = 0.5 * (r0 + a * a / r0);
  std::vector<PathRay> rays{{centre + glm::dvec3(r0, 0, 0), {0, 0, 0}}};
  rays[0].v.y = static_cast<float>(std::sqrt(eta_squared(rays[0].x)));
  std::vector<double> misses;
  for (int part = 0; part < 8; ++part) {
    rays = trace(context.session, medium, rays, 0.5f, n / 8);
    const double found = glm::length(glm::dvec3(rays[0].x) - centre - glm::dvec3(middle, 0, 0));
    misses.push_back(or_none(rays[0], std::abs(found - rho) / a));
  }
  RefinedLevel level{.h = 1.0 / n};
  take_norms(misses, level);
  return level;
}

/// eta^2 = 1.5^2 (1 - a^2 rho^2): rays cross the axis every half period pi beta / (eta_0 a), beta = the constant v_z.
/// The step is a share of the period; the error the distance from the axis after five quarters of it.
RefinedLevel rod(CaseContext& context, double step) {
  const double eta0 = 1.5, a = 0.06, rho0 = 6;
  const int steps = std::max(1, static_cast<int>(std::lround(1.25 / step)));
  const glm::dvec3 axis(16, 16, 0);
  const DeviceMedium medium = graded_domain(context.session, {32, 32, 128}, [&](glm::dvec3 x) {
    const glm::dvec2 d = glm::dvec2(x) - glm::dvec2(axis);
    return eta0 * eta0 * (1 - a * a * glm::dot(d, d));
  });
  const double beta = eta0 * std::sqrt(1 - a * a * rho0 * rho0), tau = 2.5 * kPi / (eta0 * a);
  const PathRay out =
      trace(context.session, medium, {{glm::vec3(axis) + glm::vec3(rho0, 0, 2), {0, 0, static_cast<float>(beta)}}},
            static_cast<float>(tau / steps / medium.region_params[0].tau_per_arc), steps)[0];
  RefinedLevel level{.h = 1.25 / steps};
  level.l1 = or_none(out, std::abs(out.x.x - 16) / rho0);
  level.linf = or_none(out, std::abs(out.x.z - 2 - beta * tau));
  return level;
}

Case fisheye_case() {
  Case c{
      .number = 16,
      .name = "fisheye",
      .title = "Maxwell's fish-eye closes its circles; a gradient rod has the known period",
      .equation = "eta = eta_0 / (1 + (r/a)^2): circles; eta^2 = eta_0^2 (1 - a^2 rho^2): period 2 pi beta / (eta_0 a)",
      .source = "Maxwell 1854; harmonic oscillation in tau, beta the velocity along the axis"};
  Refinement circle;
  circle.parameter = "voxel_size";
  circle.unit = "domain";
  circle.variant = "fish-eye";
  circle.levels = {1 / 32.0, 1 / 64.0, 1 / 128.0};
  circle.order = 2;
  circle.order_low = 1.8;
  circle.order_high = 2.2;
  circle.error_names = {"mean distance from the circle / a", "rms distance from the circle / a",
                        "largest distance from the circle / a"};
  circle.judged = Refinement::Norm::linf;
  circle.run = fisheye;
  Refinement period;
  period.parameter = "step";
  period.unit = "periods";
  period.variant = "rod";
  period.levels = {1.25 / 20, 1.25 / 40, 1.25 / 80};
  period.order = 2;
  period.order_low = 1.9;
  period.order_high = 2.1;
  period.error_names = {"distance from the axis / amplitude", "", ""};
  period.judged = Refinement::Norm::l1;
  period.run = rod;
  c.refinements = {circle, period};
  c.check = [](CaseContext& context, CaseResult& result) {
    result.absolute("error of the way along the rod", 0, rod(context, 1.25 / 40).linf, 2e-3,
                    "nothing pushes along the axis; 40 roundings at 80 voxels", "voxels");
  };
  return c;
}

}  // namespace

std::vector<Case> path_cases() {
  return {luneburg_case(), fisheye_case()};
}

}  // namespace turbid::study
