// SPDX-License-Identifier: Apache-2.0
// Changes of a scene on the command line.
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

using test::ball_with;
using test::error_of;
using test::kBall;
using test::read_text;
using test::with;

std::string error_with(const std::string& setting) {
  return error_of(kBall, with({setting}));
}

TEST(Overrides, replace_and_add_values) {
  const Scene scene = read_text(
      kBall, with({"camera.fov=20", "material.jade.sigma_s=[1,2,3]", "light.0.power=7", "camera.position.2=50",
                   "solver.name=lattice", "solver.march.max_steps=9", "film.exposure=1.5"}));
  EXPECT_FLOAT_EQ(scene.camera.fov, 20);
  EXPECT_EQ(scene.medium.materials[0].sigma_s->constant(), glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[0].power, glm::vec3(7));
  EXPECT_EQ(scene.camera.position, glm::vec3(0, 0, 50));
  EXPECT_EQ(scene.solver.solver, "lattice");
  EXPECT_EQ(scene.solver.march.max_steps, 9);
  EXPECT_FLOAT_EQ(*scene.film.exposure, 1.5f);
}

TEST(Overrides, the_last_one_wins_and_tables_are_replaced_whole) {
  EXPECT_FLOAT_EQ(read_text(kBall, with({"camera.fov=20", "camera.fov=40"})).camera.fov, 40);
  const Scene scene =
      read_text(kBall, with({"material.jade.sigma_a={expression=\"x\"}", "material.jade.sigma_a={expression=\"3\"}"}));
  EXPECT_EQ(scene.medium.materials[0].sigma_a->constant(), glm::vec3(3));
}

TEST(Overrides, voxel_size_and_resolution_replace_each_other) {
  EXPECT_FLOAT_EQ(read_text(kBall, with({"domain.voxel_size=0.5"})).medium.frame.voxel_size, 0.5f);
  SceneOverrides overrides;
  overrides.resolution = 64;
  EXPECT_EQ(read_text(ball_with("resolution = 32", "voxel_size = 1"), overrides).medium.frame.voxels, glm::ivec3(64));
}

TEST(Overrides, mistakes_name_the_option) {
  EXPECT_EQ(error_with("camera.fov=0"), "-D camera.fov=0: fov = 0: must be in (0, 170] [degrees]");
  EXPECT_BEGINS(error_with("camera.fow=3"), "-D camera.fow=3: fow = 3: unknown key (did you mean \"fov\"?)");
  EXPECT_BEGINS(error_with("camra.fov=3"),
                "-D camra.fov=3: camra = { fov = 3 }: unknown key (did you mean \"camera\"?)");
  EXPECT_EQ(error_with("light.1.power=3"),
            "-D light.1.power=3: light is a list of 1: expected an index from 0 to 0, not 1");
  EXPECT_EQ(error_with("camera.fov"), "-D camera.fov: expected key.sub=value, e.g. -D camera.fov=30");
  EXPECT_BEGINS(error_with("camera.fov=[1,"), "-D camera.fov=[1,: ");
  EXPECT_BEGINS(error_with("camera.position.0=a"), "-D camera.position.0=a: position[0] = \"a\": expected a number");
}

TEST(Overrides, of_the_command_lines_own_options_name_these) {
  SceneOverrides overrides;
  overrides.resolution = 0;
  EXPECT_EQ(error_of(kBall, overrides), "--resolution 0: resolution = 0: must be >= 8 [voxels]");
  overrides = {};
  overrides.solver = "magic";
  EXPECT_EQ(error_of(kBall, overrides), "--solver magic: name = \"magic\": expected \"steady\", \"lattice\", \"photon\"");
  overrides = {};
  overrides.seed = 42;
  EXPECT_EQ(read_text(kBall, overrides).solver.seed, 42u);
}

}  // namespace
}  // namespace turbid
