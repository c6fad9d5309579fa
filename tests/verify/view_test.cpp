// SPDX-License-Identifier: Apache-2.0
// What a camera sees against closed forms: emission and absorption along chords, thermal equilibrium, counted power, a
// lit ground and its shadow.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

constexpr double kPi = std::numbers::pi;

Camera camera_at(glm::vec3 position, glm::vec3 target, float fov, int pixels, int samples = 1) {
  Camera camera;
  camera.position = position;
  camera.target = target;
  camera.fov = fov;
  camera.width = camera.height = pixels;
  camera.samples = samples;
  return camera;
}

/// Unit direction through the centre of a pixel of a camera that looks along -z with y up.
glm::dvec3 through(const Camera& camera, int x, int y) {
  const double t = std::tan(glm::radians(0.5 * camera.fov));
  return glm::normalize(
      glm::dvec3(t * (2 * (x + 0.5) / camera.width - 1), t * (1 - 2 * (y + 0.5) / camera.height), -1));
}

/// Every branch followed to the end.
ViewSettings exhaustive() {
  ViewSettings settings;
  settings.min_weight = 0;
  settings.max_branches = 15;
  return settings;
}

TEST(View, AGlowingAbsorbingBallShowsItsChords) {
  // L = e / (4 pi sigma_a) (1 - exp(-sigma_a chord)), matched index, per colour.
  const float radius = 12;
  const glm::vec3 sigma_a(0.02f, 0.1f, 0.5f), emission(0.3f, 0.2f, 0.1f);
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f, FaceBoundary::open, true);
  test::add_body(scene, make_sphere(radius, {}), test::make_material({.sigma_a = sigma_a, .emission = emission}));
  const test::Run run = test::run(scene, {});
  const Camera camera = camera_at({0, 0, 100}, {0, 0, 0}, 14, 48);
  const ViewImage image = test::look_at(run, {}, camera);
  int seen = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      const glm::dvec3 d = through(camera, x, y);
      const double along = -100 * d.z, b2 = 100 * 100 - along * along;
      const double b = std::sqrt(b2) / radius;
      const glm::vec4 found = image.colour[y * 48 + x];
      if (b > 1.02) {
        EXPECT_EQ(found, glm::vec4(0));
      } else if (b < 0.95) {
        const double chord = 2 * radius * std::sqrt(1 - b * b);
        for (int c = 0; c < 3; ++c) {
          const double expected = emission[c] / (4 * kPi * sigma_a[c]) * (1 - std::exp(-sigma_a[c] * chord));
          // The sampled sphere lies up to 0.02 voxel inside the true one at either end, more along a slanted chord.
          EXPECT_NEAR(found[c] / expected, 1, 0.05 / chord / (1 - b * b) + 2e-3) << b;
        }
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 900);
}

TEST(View, EnclosedByAnOpenDomainTheMediumIsSeenToItsFaces) {
  // The ambient itself glows: chords through a cube.
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 1.0f, FaceBoundary::open, true);
  test::set_ambient(scene, test::make_material({.sigma_a = glm::vec3(0.1f), .emission = glm::vec3(0.4f)}));
  const test::Run run = test::run(scene, {});
  const Camera camera = camera_at({0, 0, 50}, {0, 0, 0}, 16, 16);
  const ViewImage image = test::look_at(run, {}, camera);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const glm::dvec3 d = through(camera, x, y), entry = glm::dvec3(0, 0, 50) + d * (42 / -d.z);
      if (std::max(std::abs(entry.x), std::abs(entry.y)) > 7.9) continue;
      double chord = 16 / -d.z;
      for (int axis = 0; axis < 2; ++axis)
        if (std::abs(d[axis]) > 1e-9) chord = std::min(chord, (8 - std::abs(entry[axis])) / std::abs(d[axis]));
      const double expected = 0.4 / (4 * kPi * 0.1) * (1 - std::exp(-0.1 * chord));
      EXPECT_NEAR(image.colour[y * 16 + x].x / expected, 1, 1e-4);  // constant along the chord: exact but for rounding
    }
  }
}

