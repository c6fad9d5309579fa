// SPDX-License-Identifier: Apache-2.0
// Index and coefficients as voxels: the blurred index of smooth surfaces against the error function, varying fields.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/voxel_scenes.h"

namespace turbid {
namespace {

TEST(Voxelise, BlurredIndexOfAFlatFaceIsTheErrorFunction) {
  MediumDescription d = scene(32);
  d.smoothing_voxels = 1.5f;
  for (const float face : {0.0f, 0.4f}) {  // on a face between voxels, and within one [voxels]
    Body slab;
    slab.solid = make_box(glm::vec3(8), {glm::mat3(1), 1, {-4 + face * d.frame.voxel_size, 0, 0}});
    slab.surface = SurfaceKind::smooth;
    d.bodies = {slab};
    const MediumVolume medium = voxelise(d);
    EXPECT_TRUE(medium.region(0).smooth_surface && medium.region(1).smooth_surface && medium.region(1).graded_index);
    for (int r = 0; r < 2; ++r) {
      std::array<float, 32> eta;
      medium.read_eta(r, {0, 16, 16}, {32, 1, 1}, eta);
      for (int i = 0; i < 32; ++i) {
        const double distance = i - 15.5 - face;
        // Voxels widen the Gaussian's variance by 1/12, or 1/6 where the face cuts a voxel: at most 1 % of the step.
        EXPECT_NEAR(eta[i], 1 + 0.3 * 0.5 * std::erfc(distance / (1.5 * std::sqrt(2.0))), 0.01 * 0.3) << i;
        EXPECT_GE(eta[i], 1.0f);
        EXPECT_LE(eta[i], 1.3f);
        if (i > 0) {
          EXPECT_LE(eta[i], eta[i - 1]);
        }
      }
      EXPECT_EQ(eta[0], 1.3f);
      EXPECT_EQ(eta[31], 1.0f);
    }
  }
}

TEST(Voxelise, BlurredIndexWrapsOnPeriodicAxes) {
  MediumDescription d = scene(16);
  d.faces = {FaceBoundary::periodic, FaceBoundary::periodic};
  Body slab;
  slab.solid = make_box(glm::vec3(8), {glm::mat3(1), 1, {-4, 0, 0}});  // x < 0: a second face at the domain's ends
  slab.surface = SurfaceKind::smooth;
  d.bodies = {slab};
  std::array<float, 16> eta;
  voxelise(d).read_eta(0, {0, 8, 8}, {16, 1, 1}, eta);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(eta[i], eta[7 - i], 1e-6f) << "both faces blur alike";
    EXPECT_NEAR(eta[i] - 1.15f, 1.15f - eta[15 - i], 1e-6f);
  }
  EXPECT_LT(eta[0], 1.29f);
}

TEST(Voxelise, SharpBodiesKeepTheirOwnIndex) {
  MediumDescription d = scene(32);
  d.materials.push_back(material("glass", 1.5f, 0.0f));
  d.bodies = {sphere({-0.5f, 0, 0}, 0.4f), sphere({0.5f, 0, 0}, 0.4f, 1)};
  d.bodies[0].surface = SurfaceKind::smooth;
  const MediumVolume medium = voxelise(d);
  EXPECT_FALSE(medium.region(2).graded_index);
  EXPECT_EQ(medium.region(2).eta, 1.5f);
  std::array<float, 32> own, group;
  medium.read_eta(2, {0, 16, 16}, {32, 1, 1}, own);
  medium.read_eta(1, {0, 16, 16}, {32, 1, 1}, group);
  for (const float eta : own) EXPECT_EQ(eta, 1.5f);
  EXPECT_EQ(group[24], 1.0f) << "the smooth group does not see the sharp body";
  EXPECT_NEAR(group[8], 1.3f, 1e-6f) << "rounding of the weights";
}

TEST(Voxelise, VaryingCoefficientsAreEvaluatedAtVoxelCentresAndTwoVoxelsBeyond) {
  MediumDescription d = scene(32);
  d.materials[0].sigma_s = formula([](glm::vec3 p) { return glm::vec3(3) + p; });
  d.materials[0].eta = formula([](glm::vec3 p) { return glm::vec3(1.4f + 0.1f * p.x); });
  d.materials.push_back(material("glass", 1.5f, 0.0f));
  d.bodies = {sphere(glm::vec3(0), 0.6f), sphere(glm::vec3(0), 0.3f, 1)};
  const MediumVolume medium = voxelise(d);
  EXPECT_TRUE(medium.region(1).heterogeneous && medium.region(1).graded_index && medium.region(1).scatters);
  EXPECT_FALSE(medium.region(1).emits || medium.region(1).absorbs || medium.region(2).scatters);
  EXPECT_NEAR(medium.region(1).eta, 1.4f, 1e-3f) << "mean of an odd function about the centre";
  std::vector<Coefficients> found(24 * 24 * 24);
  std::vector<float> eta(found.size());
  medium.read_coefficients(1, glm::ivec3(4), glm::ivec3(24), found);  // also inside the nested sphere
  medium.read_eta(1, glm::ivec3(4), glm::ivec3(24), eta);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const int v = static_cast<int>(i);
    const glm::vec3 p = d.frame.centre_of(glm::ivec3(4) + glm::ivec3(v % 24, v / 24 % 24, v / 576));
    ASSERT_EQ(found[i].sigma_s, glm::vec3(3) + p);
    ASSERT_EQ(eta[i], 1.4f + 0.1f * p.x);
  }
}

}  // namespace
}  // namespace turbid
