// SPDX-License-Identifier: Apache-2.0
// Light before it is scattered: how it enters, attenuation by Beer and Lambert.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

/// A matched slab, 20 voxels thick along one axis, that reaches beyond the domain's sides: no edges, whose samples are
/// rounded.
MediumDescription slab(int axis, float voxel_size, const test::MaterialSpec& spec) {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), voxel_size);
  glm::vec3 size(100 * voxel_size);
  size[axis] = 20 * voxel_size;
  test::add_body(scene, make_box(size, test::at(glm::vec3(16 * voxel_size))), test::make_material(spec));
  return scene;
}

TEST(BeerLambert, AnAbsorbingSlabTransmitsTheExponential) {
  const test::Run run = test::run(slab(0, 0.1f, {.sigma_a = {0.2f, 1, 3}}), {test::sunlight({1, 0, 0})});
  const double sigma[3] = {0.2, 1, 3};
  for (int c = 0; c < 3; ++c) {
    const double entered = run.energy().emitted[c] - run.energy().missed[c];
    EXPECT_NEAR(entered / 10.24, 1, 0.05);  // 3.2 x 3.2 units of irradiance 1, up to a ray of 45 at every edge
    EXPECT_NEAR(run.energy().escaped_faces[1][c] / entered / std::exp(-sigma[c] * 2), 1,
                3e-4 * sigma[c]);  // path: 1e-3 voxel of .1 at either end
    EXPECT_NEAR(run.energy().escaped[c], run.energy().escaped_faces[1][c], 1e-12);
    EXPECT_EQ(run.energy().reflected[c], 0);
  }
}

TEST(BeerLambert, ScatteringRemovesLightFromTheBeamLikeAbsorption) {
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec3 direction(0);
    direction[axis] = axis == 1 ? -1 : 1;
    const test::Marched m = test::march(slab(axis, 1, {.sigma_s = glm::vec3(0.15f), .sigma_a = glm::vec3(0.05f)}),
                                        {test::sunlight(direction)});
    double escaped = 0;
    for (const glm::dvec3& face : m.tallies.escaped) escaped += face.x;
    EXPECT_NEAR(escaped / m.carried.x / std::exp(-0.2 * 20), 1, 0.2 * 3e-3);  // path: 1e-3 voxel at either end
    EXPECT_NEAR(m.tallies.deposited.x / m.tallies.absorbed.x, 3, 1e-5);       // albedo .75
  }
}

TEST(BeerLambert, ForwardScatteringCountsAsUnscatteredByItsSquare) {
  // Delta-Eddington: sigma_s* = (1 - g^2) sigma_s.
  const test::Marched m = test::march(slab(0, 1, {.sigma_s = glm::vec3(0.2f), .g = 0.8f}), {test::sunlight({1, 0, 0})});
  EXPECT_NEAR(m.tallies.escaped[1].x / m.carried.x / std::exp(-0.2 * 0.36 * 20), 1, 0.072 * 3e-3);
}

TEST(BeerLambert, AttenuationFollowsAVaryingCoefficient) {
  // sigma_a = .01 + .02 x: midpoint steps integrate a linear coefficient exactly.
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 1.0f);
  Material material = test::make_material({});
  material.sigma_a = expression_field("0.01 + 0.02*x");
  test::set_ambient(scene, material);
  const test::Run run = test::run(scene, {test::sunlight({1, 0, 0})});
  // Beyond the outermost voxel centres the value there holds: .01 + .02 * (.5 .. 15.5), symmetric about the mean.
  const double depth = 16 * (0.01 + 0.02 * 8);
  EXPECT_NEAR(run.energy().escaped_faces[1].x / (run.energy().emitted.x - run.energy().missed.x) / std::exp(-depth), 1,
              1e-4);  // 32 steps' rounding; the half voxel at either end
}

TEST(PeriodicDomain, IsCrossedAsIfItWentOn) {
  // Light at 45 degrees through a domain as wide as it is high passes every x once, wherever it enters and wraps: the
  // depth is sqrt(2) times the whole integral of sigma_a = .01 + .01 x over 16 voxels.
  MediumDescription scene = test::empty_domain(glm::ivec3(16), 1.0f, FaceBoundary::periodic);
  scene.faces[2] = scene.faces[3] = FaceBoundary::open;
  Material material = test::make_material({});
  material.sigma_a = expression_field("0.01 + 0.01*x");
  test::set_ambient(scene, material);
  const test::Run run = test::run(scene, {test::sunlight({1, -1, 0})});
  const EnergyBalance& e = run.energy();
  const double depth = std::sqrt(2) * 16 * (0.01 + 0.01 * 8);
  // Steps are cut at the seam; one of half a voxel there sees the mean of a piece: (slope * step)^2 is 2e-5.
  EXPECT_NEAR(e.escaped_faces[2].x / (e.emitted.x - e.missed.x) / std::exp(-depth), 1, 1e-3);
}