TEST(View, ABodyInThermalEquilibriumWithItsSurroundingsIsInvisible) {
  // Kirchhoff: emission = sigma_a 4 pi eta^2 B under a background B. Fresnel's split, refraction, the eta^2 rule and
  // the gather must add up to B in every pixel, whatever the path.
  const glm::vec3 background(0.7f, 0.5f, 0.3f);
  auto hot = [&](float sigma_a, float eta) {
    return test::make_material({.sigma_a = glm::vec3(sigma_a),
                                .emission = static_cast<float>(4 * kPi) * sigma_a * eta * eta * background,
                                .eta = eta});
  };
  Surroundings surroundings;
  surroundings.background = background;
  for (int which = 0; which < 6; ++which) {
    MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f, FaceBoundary::open, true);
    if (which == 0) test::add_body(scene, make_sphere(12, {}), hot(0.1f, 1));
    if (which == 1) test::add_body(scene, make_sphere(12, {}), hot(0.1f, 1.5f));
    if (which == 2) test::add_body(scene, make_box({18, 14, 20}, {}), hot(0.3f, 1.4f));
    if (which == 3) test::add_body(scene, make_sphere(12, {}), hot(0.0f, 1.5f));  // clear glass
    if (which == 4) {
      test::add_body(scene, make_sphere(13, {}), hot(0.1f, 1.3f));
      test::add_body(scene, make_sphere(6, test::at({2, 1, 0})), hot(0.2f, 1.7f));
    }
    if (which == 5) {  // graded, without a jump at its surface
      Material lens = test::make_material({.sigma_a = glm::vec3(0.05f)});
      lens.eta = luneburg_index(glm::vec3(0), 12, 1);
      lens.emission = expression_field(
          {"4*pi*0.05*0.7*(2-min(r/12,1)^2)", "4*pi*0.05*0.5*(2-min(r/12,1)^2)", "4*pi*0.05*0.3*(2-min(r/12,1)^2)"});
      test::add_body(scene, make_sphere(12, {}), lens);
    }
    const test::Run run = test::run(scene, {});
    const Camera camera = camera_at({0, 0, 80}, {0, 0, 0}, 20, 40);
    const ViewImage image = test::look_at(run, {}, camera, exhaustive(), surroundings);
    double worst = 0, mean = 0;
    for (const glm::vec4& pixel : image.colour) {
      for (int c = 0; c < 3; ++c) {
        const double error = std::abs(pixel[c] / background[c] - 1);
        worst = std::max(worst, error);
        mean += error / (3 * image.colour.size());
      }
    }
    RecordProperty("case_" + std::to_string(which),
                   std::to_string(mean) + " mean, " + std::to_string(worst) + " worst");
    // Constant sources are gathered exactly. Sources near a surface are extrapolated in constant media to the constant
    // itself. The lens's emission is sampled trilinearly, with a kink at its surface. In the nested balls weak branches
    // beyond the 15th interface are dropped: up to some per cent at grazing pixels.
    const double mean_allowed[] = {1e-5, 1e-5, 1e-5, 1e-4, 1e-3, 2e-3},
                 worst_allowed[] = {1e-4, 1e-4, 1e-3, 1e-3, 0.06, 0.02};
    EXPECT_LT(mean, mean_allowed[which]) << which;
    EXPECT_LT(worst, worst_allowed[which]) << which;
  }
}

TEST(View, RadianceOverEtaSquaredCountsThePowerThatALensEmits) {
  // A clear Luneburg lens that glows evenly. All light leaves it (nothing is trapped), evenly in all
  // directions by symmetry: 4 pi D^2 times the irradiance at the camera is emission times volume.
  for (bool graded : {false, true}) {
    const float radius = 13, emission = 0.2f, distance = 100;
    MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f, FaceBoundary::open, true);
    Material lens = test::make_material({.emission = glm::vec3(emission)});
    if (graded) lens.eta = luneburg_index(glm::vec3(0), radius, 1);
    test::add_body(scene, make_sphere(radius, {}), lens);
    const test::Run run = test::run(scene, {});
    const int pixels = 128;
    const Camera camera = camera_at({0, 0, distance}, {0, 0, 0}, 16, pixels);
    const ViewImage image = test::look_at(run, {}, camera, exhaustive());
    const double pixel = 2 * std::tan(glm::radians(8.0)) / pixels;
    double irradiance = 0;
    for (int y = 0; y < pixels; ++y) {
      for (int x = 0; x < pixels; ++x) {
        const double cosine = -through(camera, x, y).z;
        irradiance += image.colour[y * pixels + x].x * pixel * pixel * cosine * cosine * cosine * cosine;
      }
    }
    const double power = 4 * kPi * distance * distance * irradiance,
                 expected = emission * 4 / 3 * kPi * std::pow(radius, 3);
    RecordProperty(graded ? "graded" : "constant", std::to_string(power / expected));
    // Pixels at the rim and the sampled surface: 1e-3; in the lens the half voxel of kinked index at its surface too.
    EXPECT_NEAR(power / expected, 1, graded ? 5e-3 : 2e-3);
  }
}

TEST(View, InsideAnEndlessWhiteFogRadianceIsFluenceOverFourPi) {
  // Furnace: mirrors all around, emission = sigma_a fluence everywhere, radiance even in all directions.
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 1.0f, FaceBoundary::mirror, true);
  test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(0.5f, 1, 2),
                                                .sigma_a = glm::vec3(0.01f, 0.02f, 0.05f),
                                                .emission = glm::vec3(1)}));
  const test::Run run = test::run(scene, {});
  const double sigma_a[3] = {0.01, 0.02, 0.05};
  Surroundings surroundings;
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(run.fluence({3, 9, 12}, c) * sigma_a[c], 1, 1e-4);  // the solve's tolerance
    surroundings.background[c] = static_cast<float>(1 / (4 * kPi * sigma_a[c]));
  }
  const ViewImage image = test::look_at(run, {}, camera_at({1, 2, 3}, {0, 0, -5}, 90, 8), exhaustive(), surroundings);
  for (const glm::vec4& pixel : image.colour) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c] / surroundings.background[c], 1, 3e-4);
  }
}

