// SPDX-License-Identifier: Apache-2.0
// Snell's law and Fresnel's equations as the device computes them.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/transport/fresnel_moments.h"
#include "tests/support/paths.h"
#include "tests/support/test_media.h"

namespace turbid {
namespace {

struct Surface {
  glm::vec3 direction, normal;
  float eta_from, eta_to;
};
struct Outcome {
  float reflectance;
  glm::vec3 reflected, refracted;
};

std::vector<Outcome> meet(const std::vector<Surface>& surfaces) {
  using F = cl::Buffer<float>;
  cl::Session& session = test::session();
  const cl::Program program = session.build(test::test_kernel("probe_medium.cl"), {{"TURBID_CHANNELS", 1},
                                                                                     {"TURBID_BODIES", 0},
                                                                                     {"TURBID_GRADED", 0},
                                                                                     {"TURBID_HETEROGENEOUS", 0},
                                                                                     {"TURBID_HALF_TILES", 0},
                                                                                     {"TURBID_SCATTERING", 0},
                                                                                     {"TURBID_VOXELS_X", 8},
                                                                                     {"TURBID_VOXELS_Y", 8},
                                                                                     {"TURBID_VOXELS_Z", 8}});
  cl::Kernel<F, F, int> kernel(program, "probe_interface");
  std::vector<float> in;
  for (const Surface& s : surfaces) {
    in.insert(in.end(),
              {s.direction.x, s.direction.y, s.direction.z, s.normal.x, s.normal.y, s.normal.z, s.eta_from, s.eta_to});
  }
  const F input = session.upload(in);
  const F output = session.zeros<float>(7 * surfaces.size());
  kernel.enqueue(session.march_queue(), {surfaces.size()}, {1}, input, output, static_cast<int>(surfaces.size()));
  const std::vector<float> out = session.read(session.march_queue(), output);
  std::vector<Outcome> result;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const float* at = out.data() + 7 * i;
    result.push_back({at[0], {at[1], at[2], at[3]}, {at[4], at[5], at[6]}});
  }
  return result;
}

Surface flat(double degrees, float eta_from, float eta_to) {
  const double a = glm::radians(degrees);
  return {{static_cast<float>(std::sin(a)), 0, static_cast<float>(std::cos(a))}, {0, 0, -1}, eta_from, eta_to};
}

double angle_from_z(glm::vec3 v) {
  return glm::degrees(std::atan2(std::hypot(v.x, v.y), std::abs(v.z)));
}

constexpr double kAngle = 2e-5;  // degrees: a few roundings of unit floats, 6e-8 rad each

TEST(Interface, ThirtyDegreesIntoGlassRefractToNineteenPointFour) {
  const glm::vec3 refracted = meet({flat(30, 1, 1.5f)})[0].refracted;
  EXPECT_NEAR(angle_from_z(refracted), 19.471221, kAngle);
  EXPECT_GT(refracted.z, 0);
}

TEST(Interface, GlassToAirBendsAwayFromTheNormal) {
  EXPECT_NEAR(angle_from_z(meet({flat(19.471221, 1.5f, 1)})[0].refracted), 30.0, kAngle);
}

TEST(Interface, FourPercentComeBackAtNormalIncidence) {
  const auto out = meet({flat(0, 1, 1.5f), flat(0, 1.5f, 1)});
  EXPECT_NEAR(out[0].reflectance, 0.04, 1e-7);  // two roundings of 0.2^2
  EXPECT_NEAR(out[1].reflectance, 0.04, 1e-7);
  EXPECT_NEAR(out[0].reflected.z, -1, 1e-6);
}

TEST(Interface, BeyondTheCriticalAngleEverythingComesBack) {
  const auto out = meet({flat(41.7, 1.5f, 1), flat(41.9, 1.5f, 1), flat(89, 1.5f, 1)});  // critical: 41.81 degrees
  EXPECT_LT(out[0].reflectance, 1.0f);
  EXPECT_EQ(out[1].reflectance, 1.0f);
  EXPECT_EQ(out[2].reflectance, 1.0f);
}

TEST(Interface, BrewstersAngleHalvesTheReflection) {
  // At atan(1.5) the p polarisation vanishes; s gives ((1 - n^2) / (1 + n^2))^2 / 2.
  const double s = (1 - 2.25) / (1 + 2.25);
  EXPECT_NEAR(meet({flat(glm::degrees(std::atan(1.5)), 1, 1.5f)})[0].reflectance, 0.5 * s * s, 2e-7);
}

TEST(Interface, GrazingLightIsReflectedWhole) {
  EXPECT_NEAR(meet({flat(89.9999, 1, 1.5f)})[0].reflectance, 1.0, 2e-5);  // 1 - R ~ 8.6 cos(theta)
}

TEST(Interface, TheSignOfTheNormalDoesNotMatter) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<Surface> surfaces;
  for (int i = 0; i < 200; ++i) {
    Surface s{glm::normalize(glm::vec3(normal(random), normal(random), normal(random))),
              glm::normalize(glm::vec3(normal(random), normal(random), normal(random))), 1.0f, 1.5f};
    surfaces.push_back(s);
    s.normal = -s.normal;
    surfaces.push_back(s);
  }
  const auto out = meet(surfaces);
  for (std::size_t i = 0; i < out.size(); i += 2) {
    EXPECT_EQ(out[i].reflectance, out[i + 1].reflectance);
    EXPECT_EQ(out[i].refracted, out[i + 1].refracted);
    EXPECT_EQ(out[i].reflected, out[i + 1].reflected);
  }
}

