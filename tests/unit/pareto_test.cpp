// SPDX-License-Identifier: Apache-2.0
// Which settings are worth using, and which meet an asked error.
#include "host/study/pareto.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/base/errors.h"
#include "host/study/choose_settings.h"
#include "host/study/photon_reference.h"
#include "host/study/refine_scene.h"

namespace turbid {
namespace {

SettingRun measured(double error, double seconds) {
  SettingRun run;
  run.error = error;
  run.seconds = seconds;
  return run;
}

TEST(Pareto, only_runs_that_no_other_beats_in_both_speed_and_error_are_worth_using) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<SettingRun> runs{measured(0.1, 1),   measured(0.05, 2),  measured(0.06, 3), measured(0.01, 10),
                               measured(0.01, 20), measured(nan, 0.1), measured(0.05, 2)};
  mark_efficient(runs);
  const std::vector<bool> expected{true, true, false, true, false, false, true};
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i].efficient, expected[i]) << i;
}

TEST(Pareto, one_per_cent_of_an_error_is_not_worth_time) {
  std::vector<SettingRun> runs{measured(0.1, 1), measured(0.0995, 2), measured(0.09, 3), measured(0.1, 1.5)};
  mark_efficient(runs);
  const std::vector<bool> expected{true, false, true, false};
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i].efficient, expected[i]) << i;
}

TEST(Pareto, the_fastest_run_within_the_aim_is_recommended) {
  const std::vector<SettingRun> runs{measured(0.1, 1), measured(0.04, 5), measured(0.045, 3), measured(0.01, 10)};
  EXPECT_EQ(recommended(runs, 0.05), 2u);
  EXPECT_EQ(recommended(runs, 0.01), 3u);
  EXPECT_FALSE(recommended(runs, 0.005));
}

TEST(Pareto, a_photon_run_to_half_the_error_takes_four_times_as_long) {
  EXPECT_DOUBLE_EQ(photon_seconds(0.02, 3, 0.01), 12);
}

TEST(ChooseSettings, meet_the_aim_by_the_scaling_of_each_part) {
  const ErrorParts at{.grid = 0.1, .steps = 0.004, .rays = 0.01, .solve = 1e-4, .model = 0.01};
  const ChosenSettings chosen = choose_settings(at, 30, {64, 0.5f, 4, 1e-4f}, 0.1);
  EXPECT_FALSE(chosen.photon);
  EXPECT_LE(chosen.predicted.total(), 0.1);
  // No finer than needed: grid 0.1 -> 0.045 at order 1.5 asks for 64 (0.1/0.045)^(2/3) = 109 voxels, in whole blocks.
  EXPECT_EQ(chosen.with.voxels, 112);
}

TEST(ChooseSettings, cost_less_where_less_is_asked_for) {
  const ErrorParts at{.grid = 0.05, .steps = 0.01, .rays = 0.02, .solve = 1e-4, .model = 0.01};
  const ChosenSettings loose = choose_settings(at, 30, {64, 0.5f, 4, 1e-4f}, 0.3),
                       tight = choose_settings(at, 30, {64, 0.5f, 4, 1e-4f}, 0.05);
  EXPECT_LT(loose.with.voxels, tight.with.voxels);
  EXPECT_LT(loose.with.rays, tight.with.rays);
  EXPECT_GT(loose.with.step, tight.with.step);
  EXPECT_GT(loose.with.tolerance, tight.with.tolerance);
}

TEST(ChooseSettings, are_photons_where_diffusion_itself_is_too_wrong) {
  const ErrorParts at{.grid = 0.01, .steps = 0.001, .rays = 0.001, .solve = 1e-4, .model = 0.12};
  EXPECT_TRUE(choose_settings(at, 30, {64, 0.5f, 4, 1e-4f}, 0.02).photon);
  EXPECT_FALSE(choose_settings(at, 30, {64, 0.5f, 4, 1e-4f}, 0.3).photon);
  // Half the aim is theirs: 30 / sqrt(photons) = 0.01 where voxels stay as large.
  const ChosenSettings chosen = choose_settings(at, 30, {64, 0.5f, 4, 1e-4f}, 0.02);
  EXPECT_NEAR(chosen.photons, 9e6 * std::pow(chosen.with.voxels / 64.0, 2), 1);
}

TEST(ReferenceErrors, take_the_scatter_of_the_reference_out) {
  // x is 10 % too large; a and b scatter by 1 with opposite signs, uncorrelated with each other over the list.
  std::vector<float> x, a, b;
  for (int i = 0; i < 4000; ++i) {
    x.push_back(11);
    a.push_back(i % 2 ? 11.0f : 9.0f);
    b.push_back(i / 2 % 2 ? 11.0f : 9.0f);
  }
  const ReferenceErrors errors = errors_against(x, a, b);
  EXPECT_NEAR(errors.rel_l2, 0.1, 1e-6);
  // The mean of both scatters by 1 / sqrt(2) of 10.
  EXPECT_NEAR(errors.noise, 0.1 / std::sqrt(2.0), 1e-6);
}

TEST(RefineLevels, must_run_from_coarse_to_fine) {
  EXPECT_NO_THROW(check_levels(find_scene_parameter("voxel_size"), {16, 32, 64}));
  EXPECT_NO_THROW(check_levels(find_scene_parameter("step"), {1, 0.5}));
  EXPECT_THROW(check_levels(find_scene_parameter("voxel_size"), {64, 32}), InputError);
  EXPECT_THROW(check_levels(find_scene_parameter("step"), {0.5, 1}), InputError);
  EXPECT_THROW(check_levels(find_scene_parameter("rays"), {4}), InputError);
  EXPECT_THROW(check_levels(find_scene_parameter("tolerance"), {1, 0.1}), InputError);
  EXPECT_THROW(find_scene_parameter("colour"), InputError);
}

}  // namespace
}  // namespace turbid
