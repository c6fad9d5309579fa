// SPDX-License-Identifier: Apache-2.0
// Refraction at sharp and blurred surfaces against Snell (numerics section 8, cases 15 and 17; section 6 for the ball).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/study/case_lists.h"
#include "host/study/ray_paths.h"
#include "host/study/small_media.h"

namespace turbid::study {
namespace {

constexpr double kPi = std::numbers::pi;

DeviceMedium upload(CaseContext& context, const MediumDescription& scene) {
  const MediumVolume volume = voxelise(scene);
  return upload_medium(context.session, volume, scene_features(volume, {}));
}

/// A domain whose upper half along z is glass, with a surface between two voxel layers.
MediumDescription half_glass(SurfaceKind surface) {
  MediumDescription scene = empty_domain({96, 16, 48}, 1.0f);
  scene.smoothing_voxels = 1;
  add_body(scene, make_box({200, 200, 100}, at({48, 8, 74})), make_material({.eta = 1.5f}), surface);
  return scene;
}

PathRay towards_surface(double degrees, bool from_glass) {
  const double angle = glm::radians(degrees), sign = from_glass ? -1 : 1, eta = from_glass ? 1.5 : 1;
  // Ten voxels before the surface at z = 24.
  const glm::dvec3 d(std::sin(angle), 0, sign * std::cos(angle));
  const glm::dvec3 x = glm::dvec3(2, 8, 24) - d * (10 / std::cos(angle));
  PathRay ray{x, eta * d, from_glass ? 1 : 0};
  ray.x.x = 2.0f;  // translated: the surface is flat
  return ray;
}

double angle_of(const PathRay& ray) {
  return glm::degrees(std::atan2(std::hypot(ray.v.x, ray.v.y), std::abs(ray.v.z)));
}

Case snell_case() {
  Case c{.number = 15,
         .name = "snell",
         .title = "A sharp surface refracts 30 degrees into index 1.5, back, and reflects totally",
         .equation = "eta_1 sin theta_1 = eta_2 sin theta_2: 19.4712 degrees",
         .source = "Snell; the pseudo-code of Bernabei et al., Fig. 4, would give 20.70"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const auto out =
        trace(context.session, upload(context, half_glass(SurfaceKind::sharp)),
              {towards_surface(30, false), towards_surface(19.471221, true), towards_surface(45, true)}, 0.5f, 200);
    const std::string why = "the sampled normal of a plane is exact up to rounding; numerics: .1";
    result.absolute("into glass", 19.471221, angle_of(out[0]), 1e-4, why, "deg");
    result.absolute("out of it", 30, angle_of(out[1]), 1e-4, why, "deg");
    result.absolute("45 degrees in glass, reflected", 45, angle_of(out[2]), 1e-4, why, "deg");
    result.absolute("the domain face it ends on", 5, out[2].face, 0, "back where it came from");
    result.absolute("surfaces met", 1, out[0].surfaces, 0, "counted");
  };
  return c;
}

Case blurred_case() {
  Case c{.number = 17,
         .name = "blurred",
         .title = "A surface blurred over one voxel refracts by Snell and reflects all beyond the critical angle",
         .equation = "eta_1 sin theta_1 = eta_2 sin theta_2, index 1 to 1.5, Gaussian of 1 voxel, steps of 1/2",
         .source = "the smoothing of Bernabei et al. and Ihrke et al.; numerics section 6: .096 degrees rms"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const DeviceMedium medium = upload(context, half_glass(SurfaceKind::smooth));
    std::vector<PathRay> rays;
    std::vector<double> expected;
    for (double degrees = 0; degrees <= 60; degrees += 5) {
      rays.push_back(towards_surface(degrees, false));
      expected.push_back(glm::degrees(std::asin(std::sin(glm::radians(degrees)) / 1.5)));
    }
    for (double degrees = 0; degrees <= 35; degrees += 5) {
      rays.push_back(towards_surface(degrees, true));
      expected.push_back(glm::degrees(std::asin(std::sin(glm::radians(degrees)) * 1.5)));
    }
    double sum = 0;
    int turned_back = 0;
    const auto out = trace(context.session, medium, rays, 0.5f, 80);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      turned_back += (out[i].v.z > 0) != (rays[i].v.z > 0);
      sum += std::pow(angle_of(out[i]) - expected[i], 2);
    }
    result.at_most("rms error of 21 angles", 0.15, std::sqrt(sum / static_cast<double>(rays.size())),
                   "numerics, case 17", "deg");
    result.absolute("rays turned back below the critical angle", 0, turned_back, 0, "none is");
    std::vector<PathRay> steep;
    for (double degrees = 43; degrees < 72; degrees += 3) steep.push_back(towards_surface(degrees, true));
    int through = 0;
    for (const PathRay& ray : trace(context.session, medium, steep, 0.5f, 4096)) through += ray.v.z <= 0;
    result.absolute("of 10 rays from 43 degrees on, let through", 0, through, 0, "the critical angle is 41.8 degrees");
  };
  return c;
}

/// Root mean square error of the deviation by a glass ball [degrees] for an impact parameter in radii; `voxel` in
/// radii. The ball's centre is off the grid's symmetry, the rays stand around the axis: no lucky alignment.
double ball_error(CaseContext& context, double voxel, double impact) {
  const float radius = static_cast<float>(1 / voxel);
  const int n = 8 * static_cast<int>(std::ceil(3.2 * radius / 8));
  MediumDescription scene = empty_domain(glm::ivec3(n), 1.0f);
  const glm::vec3 centre = glm::vec3(0.5f * static_cast<float>(n)) + glm::vec3(0.13f, 0.27f, -0.31f);
  add_body(scene, make_sphere(radius, at(centre)), make_material({.eta = 1.5f}));
  std::vector<PathRay> rays;
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * kPi * (i + 0.37) / 40;
    rays.push_back({centre + radius * glm::vec3(-1.5f, impact * std::cos(angle), impact * std::sin(angle)), {1, 0, 0}});
  }
  const double expected = 2 * (std::asin(impact) - std::asin(impact / 1.5));
  double sum = 0;
  for (const PathRay& ray : trace(context.session, upload(context, scene), rays, 0.5f, 4096)) {
    if (ray.surfaces != 2) return kNone;
    sum += std::pow(glm::degrees(std::atan2(std::hypot(ray.v.y, ray.v.z), ray.v.x) - expected), 2);
  }
  return std::sqrt(sum / static_cast<double>(rays.size()));
}

