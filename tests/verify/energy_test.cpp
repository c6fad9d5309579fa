// SPDX-License-Identifier: Apache-2.0
// Complete runs: attenuation by Beer and Lambert, every watt accounted for, the two solvers agree, runs repeat to the bit.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

constexpr double kPi = std::numbers::pi;
const glm::vec3 kWhite(1);

TEST(BeerLambert, AnAbsorbingBoxTransmitsTheExponential) {
  // Matched index, light along x, edge L = 20 voxels of .1: exp(-sigma L) per colour; the sampled faces of a box are exact.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 0.1f);
  test::add_body(scene, make_box(glm::vec3(2), test::at(glm::vec3(1.6f))), test::make_material({.sigma_a = {0.2f, 1, 3}}));
  const test::Run run = test::run(scene, {test::sunlight({1, 0, 0})});
  const double sigma[3] = {0.2, 1, 3};
  for (int c = 0; c < 3; ++c) {
    const double entered = run.energy().emitted[c] - run.energy().missed[c];
    EXPECT_NEAR(entered, 4, 0.06);                                   // 2 x 2 units of irradiance 1, up to the rays' grid (one ray in 28 per edge)
    EXPECT_NEAR(run.energy().escaped_faces[1][c] / entered / std::exp(-sigma[c] * 2), 1, 3 * 2e-4 * 2);  // path: 1e-3 voxel at either end
    EXPECT_NEAR(run.energy().escaped[c], run.energy().escaped_faces[1][c], 1e-12);
    EXPECT_EQ(run.energy().reflected[c], 0);
  }
}

TEST(BeerLambert, ScatteringRemovesLightFromTheBeamLikeAbsorption) {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_box(glm::vec3(20), test::at(glm::vec3(16))), test::make_material({.sigma_s = glm::vec3(0.15f), .sigma_a = glm::vec3(0.05f)}));
  for (const glm::vec3 direction : {glm::vec3(1, 0, 0), glm::vec3(0, -1, 0), glm::vec3(0, 0, 1)}) {
    const test::Marched m = test::march(scene, {test::sunlight(direction)});
    double escaped = 0;
    for (const glm::dvec3& face : m.tallies.escaped) escaped += face.x;
    EXPECT_NEAR(escaped / m.carried.x / std::exp(-0.2 * 20), 1, 0.2 * 2e-3 * 2);
    EXPECT_NEAR(m.tallies.deposited.x / m.tallies.absorbed.x, 3, 1e-5);  // albedo .75
  }
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
  EXPECT_NEAR(run.energy().escaped_faces[1].x / (run.energy().emitted.x - run.energy().missed.x) / std::exp(-depth), 1, 1e-4);  // 32 steps' rounding; the half voxel at either end
}

TEST(BeerLambert, ForwardScatteringCountsAsUnscatteredByItsSquare) {
  // Delta-Eddington: sigma_s* = (1 - g^2) sigma_s.
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_box(glm::vec3(20), test::at(glm::vec3(16))), test::make_material({.sigma_s = glm::vec3(0.2f), .g = 0.8f}));
  const test::Marched m = test::march(scene, {test::sunlight({1, 0, 0})});
  EXPECT_NEAR(m.tallies.escaped[1].x / m.carried.x / std::exp(-0.2 * 0.36 * 20), 1, 1e-3);
}

struct EnergyCase {
  const char* name;
  MediumDescription scene;
  LightList lights;
};

