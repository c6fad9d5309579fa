// SPDX-License-Identifier: Apache-2.0
// What physics a scene is found to need.
#include "host/scene/features.h"

#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

SceneFeatures features_of(const std::string& material, const std::string& more = "", const std::string& power = "1") {
  const Scene scene = test::read_text("[domain]\nresolution = 16\n[material.a]\n" + material +
                                      "\n[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = \"a\"\n" + more +
                                      "\n[[light]]\ntype = \"point\"\nposition = [5, 0, 0]\npower = " + power + "\n");
  return scene_features(voxelise(scene.medium), scene.lights);
}

TEST(SceneFeatures, fog_needs_scattering_alone) {
  const SceneFeatures f = features_of("sigma_s = 1");
  EXPECT_EQ(f.bodies, 1);
  EXPECT_TRUE(f.scattering);
  EXPECT_FALSE(f.interfaces);
  EXPECT_FALSE(f.graded_index);
  EXPECT_FALSE(f.absorption);
  EXPECT_FALSE(f.heterogeneous);
  EXPECT_FALSE(f.anisotropic);
  EXPECT_FALSE(f.emission);
}

TEST(SceneFeatures, glass_needs_interfaces_alone) {
  const SceneFeatures f = features_of("eta = 1.5");
  EXPECT_TRUE(f.interfaces);
  EXPECT_FALSE(f.graded_index);
  EXPECT_FALSE(f.scattering);
}

TEST(SceneFeatures, smooth_surfaces_bend_rays_and_have_no_interface) {
  const SceneFeatures f = features_of("eta = 1.5\nsigma_s = 1", "interface = \"smooth\"");
  EXPECT_TRUE(f.graded_index);
  EXPECT_FALSE(f.interfaces);
}

TEST(SceneFeatures, a_varying_index_bends_rays) {
  EXPECT_TRUE(features_of("eta = { field = \"luneburg\", radius = 1 }").graded_index);
}

TEST(SceneFeatures, opaque_bodies_are_interfaces) {
  const SceneFeatures f = features_of("opaque = 0.5");
  EXPECT_TRUE(f.interfaces);
  EXPECT_FALSE(f.scattering);
}

TEST(SceneFeatures, glow_is_solved_for_like_scattering) {
  const SceneFeatures f = features_of("emission = 1");
  EXPECT_TRUE(f.emission);
  EXPECT_TRUE(f.scattering);
}

TEST(SceneFeatures, varying_coefficients_are_heterogeneous) {
  EXPECT_TRUE(features_of("sigma_s = { expression = \"2 + x\" }").heterogeneous);
}

TEST(SceneFeatures, a_mean_cosine_that_varies_about_zero_is_anisotropic) {
  EXPECT_TRUE(features_of("sigma_s = 1\ng = 0.5").anisotropic);
  EXPECT_TRUE(features_of("sigma_s = 1\ng = { expression = \"x < 0 ? 0.5 : -0.5\" }").anisotropic);
  EXPECT_FALSE(features_of("sigma_s = { expression = \"2 + x\" }").anisotropic);
}

TEST(SceneFeatures, grey_media_under_one_colour_of_light_need_one_channel) {
  const SceneFeatures f = features_of("sigma_s = 1\nsigma_a = { expression = \"1 + x*x\" }", "", "[2, 1, 0.5]");
  EXPECT_EQ(f.channels, 1);
  EXPECT_EQ(f.tint, glm::vec3(1, 0.5f, 0.25f));
}

TEST(SceneFeatures, coloured_media_need_three_channels) {
  EXPECT_EQ(features_of("sigma_s = [1, 2, 1]").channels, 3);
  EXPECT_EQ(features_of("sigma_s = { expression = [\"1 + x*x\", \"1 + x*x\", \"1 + 2*x*x\"] }").channels, 3);
  EXPECT_EQ(features_of("sigma_s = [1, 2, 1]").tint, glm::vec3(1));
}

TEST(SceneFeatures, lights_of_different_colours_need_three_channels) {
  const std::string second = "[[light]]\ntype = \"directional\"\ndirection = [0, -1, 0]\nirradiance = ";
  EXPECT_EQ(features_of("sigma_s = 1", second + "[1, 1, 2]").channels, 3);
  EXPECT_EQ(features_of("sigma_s = 1", second + "3").channels, 1);
}

TEST(SceneFeatures, glow_of_another_colour_than_the_light_needs_three_channels) {
  EXPECT_EQ(features_of("sigma_s = 1\nemission = [1, 0, 0]").channels, 3);
  EXPECT_EQ(features_of("sigma_s = 1\nemission = { expression = [\"1 + x\", \"0\", \"0\"] }").channels, 3);
  EXPECT_EQ(features_of("sigma_s = 1\nemission = [1, 0, 0]", "", "[3, 0, 0]").channels, 1);
}

TEST(SceneFeatures, are_described_in_a_line_each) {
  const auto lines = features_of("eta = 1.5\nsigma_s = [1, 2, 3]").describe();
  EXPECT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[1], "refraction: interfaces (Snell, Fresnel)");
  EXPECT_EQ(lines[6], "colours: three channels");
}

}  // namespace
}  // namespace turbid