TEST(View, LambertsGroundUnderALampHasTheKnownRadiance) {
  // rho / pi * P / (4 pi d^2) * cos.
  MediumDescription scene = test::empty_domain(glm::ivec3(8), 1.0f, FaceBoundary::open, true);
  const LightList lamp{test::point_light({3, 30, -2}, {100, 50, 25})};
  Surroundings surroundings;
  surroundings.ground =
      Ground{.height = -10, .colour = {0.8f, 0.6f, 0.4f}, .colour2 = {0.8f, 0.6f, 0.4f}, .checker_size = 0};
  const test::Run run = test::run(scene, lamp, {}, surroundings);
  Camera camera = camera_at({0, 40, 0.001f}, {0, -10, 0}, 30, 8);
  camera.up = {0, 0, -1};
  const ViewImage image = test::look_at(run, lamp, camera, {}, surroundings);
  const double t = std::tan(glm::radians(15.0)) * 50;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const glm::dvec3 hit(t * (2 * (x + 0.5) / 8 - 1), -10, -t * (1 - 2 * (y + 0.5) / 8));
      const glm::dvec3 path = hit - glm::dvec3(3, 30, -2);
      const double d = glm::length(path), expected = 1 / kPi / (4 * kPi * d * d) * (40 / d);
      for (int c = 0; c < 3; ++c) {
        const double power[3] = {100, 50, 25}, reflectance[3] = {0.8, 0.6, 0.4};
        EXPECT_NEAR(image.colour[y * 8 + x][c] / (expected * power[c] * reflectance[c]), 1,
                    1e-3);  // the camera is tilted by 2e-5
      }
    }
  }
}

TEST(View, OpaqueBallsUnderTheSunThrowTheirCrossSectionsAsShadows) {
  // Two unlike balls, so that a shadow map read upside-down or mirrored shows.
  const glm::vec3 places[2] = {{2, 0, 3}, {-4, 1, -4}};
  const float radii[2] = {3.5f, 1.5f};
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 1.0f, FaceBoundary::open, true);
  Material opaque = test::make_material({});
  opaque.opaque = true;
  for (int i = 0; i < 2; ++i) test::add_body(scene, make_sphere(radii[i], test::at(places[i])), opaque);
  const LightList sun{test::sunlight({0, -1, 0}, glm::vec3(2))};
  Surroundings surroundings;
  surroundings.ground = Ground{.height = -20, .colour = glm::vec3(0.5f), .colour2 = glm::vec3(0.5f), .checker_size = 0};
  const test::Run run = test::run(scene, sun, {}, surroundings);
  const int pixels = 160;
  const Camera camera = camera_at({0, -10, 40}, {0, -20, 0}, 40, pixels);  // from the side, below the balls
  const ViewImage image = test::look_at(run, sun, camera, {}, surroundings);
  const glm::dvec3 eye(camera.position), forward = glm::normalize(glm::dvec3(camera.target) - eye), right(1, 0, 0);
  const glm::dvec3 up = glm::cross(right, forward);
  const double t = std::tan(glm::radians(20.0)), size = 2 * t / pixels, lit = 2 * 0.5 / kPi;
  // Each pixel of the ground stands for the area d^2 dOmega / cos; summed is what is missing there, and where.
  double shadow = 0, expected = 0;
  glm::dvec2 moment(0), expected_moment(0);
  for (int i = 0; i < 2; ++i) {
    const double area = kPi * radii[i] * radii[i];
    expected += area;
    expected_moment += area * glm::dvec2(places[i].x, places[i].z);
  }
  for (int y = 0; y < pixels; ++y) {
    for (int x = 0; x < pixels; ++x) {
      const glm::dvec3 d = glm::normalize(forward + right * (t * (2 * (x + 0.5) / pixels - 1)) +
                                          up * (t * (1 - 2 * (y + 0.5) / pixels)));
      if (d.y > -0.02) continue;
      const double distance = -10 / d.y, cosine = glm::dot(d, forward);
      const glm::dvec3 hit = eye + distance * d;
      if (glm::length(glm::dvec2(hit.x, hit.z)) > 14) continue;
      EXPECT_NEAR(image.depth[y * pixels + x] / distance, 1, 1e-3);  // nothing stands before the ground
      const double missing = size * size * cosine * cosine * cosine * distance * distance / -d.y *
                             (1 - image.colour[y * pixels + x].x / lit);
      shadow += missing;
      moment += missing * glm::dvec2(hit.x, hit.z);
    }
  }
  // Shadow map texels of 0.7 voxel, antialiased over two: 2 % of the area, a tenth of a voxel of the place.
  EXPECT_NEAR(shadow / expected, 1, 0.02);
  EXPECT_LT(glm::length(moment / shadow - expected_moment / expected), 0.1);
}

}  // namespace
}  // namespace turbid