std::vector<EnergyCase> energy_cases() {
  std::vector<EnergyCase> cases;
  const glm::vec3 sigma_s(0.3f, 0.5f, 0.2f), sigma_a(0.01f, 0.003f, 0.03f);
  const LightList sun{test::sunlight({1, -0.5f, 0.3f}, {1, 0.8f, 0.6f})};
  auto sphere = [&](const test::MaterialSpec& spec, FaceBoundary faces = FaceBoundary::open) {
    MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f, faces);
    test::add_body(scene, make_sphere(11, test::at(glm::vec3(16))), test::make_material(spec));
    return scene;
  };
  cases.push_back({"matched", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a}), sun});
  cases.push_back({"glass", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.5f}), sun});
  cases.push_back({"grey", sphere({.sigma_s = glm::vec3(0.4f), .sigma_a = glm::vec3(0.01f), .eta = 1.4f}), {test::sunlight({0, -1, 0}, {1, 0.5f, 0.25f})}});
  cases.push_back({"no absorption", sphere({.sigma_s = glm::vec3(0.6f), .eta = 1.3f}), {test::sunlight({0, -1, 0})}});
  cases.push_back({"clear glass", sphere({.eta = 1.5f}), sun});
  cases.push_back({"lamp inside", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.5f}), {test::point_light({15, 16.3f, 17})}});
  cases.push_back({"lamp outside", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.5f}), {test::point_light({60, 30, 10}, {3, 2, 1})}});
  cases.push_back({"emitting", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .emission = {0.1f, 0.2f, 0.3f}}), {}});
  {
    EnergyCase c{"mirrors", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.4f}), {test::point_light({4, 5, 6})}};
    c.scene.faces = {FaceBoundary::mirror, FaceBoundary::mirror, FaceBoundary::mirror, FaceBoundary::open, FaceBoundary::mirror, FaceBoundary::open};
    cases.push_back(c);
  }
  {
    EnergyCase c{"periodic", sphere({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.4f}), sun};
    c.scene.faces = {FaceBoundary::periodic, FaceBoundary::periodic, FaceBoundary::open, FaceBoundary::open, FaceBoundary::periodic, FaceBoundary::periodic};
    test::set_ambient(c.scene, test::make_material({.sigma_s = glm::vec3(0.02f), .sigma_a = glm::vec3(0.001f)}));
    cases.push_back(c);
  }
  {
    EnergyCase c{"heterogeneous", test::empty_domain(glm::ivec3(32), 0.5f), sun};
    Material material = test::make_material({.eta = 1.4f});
    material.sigma_s = expression_field({"1 + 0.8*noise(x, y, z)", "2 + noise(2*x, y, z)", "1"});
    material.sigma_a = expression_field("0.05*(1 + noise(x, y, 2*z))");
    test::add_body(c.scene, make_cylinder(5, 12, test::at(glm::vec3(8))), material);
    cases.push_back(c);
  }
  {
    EnergyCase c{"graded", test::empty_domain(glm::ivec3(32), 1.0f), sun};
    Material material = test::make_material({.sigma_s = sigma_s, .sigma_a = sigma_a});
    material.eta = linear_index(glm::vec3(16), 1.4f, {0.01f, 0.005f, 0});
    test::add_body(c.scene, make_sphere(11, test::at(glm::vec3(16))), material);
    cases.push_back(c);
  }
  {
    EnergyCase c{"smooth", test::empty_domain(glm::ivec3(32), 1.0f), sun};
    test::add_body(c.scene, make_sphere(9, test::at(glm::vec3(16))), test::make_material({.sigma_s = sigma_s, .sigma_a = sigma_a, .eta = 1.3f}), SurfaceKind::smooth);
    cases.push_back(c);
  }
  {
    EnergyCase c{"nested", test::empty_domain(glm::ivec3(32), 1.0f), sun};
    test::add_body(c.scene, make_box(glm::vec3(22), test::at(glm::vec3(16))), test::make_material({.sigma_s = 0.2f * kWhite, .sigma_a = sigma_a, .eta = 1.3f}));
    test::add_body(c.scene, make_sphere(6, test::at(glm::vec3(14))), test::make_material({.sigma_s = sigma_s, .eta = 1.6f}));
    Material opaque = test::make_material({});
    opaque.opaque = true;
    test::add_body(c.scene, make_sphere(3, test::at({22, 22, 16})), opaque);
    cases.push_back(c);
  }
  return cases;
}

TEST(EnergyBalance, ClosesForEveryKindOfMediumAndBothSolvers) {
  for (const EnergyCase& c : energy_cases()) {
    for (const char* solver : {"steady", "lattice"}) {
      SolverSettings settings;
      settings.solver = solver;
      settings.lattice.tolerance = 1e-3f;  // the balance holds at any stage: what is still on its way is counted
      const test::Run run = test::run(c.scene, c.lights, settings);
      const EnergyBalance& e = run.energy();
      EXPECT_LT(e.imbalance(), 1e-5) << c.name << ", " << solver;
      for (int colour = 0; colour < 3; ++colour) {
        EXPECT_GT(e.emitted[colour], 0) << c.name;
        EXPECT_GT(e.escaped[colour], 0) << c.name;
        EXPECT_GE(e.missed[colour], -1e-6 * e.emitted[colour]) << c.name;
        EXPECT_LT(e.in_flight[colour], 0.02 * e.emitted[colour]) << c.name << ", " << solver;
        double faces = 0;
        for (const glm::dvec3& face : e.escaped_faces) faces += face[colour];
        EXPECT_NEAR(faces, e.escaped[colour], 1e-9 * e.emitted[colour]);
      }
    }
  }
}

