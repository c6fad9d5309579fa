// SPDX-License-Identifier: Apache-2.0
// Paths of light through voxelised lenses, and light held inside one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

constexpr double kPi = std::numbers::pi;

DeviceMedium upload(const MediumDescription& scene) {
  const MediumVolume volume = voxelise(scene);
  return upload_medium(test::session(), volume, scene_features(volume, {}));
}

TEST(LuneburgLens, VoxelisedAsABodyFocusesOnItsFarSide) {
  // The whole chain: named index field, tiles, surface. At the surface the field has a kink (eta = 1 beyond), which
  // central differences and trilinear samples smooth over a voxel: the focus is as sharp as that, 1/24 of the radius,
  // at best.
  const float radius = 24;
  MediumDescription scene = test::empty_domain(glm::ivec3(64), 1.0f);
  Material lens = test::make_material({});
  lens.eta = luneburg_index(glm::vec3(32), radius, 1);
  test::add_body(scene, make_sphere(radius, test::at(glm::vec3(32))), lens);
  const DeviceMedium medium = upload(scene);
  std::vector<test::ProbeRay> rays;
  for (int i = -9; i <= 9; ++i) rays.push_back({{2, 32 + 0.1f * radius * i, 32}, {1, 0, 0}});
  for (const auto& ray : test::trace(medium, rays, 0.5f, 4096)) {
    // Where the outgoing straight ray passes the plane through the focus.
    const glm::dvec3 d = glm::normalize(glm::dvec3(ray.v));
    const glm::dvec3 at = glm::dvec3(ray.x) + d * ((32 + radius - ray.x.x) / d.x);
    EXPECT_NEAR(at.y, 32, 1.0);
    EXPECT_NEAR(at.z, 32, 0.05);
  }
}

TEST(GlassBall, HoldsTotallyReflectedLightOnItsChords) {
  // Inside a ball every chord has the length 2 R cos(theta), and theta stays: after the same arc each ray has met the
  // surface as often as that says. Grazing light must neither leak out nor stick to the surface.
  const float radius = 20;
  MediumDescription scene = test::empty_domain(glm::ivec3(64), 1.0f);
  const glm::vec3 centre(32.13f, 32.27f, 31.69f);
  test::add_body(scene, make_sphere(radius, test::at(centre)), test::make_material({.eta = 1.5f}));
  const DeviceMedium medium = upload(scene);
  for (const double cosine : {0.6, 0.4, 0.2, 0.1, 0.05}) {
    const double sine = std::sqrt(1 - cosine * cosine);
    std::vector<test::ProbeRay> rays;
    for (int i = 0; i < 24; ++i) {
      // From the middle of a chord, in a plane turned about x.
      const double turn = kPi * (i + 0.3) / 24;
      const glm::dvec3 y(0, std::cos(turn), std::sin(turn));
      rays.push_back({glm::dvec3(centre) + radius * sine * y, 1.5 * glm::dvec3(1, 0, 0), 1});
    }
    const auto out = test::trace(medium, rays, 0.5f, 400);
    double worst = 0;
    int lost = 0;
    for (const auto& ray : out) {
      lost += ray.region != 1;
      worst = std::max(worst, std::abs(ray.surfaces / (ray.length / (2 * radius * cosine)) - 1));
    }
    RecordProperty("cosine_" + std::to_string(static_cast<int>(100 * cosine)),
                   std::to_string(worst) + " worst, " + std::to_string(lost) + " lost");
    EXPECT_EQ(lost, 0) << cosine;
    EXPECT_LT(worst, 0.15)
        << cosine;  // counts are whole numbers of five and more; the angle wanders by the normals' error
  }
}

}  // namespace
}  // namespace turbid
