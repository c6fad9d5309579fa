// SPDX-License-Identifier: Apache-2.0
// The error that a run estimates for itself covers the one it has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "host/study/error_estimate.h"
#include "host/study/photon_reference.h"
#include "tests/support/test_media.h"

namespace turbid {
namespace {

struct Sample {
  const char* name;
  float depth, albedo, eta, g;  ///< transport depth over the radius, transport albedo
  bool sphere = true, beam = true;
};

/// A body of radius 1 under a spot light or parallel light.
Scene scene_of(const Sample& sample) {
  std::vector<std::string> settings;
  const float sigma_s = sample.albedo * sample.depth / (1 - sample.g), sigma_a = (1 - sample.albedo) * sample.depth;
  Scene scene;
  scene.name = sample.name;
  scene.medium = test::empty_domain({32, 32, 32}, 2.3f / 32, FaceBoundary::open);
  scene.medium.frame.origin = glm::vec3(-1.15f);
  test::add_body(scene.medium, sample.sphere ? make_sphere(1.0f, {}) : make_box({1.6f, 1.6f, 1.6f}, {}),
                 test::make_material(
                     {.sigma_s = glm::vec3(sigma_s), .sigma_a = glm::vec3(sigma_a), .eta = sample.eta, .g = sample.g}));
  Light light;
  light.name = "light";
  light.kind = sample.beam ? LightKind::spot : LightKind::directional;
  light.position = {3, 4, 5};
  light.direction = glm::normalize(sample.beam ? glm::vec3(-3, -4, -5) : glm::vec3(0.3f, -0.5f, -1));
  light.cone_angle = 30;
  scene.lights = {light};
  return scene;
}

TEST(ErrorEstimate, covers_the_true_error_and_is_not_far_above_it) {
  const std::vector<Sample> samples{
      {"deep milk", 10, 0.99f, 1.35f, 0},          {"matched", 10, 0.9f, 1, 0},
      {"forward", 5, 0.99f, 1.3f, 0.8f},           {"white, thin", 1, 1, 1, 0, false},
      {"thin glass", 0.4f, 0.9f, 1.5f, 0},         {"dark", 3, 0.5f, 1.2f, 0, false, false},
      {"cube of resin", 3, 0.99f, 1.5f, 0, false}, {"thin haze", 0.3f, 0.99f, 1, 0.5f, true, false}};
  std::vector<double> ratios;
  int covered = 0;
  for (const Sample& sample : samples) {
    const Scene scene = scene_of(sample);
    const SceneRun run = run_scene(test::session(), scene, false);
    Progress quiet(Verbosity::quiet);
    const auto estimate = estimate_error(test::session(), run.on_grid, run.solution, false, quiet);
    ASSERT_TRUE(estimate);
    const PhotonReference reference = photon_reference(test::session(), scene, {.photons = 3e5});
    const ReferenceErrors truth = fluence_errors(sample_fluence(run.solution.volume, run.on_grid.medium), reference);
    const double ratio = estimate->fluence.total() / truth.rel_l2;
    ratios.push_back(ratio);
    covered += ratio >= 1;
    std::printf("%-14s true %.3f (scatter taken out: %.3f)  estimate %.3f\n", sample.name, truth.rel_l2, truth.noise,
                estimate->fluence.total());
  }
  std::sort(ratios.begin(), ratios.end());
  // Of 8, none may be missed if 95 % of all are to be covered; the design asks for 5 in the median.
  EXPECT_EQ(covered, static_cast<int>(samples.size()));
  EXPECT_LE(ratios[ratios.size() / 2], 5);
}

}  // namespace
}  // namespace turbid
