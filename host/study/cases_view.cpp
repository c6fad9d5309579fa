// SPDX-License-Identifier: Apache-2.0
// What a camera gathers (numerics section 8, case 20).
#include <cmath>
#include <numbers>

#include "host/study/case_lists.h"
#include "host/study/small_media.h"

namespace turbid::study {
namespace {

constexpr double kPi = std::numbers::pi;

/// Power that a camera sees leave a glowing ball of radius 1 over the power that is emitted in it.
/// Index and emission fall to 1 and 0 with (1 - (r/R)^2)^2, inside the body, whose surface at 1.1 R lies where nothing
/// happens: no edge anywhere, so nothing but the gather errs. eta r grows with r, so no light is trapped, and by
/// symmetry all directions receive alike: power = 4 pi D^2 x irradiance.
double counted_power(CaseContext& context, int voxels) {
  const double radius = 1, distance = 6;
  MediumDescription scene =
      empty_domain(glm::ivec3(voxels), static_cast<float>(2.4 / voxels), FaceBoundary::open, true);
  Material glow = make_material({});
  glow.eta = expression_field("1 + 0.3*clamp(1 - r*r, 0, 1)^2");
  glow.emission = expression_field("clamp(1 - r*r, 0, 1)^2");
  add_body(scene, make_sphere(static_cast<float>(1.1 * radius), {}), glow);
  const Run lit = run(context.session, scene, {});
  Camera camera;
  camera.position = {0, 0, static_cast<float>(distance)};
  camera.target = {0, 0, 0};
  camera.fov = 24;
  camera.width = camera.height = 192;
  camera.samples = 1;
  ViewSettings settings;
  settings.min_weight = 0;
  const ViewImage image = look_at(context.session, lit, {}, camera, settings);
  const double t = std::tan(glm::radians(12.0)), pixel = 2 * t / camera.width;
  double irradiance = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const double u = t * (2 * (x + 0.5) / camera.width - 1), v = t * (2 * (y + 0.5) / camera.height - 1);
      const double cosine = 1 / std::sqrt(1 + u * u + v * v);
      irradiance += image.colour[y * camera.width + x].x * pixel * pixel * std::pow(cosine, 4);
    }
  const double emitted = 4 * kPi * std::pow(radius, 3) * 8 / 105;  // integral of (1 - r^2)^2
  return 4 * kPi * distance * distance * irradiance / emitted;
}

Case gather_case() {
  Case c{.number = 20,
         .name = "gather",
         .title = "Radiance over eta^2 along bent view paths counts the power that a graded ball emits",
         .equation = "L_obs = eta_obs^2 int j / eta^2 ds, and 4 pi D^2 E = int emission dV",
         .source = "conservation of radiance / eta^2; the emission's integral is 32 pi / 105"};
  Refinement r;
  r.parameter = "voxel_size";
  r.unit = "R";
  r.levels = {2.4 / 24, 2.4 / 48, 2.4 / 96};
  r.order = 2;
  r.order_low = 1.8;
  r.order_high = 4.2;  // the force is of fourth order; what is left of second order is small
  r.error_names = {"relative error of the power", "", ""};
  r.judged = Refinement::Norm::l1;
  r.quantity = "power seen / emitted";
  r.exact = 1;
  r.limits = {{2.4 / 48, 1e-4, "numerics, case 20"}, {2.4 / 96, 1e-4, "numerics, case 20"}};
  r.run = [](CaseContext& context, double voxel) {
    RefinedLevel level;
    const int n = 8 * std::max(1, static_cast<int>(std::lround(2.4 / voxel / 8)));
    level.h = 2.4 / n;
    level.value = counted_power(context, n);
    level.l1 = std::abs(level.value - 1);
    return level;
  };
  c.refinements = {r};
  return c;
}

}  // namespace

std::vector<Case> view_cases() {
  return {gather_case()};
}

}  // namespace turbid::study