TEST(Sunlight, BringsARepeatedDomainIrradianceTimesAreaTimesCosine) {
  // 24 x 16 voxels of .37 repeat sideways, with a layer in them that goes on beyond the faces or ends on them.
  const double area = 24 * 16 * 0.37 * 0.37;
  for (const FaceBoundary sides : {FaceBoundary::periodic, FaceBoundary::mirror}) {
    for (const bool ends : {false, true}) {
      for (const glm::vec3 towards : {glm::vec3(0, 0, 1), glm::vec3(0.5f, -0.3f, 1), glm::vec3(-1, 0, 0.4f)}) {
        for (const float rays_per_face : {1.0f, 3.0f, 16.0f}) {
          MediumDescription scene = test::empty_domain({24, 16, 16}, 0.37f, sides);
          scene.faces[4] = scene.faces[5] = FaceBoundary::open;
          const glm::vec3 wide = ends ? glm::vec3(24, 16, 7) : glm::vec3(124, 116, 7);
          test::add_body(scene, make_box(0.37f * wide, test::at(0.37f * glm::vec3(12, 8, 8))),
                         test::make_material({.sigma_a = glm::vec3(1)}));
          const test::Marched m = test::march(scene, {test::sunlight(towards)}, {.rays_per_face = rays_per_face});
          const double expected = area * glm::normalize(towards).z;
          // The powers of rays are floats.
          EXPECT_NEAR(m.carried.x / expected, 1, 1e-6) << ends << " " << towards.x << " " << rays_per_face;
          EXPECT_NEAR(m.rays.emitted.x / expected, 1, 1e-6) << ends << " " << towards.x << " " << rays_per_face;
        }
      }
    }
  }
}

TEST(Sunlight, BringsAMediumThatFillsItsDomainAllThatItsFacesCatch) {
  for (const glm::vec3 towards : {glm::vec3(0, 1, 0), glm::vec3(0.5f, -0.3f, 1)}) {
    for (const float rays_per_face : {1.0f, 5.0f}) {
      MediumDescription scene = test::empty_domain({24, 8, 16}, 0.37f);
      test::set_ambient(scene, test::make_material({.sigma_a = glm::vec3(1)}));
      const glm::dvec3 unit = glm::abs(glm::normalize(glm::dvec3(towards)));
      const double expected = 0.37 * 0.37 * (unit.x * 8 * 16 + unit.y * 24 * 16 + unit.z * 24 * 8);
      const test::Marched m = test::march(scene, {test::sunlight(towards)}, {.rays_per_face = rays_per_face});
      EXPECT_NEAR(m.carried.x / expected, 1, 1e-6) << towards.x << " " << rays_per_face;
      EXPECT_NEAR(m.rays.emitted.x / expected, 1, 1e-6) << towards.x << " " << rays_per_face;
    }
  }
}

TEST(LightEntry, MatchedIndicesOtherThanOneReflectNothing) {
  // A body of the ambient's own index is no interface, also when that index is water's and the ambient is clear.
  for (bool participating : {false, true}) {
    MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
    test::set_ambient(scene, test::make_material({.sigma_a = glm::vec3(participating ? 1e-4f : 0), .eta = 1.33f}));
    test::add_body(scene, make_sphere(10, test::at(glm::vec3(16))),
                   test::make_material({.sigma_a = glm::vec3(0.01f), .eta = 1.33f}));
    const EnergyBalance e = test::run(scene, {test::sunlight({1, 0, 0})}).energy();
    EXPECT_EQ(e.reflected.x, 0) << participating;
    EXPECT_EQ(e.in_flight.x, 0) << participating;
    EXPECT_NEAR(e.escaped.x, e.escaped_faces[1].x, 1e-12) << participating;  // nothing is bent aside
  }
}

TEST(LightEntry, AGlassSphereInWaterReflectsAsMuchAsTheirIndicesSay) {
  // Cross-section average of Fresnel's reflectance over a disc: integral of F(sin^2) d(sin^2).
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::set_ambient(scene, test::make_material({.eta = 1.33f}));
  test::add_body(scene, make_sphere(12, test::at(glm::vec3(16))),
                 test::make_material({.sigma_a = glm::vec3(10), .eta = 1.7f}));
  const EnergyBalance e = test::run(scene, {test::sunlight({1, 0, 0})}).energy();
  double expected = 0;
  for (int i = 0; i < 20000; ++i) {
    const double s2 = (i + 0.5) / 20000, ci = std::sqrt(1 - s2), r = 1.33 / 1.7, ct = std::sqrt(1 - r * r * s2);
    const double s = (1.33 * ci - 1.7 * ct) / (1.33 * ci + 1.7 * ct),
                 p = (1.7 * ci - 1.33 * ct) / (1.7 * ci + 1.33 * ct);
    expected += 0.5 * (s * s + p * p) / 20000;
  }
  EXPECT_NEAR(e.reflected.x / (e.emitted.x - e.missed.x) / expected, 1,
              0.05);  // a regular grid of 900 rays over the disc
}

TEST(LightEntry, ASpotOrLampThatFallsWhollyOnAMediumBringsAllItsPower) {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f, FaceBoundary::open, true);
  test::set_ambient(scene, test::make_material({.sigma_a = glm::vec3(0.1f)}));
  Light spot = test::point_light({0, 0, 60}, {5, 3, 1});
  spot.kind = LightKind::spot;
  spot.direction = {0, 0, -1};
  spot.cone_angle = 20;
  for (const Light& light : {spot, test::point_light({3, 5, -7}, {5, 3, 1})}) {
    const EnergyBalance e = test::run(scene, {light}).energy();
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(e.emitted[c], light.power[c], 1e-6);
      EXPECT_NEAR(e.missed[c] / e.emitted[c], 0, 5e-3);  // the cone's rim cuts texels: one in 30 across, of either sign
    }
  }
}

}  // namespace
}  // namespace turbid