TEST(Interface, RandomPathsObeySnellFresnelAndReversibility) {
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> index(1.0f, 2.5f);
  std::vector<Surface> there, back;
  for (int i = 0; i < 500; ++i) {
    there.push_back({glm::normalize(glm::vec3(normal(random), normal(random), normal(random))),
                     glm::normalize(glm::vec3(normal(random), normal(random), normal(random))), index(random),
                     index(random)});
  }
  const auto out = meet(there);
  for (std::size_t i = 0; i < out.size(); ++i) {
    back.push_back({-out[i].refracted, there[i].normal, there[i].eta_to, there[i].eta_from});
  }
  const auto returned = meet(back);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Surface& s = there[i];
    const double mu = std::abs(glm::dot(glm::dvec3(s.direction), glm::dvec3(s.normal)));
    const double expected = fresnel_reflectance(mu, s.eta_from, s.eta_to);
    const double sine = s.eta_from / s.eta_to * std::sqrt(1 - mu * mu);
    // Where a cosine is small, 1 - sin^2 magnifies the rounding of the directions: those rays are left out.
    if (mu < 0.1 || std::abs(sine - 1) < 0.005) continue;
    EXPECT_NEAR(out[i].reflectance, expected, 1e-5);  // rounding 1e-7 * ratio^2 (6) / (2 cos_t, 0.2) * slope (4)
    // Reflection keeps the part along the surface and turns the part across it.
    const glm::vec3 along = s.direction - glm::dot(s.direction, s.normal) * s.normal;
    EXPECT_LT(glm::length(out[i].reflected - (along - glm::dot(s.direction, s.normal) * s.normal)), 1e-6f);
    if (sine > 1) continue;
    EXPECT_NEAR(glm::length(out[i].refracted), 1, 1e-6);
    EXPECT_GT(glm::dot(out[i].refracted, s.normal) * glm::dot(s.direction, s.normal),
              0);  // it goes on to the other side
    EXPECT_LT(glm::length(glm::cross(s.eta_from * s.direction - s.eta_to * out[i].refracted, s.normal)),
              1e-6f);                                                // Snell
    EXPECT_NEAR(returned[i].reflectance, out[i].reflectance, 2e-5);  // Stokes: the same from both sides
    EXPECT_LT(glm::length(returned[i].refracted + s.direction), 1e-5f);
  }
}

TEST(FresnelMoments, AgreeWithTheTabulatedExtrapolation) {
  // Haskell et al. 1994; numerics section 3, given to four digits.
  EXPECT_NEAR(fresnel_moments(1.33, 1).extrapolation(), 2.515, 1e-3);
  EXPECT_NEAR(fresnel_moments(1.4, 1).extrapolation(), 2.949, 1e-3);
  EXPECT_NEAR(fresnel_moments(1.5, 1).extrapolation(), 3.628, 1e-3);
  EXPECT_EQ(fresnel_moments(1.4, 1.4).extrapolation(), 1.0);
}

TEST(FresnelMoments, AnInterfaceHoldsLightBackAlikeFromBothSides) {
  // Reciprocity: (1 - R_phi12) eta1^2 = (1 - R_phi21) eta2^2. Midpoint rule with 4000 points: 1e-6.
  for (double eta : {1.1, 1.33, 1.5, 2.0})
    EXPECT_NEAR(interface_resistance(1, eta) / interface_resistance(eta, 1), 1, 1e-5);
  EXPECT_EQ(interface_resistance(1.3, 1.3), 0.0);
}

}  // namespace
}  // namespace turbid
