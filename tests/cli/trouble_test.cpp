// SPDX-License-Identifier: Apache-2.0
// Runs that can't end well: interrupted, disk full, out of balance, kernels missing; and the installed program.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/paths.h"
#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

using Words = std::vector<std::string>;

class Trouble : public testing::Test {
 protected:
  void SetUp() override { place.write("ball.toml", kMilkyBall); }
  const Workplace place;
};

TEST_F(Trouble, ctrl_c_ends_soon_says_what_was_finished_and_leaves_nothing) {
  // Large enough for every stage to be still at work when the signal comes.
  const Words large{
      "render",       "ball.toml", "-D", "camera.width=2048", "-D", "camera.height=2048", "-D", "camera.samples=16",
      "--resolution", "128"};
  for (const std::string finished : {"read", "lights", "march", "diffuse"}) {
    const Outcome outcome = place.turbid(large, {.interrupt_at = finished});
    EXPECT_EQ(outcome.status, 130) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    // "within a second or two" on two cores; tests run side by side, so twice that.
    EXPECT_LT(outcome.seconds_after_interrupt, 4.0) << "after " << finished;
    const Words lines = outcome.error_lines();
    ASSERT_FALSE(lines.empty());
    EXPECT_TRUE(lines.back().starts_with("turbid: stopped ")) << outcome.err;
    EXPECT_NE(lines.back().find("; finished: read"), std::string::npos) << outcome.err;
    EXPECT_EQ(place.content(), Words{"ball.toml"});
  }
}

TEST_F(Trouble, a_full_disk_is_one_line_and_leaves_nothing) {
  // PoCL's compiler writes files as well, so the limit must let those pass: pictures and grids here are larger.
  const RunSettings full{.largest_file = 4'000'000};
  const Outcome render = place.turbid(
      {"render", "ball.toml", "-q", "-o", "p", "-D", "camera.width=1200", "-D", "camera.height=1200"}, full);
  EXPECT_EQ(render.status, 2) << render.err;
  EXPECT_EQ(render.err, "turbid: p/ball.exr: cannot be written: File too large\n");
  const Outcome solve = place.turbid({"solve", "ball.toml", "-q", "-o", "f.vdb", "--resolution", "96"}, full);
  EXPECT_EQ(solve.status, 2) << solve.err;
  EXPECT_EQ(solve.error_lines().size(), 1u) << solve.err;
  EXPECT_NE(solve.err.find("f.vdb: can't be written: File too large"), std::string::npos) << solve.err;
  EXPECT_EQ(place.content(), Words{"ball.toml"});
}

TEST_F(Trouble, a_run_that_loses_energy_fails_but_keeps_its_files) {
  // One step of a solve that may end at 10 %: far from the steady state.
  const Outcome outcome = place.turbid(
      {"render", "ball.toml", "-q", "-o", "p", "-D", "solver.tolerance=0.1", "-D", "solver.steady.max_iterations=1"});
  EXPECT_EQ(outcome.status, 1);
  ASSERT_EQ(outcome.error_lines().size(), 2u) << outcome.err;
  EXPECT_TRUE(outcome.error_lines()[0].starts_with("warning: the solve ended after 1 iterations")) << outcome.err;
  EXPECT_TRUE(outcome.error_lines()[1].starts_with("turbid: the energy balance is off by ")) << outcome.err;
  EXPECT_EQ(place.content(), (Words{"ball.toml", "p/", "p/ball.exr", "p/ball.png", "p/report.json"}));
}

TEST_F(Trouble, kernels_that_are_missing_or_do_not_build_are_status_3) {
  const Outcome missing =
      place.turbid({"render", "ball.toml", "-q"}, {.environment = {{"TURBID_KERNEL_DIR", "/nonexistent"}}});
  EXPECT_EQ(missing.status, 3);
  EXPECT_EQ(missing.error_lines().size(), 1u) << missing.err;
  EXPECT_NE(missing.err.find("/nonexistent"), std::string::npos) << missing.err;
  EXPECT_EQ(place.content(), Words{"ball.toml"});
}

TEST_F(Trouble, the_installed_program_finds_its_own_kernels) {
  const Outcome install = place.run({cmake_binary(), "--install", build_folder(), "--prefix", place.path("usr")});
  ASSERT_EQ(install.status, 0) << install.err;
  const std::string program = place.path("usr/bin/turbid");
  const Words command{program, "render", "ball.toml", "-q", "-o", "p"};
  const Outcome render = place.run(command);
  EXPECT_EQ(render.status, 0) << render.err;
  EXPECT_TRUE(std::filesystem::exists(place.path("p/ball.exr")));
  // Kernels spoilt here and nowhere else: those are the ones it reads.
  std::ofstream(place.path("usr/share/turbid/kernels/view.cl"), std::ios::app) << "\nthis is no OpenCL\n";
  const Outcome spoilt = place.run(command);
  EXPECT_EQ(spoilt.status, 3);
  EXPECT_NE(spoilt.err.find("turbid: view.cl does not build"), std::string::npos) << spoilt.err;
}

}  // namespace
}  // namespace turbid::test
