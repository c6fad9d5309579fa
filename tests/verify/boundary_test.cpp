// SPDX-License-Identifier: Apache-2.0
// Diffusion around cavities and across periodic seams.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/test_diffusion.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

TEST(Cavity, InsideAWhiteMediumSwallowsNoLight) {
  // Light that diffuses into an enclosed clear cavity crosses it and comes back. By symmetry nothing flows within a lit
  // shell: the fluence between the cavity and the shell is even, as it is in the solid ball.
  double ratio[2];
  for (int hollow = 0; hollow < 2; ++hollow) {
    MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
    test::add_body(scene, make_sphere(14, test::at(glm::vec3(16))), test::make_material({.sigma_s = glm::vec3(1)}));
    if (hollow) test::add_body(scene, make_sphere(5, test::at(glm::vec3(16))), test::make_material({}));
    const DiffusionMedium medium = make_diffusion_medium(voxelise(scene), 1);
    std::vector<float> q(medium.stride(), 0.0f);
    auto radius = [&](std::size_t i) { return glm::length(glm::vec3(test::voxel_of(medium, i)) + 0.5f - 16.0f); };
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = std::abs(radius(i) - 11) < 0.5f;
    const test::SteadyAnswer answer = test::solve_steady(medium, q);
    double inner = 0, outer = 0;
    int inner_count = 0, outer_count = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      if (radius(i) > 5.8f && radius(i) < 6.8f) inner += answer.fluence[i], ++inner_count;
      if (radius(i) > 9 && radius(i) < 10) outer += answer.fluence[i], ++outer_count;
    }
    ratio[hollow] = inner / inner_count / (outer / outer_count);
  }
  EXPECT_NEAR(ratio[0], 1, 0.01);
  EXPECT_NEAR(ratio[1], 1, 0.05);
}

TEST(PeriodicSeam, ABodyThatEndsThereLosesLightThroughItAsThroughItsOtherSide) {
  // A slab over half a period: vacuum lies on both of its sides, one of them across the seam.
  MediumDescription scene = test::empty_domain({8, 8, 32}, 1.0f, FaceBoundary::periodic);
  test::add_body(scene, make_box({40, 40, 16}, test::at({4, 4, 8})),
                 test::make_material({.sigma_s = glm::vec3(0.9f), .sigma_a = glm::vec3(0.1f)}));
  const DiffusionMedium medium = make_diffusion_medium(voxelise(scene), 1);
  std::vector<float> q(medium.stride(), 0.0f);
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = medium.region[i] >= 0;
  const test::SteadyAnswer answer = test::solve_steady(medium, q);
  double first = 0, last = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (test::voxel_of(medium, i) == glm::ivec3(4, 4, 0)) first = answer.fluence[i];
    if (test::voxel_of(medium, i) == glm::ivec3(4, 4, 15)) last = answer.fluence[i];
  }
  EXPECT_NEAR(first / last, 1, 1e-3);
}

}  // namespace
}  // namespace turbid