TEST(EnergyBalance, AWhiteMediumGivesBackAllThatItReceives) {
  // Albedo 1: nothing is absorbed, escape plus reflection is all (case: furnace by power).
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(11, test::at(glm::vec3(16))), test::make_material({.sigma_s = glm::vec3(1), .eta = 1.4f}));
  const EnergyBalance e = test::run(scene, {test::sunlight({1, 0, 0})}).energy();
  EXPECT_EQ(e.absorbed.x, 0);
  const double entered = e.emitted.x - e.missed.x;
  EXPECT_NEAR((e.escaped.x + e.reflected.x + e.in_flight.x) / entered, 1, 1e-5);
}

TEST(EnergyBalance, EmissionIsTheVolumeTimesItsDensityPerColour) {
  // Also where one channel carries all three colours by their ratio: (0, 1, .5) has none in the first.
  for (const glm::vec3 emission : {glm::vec3(1, 1, 1), glm::vec3(0, 1, 0.5f), glm::vec3(0.5f, 1, 0.25f), glm::vec3(2, 0, 0)}) {
    MediumDescription scene = test::empty_domain(glm::ivec3(16), 0.5f);
    test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(0.2f), .sigma_a = glm::vec3(0.1f), .emission = emission}));
    const EnergyBalance e = test::run(scene, {}).energy();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(e.emitted[c], 512 * emission[c], 512e-5) << c;
    EXPECT_LT(e.imbalance(), 1e-5);
  }
}

TEST(LightEntry, MatchedIndicesOtherThanOneReflectNothing) {
  // A body of the ambient's own index is no interface, also when that index is water's and the ambient is clear.
  for (bool participating : {false, true}) {
    MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
    test::set_ambient(scene, test::make_material({.sigma_a = glm::vec3(participating ? 1e-4f : 0), .eta = 1.33f}));
    test::add_body(scene, make_sphere(10, test::at(glm::vec3(16))), test::make_material({.sigma_a = glm::vec3(0.01f), .eta = 1.33f}));
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
  test::add_body(scene, make_sphere(12, test::at(glm::vec3(16))), test::make_material({.sigma_a = glm::vec3(10), .eta = 1.7f}));
  const EnergyBalance e = test::run(scene, {test::sunlight({1, 0, 0})}).energy();
  double expected = 0;
  for (int i = 0; i < 20000; ++i) {
    const double s2 = (i + 0.5) / 20000, ci = std::sqrt(1 - s2), r = 1.33 / 1.7, ct = std::sqrt(1 - r * r * s2);
    const double s = (1.33 * ci - 1.7 * ct) / (1.33 * ci + 1.7 * ct), p = (1.7 * ci - 1.33 * ct) / (1.7 * ci + 1.33 * ct);
    expected += 0.5 * (s * s + p * p) / 20000;
  }
  EXPECT_NEAR(e.reflected.x / (e.emitted.x - e.missed.x) / expected, 1, 0.05);  // a regular grid of 900 rays over the disc
}

double relative_difference(const std::vector<float>& a, const std::vector<float>& b) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference += std::pow(static_cast<double>(a[i]) - b[i], 2), norm += static_cast<double>(b[i]) * b[i];
  return std::sqrt(difference / norm);
}