Case ball_case() {
  Case c{.number = 0,
         .name = "ball",
         .title = "A glass ball deviates light by what its surface's normal says, also at grazing incidence",
         .equation = "deviation = 2 (asin b - asin(b / 1.5))",
         .source = "Snell twice; numerics section 6: .005, .010, .029, .053 degrees at b = .5, .7, .9, .95"};
  Refinement r;
  r.parameter = "voxel_size";
  r.unit = "R";
  r.levels = {1 / 10.0, 1 / 20.0, 1 / 40.0};
  r.order = 2;
  r.order_low = 1.7;  // single levels wander with where voxels stand
  r.order_high = 3.2;
  r.error_names = {"", "rms error of the deviation at b = .7 [deg]", ""};
  r.run = [](CaseContext& context, double voxel) {
    RefinedLevel level{.h = voxel};
    level.l2 = ball_error(context, voxel, 0.7);
    return level;
  };
  c.refinements = {r};
  c.check = [](CaseContext& context, CaseResult& result) {
    const double impacts[] = {0.0, 0.5, 0.7, 0.9, 0.95}, allowed[] = {0.02, 0.05, 0.08, 0.25, 0.6};
    for (int i = 0; i < 5; ++i) {
      char name[64];
      std::snprintf(name, sizeof name, "rms error at impact %g R, R = 20 voxels", impacts[i]);
      result.at_most(name, allowed[i], ball_error(context, 1 / 20.0, impacts[i]),
                     "second order in the voxel; 1 / cos of the incidence near grazing", "deg");
    }
  };
  return c;
}

}  // namespace

std::vector<Case> surface_cases() {
  return {snell_case(), blurred_case(), ball_case()};
}

}  // namespace turbid::study