TEST(Solvers, SteadyAndLatticeAgreeToTheirTolerance) {
  for (const EnergyCase& c : energy_cases()) {
    if (c.name == std::string("no absorption") || c.name == std::string("clear glass")) continue;  // slow on a lattice; nothing to solve
    SolverSettings settings;
    const test::Run steady = test::run(c.scene, c.lights, settings);
    settings.solver = "lattice";
    const test::Run lattice = test::run(c.scene, c.lights, settings);
    EXPECT_LT(lattice.solution.report.error_estimate, 1e-4) << c.name;
    EXPECT_LT(relative_difference(lattice.solution.volume.fluence, steady.solution.volume.fluence), 3e-4) << c.name;  // 1e-4 each, in two norms
    for (int colour = 0; colour < 3; ++colour)
      EXPECT_NEAR(lattice.energy().escaped[colour] / steady.energy().escaped[colour], 1, 3e-4) << c.name;
  }
}

TEST(Runs, RepeatToTheBit) {
  const std::vector<EnergyCase> cases = energy_cases();
  for (const char* solver : {"steady", "lattice"}) {
    for (const char* name : {"glass", "nested"}) {
      const auto c = std::find_if(cases.begin(), cases.end(), [&](const EnergyCase& x) { return x.name == std::string(name); });
      SolverSettings settings;
      settings.solver = solver;
      settings.march.batch_steps = 16;
      const test::Run first = test::run(c->scene, c->lights, settings), second = test::run(c->scene, c->lights, settings);
      EXPECT_EQ(first.solution.volume.fluence, second.solution.volume.fluence) << name << ", " << solver;
      EXPECT_EQ(first.solution.volume.deposit, second.solution.volume.deposit) << name << ", " << solver;
      EXPECT_EQ(first.energy().escaped, second.energy().escaped);
    }
  }
}

TEST(Runs, TheDepositDoesNotDependOnHowManyStepsABatchHas) {
  const std::vector<EnergyCase> cases = energy_cases();
  SolverSettings settings;
  const test::Run first = test::run(cases[1].scene, cases[1].lights, settings);
  settings.march.batch_steps = 11;
  EXPECT_EQ(first.solution.volume.deposit, test::run(cases[1].scene, cases[1].lights, settings).solution.volume.deposit);
}

TEST(Runs, LightIsLinear) {
  EnergyCase c = energy_cases()[1];
  const test::Run once = test::run(c.scene, c.lights);
  c.lights[0].irradiance *= 4.0f;  // a power of two: every rounding scales along
  const test::Run four = test::run(c.scene, c.lights);
  for (int colour = 0; colour < 3; ++colour) EXPECT_NEAR(four.energy().escaped[colour] / once.energy().escaped[colour], 4, 4e-6);
}

TEST(PointSource, InAnInfiniteMediumRaisesTransportsFluence) {
  // Case 10: w = .9, means over shells of [2,3], [4,5], [6,7] mean free paths, 10 %. First flight plus diffusion; an eighth of
  // space by mirrors, a quarter of a mean free path per voxel.
  MediumDescription scene = test::empty_domain(glm::ivec3(64), 0.25f);
  scene.faces = {FaceBoundary::mirror, FaceBoundary::open, FaceBoundary::mirror, FaceBoundary::open, FaceBoundary::mirror, FaceBoundary::open};
  test::set_ambient(scene, test::make_material({.sigma_s = glm::vec3(0.9f), .sigma_a = glm::vec3(0.1f)}));
  const test::Run run = test::run(scene, {test::point_light(glm::vec3(0.01f), glm::vec3(0.125f))});
  double sum[3] = {0, 0, 0};
  int count[3] = {0, 0, 0};
  for (int z = 0; z < 32; ++z) {
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        const double r = 0.25 * glm::length(glm::dvec3(x, y, z) + 0.5);
        const int shell = r >= 2 && r < 3 ? 0 : r >= 4 && r < 5 ? 1 : r >= 6 && r < 7 ? 2 : -1;
        if (shell < 0) continue;
        sum[shell] += run.fluence({x, y, z}) + run.deposit({x, y, z}) / 0.9;  // diffuse plus unscattered
        ++count[shell];
      }
    }
  }
  const double expected[3] = {2.196e-2, 4.212e-3, 1.0195e-3};
  std::string text;
  for (int shell = 0; shell < 3; ++shell) {
    text += std::to_string(sum[shell] / count[shell] / expected[shell]) + " ";
    EXPECT_NEAR(sum[shell] / count[shell] / expected[shell], 1, 0.1) << shell;
  }
  RecordProperty("ratios", text);
}

}  // namespace
}  // namespace turbid
