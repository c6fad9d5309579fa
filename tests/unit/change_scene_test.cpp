// SPDX-License-Identifier: Apache-2.0
// change_scene(): keys of a scene changed after it was read.
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid::test {
namespace {

std::string refusal(const Scene& scene, const std::vector<std::string>& settings) {
  try {
    change_scene(scene, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(ChangeScene, is_the_scene_that_reading_with_the_same_settings_gives) {
  const Folder folder;
  const std::string path =
      folder.write("s.toml", ball_with("sigma_a = 0.02", "sigma_a = { expression = \"0.1 + 0.01*x\" }") +
                                 "[ground]\nheight = -12\n");
  const Scene scene = read_scene(path);
  for (const std::vector<std::string>& settings :
       std::vector<std::vector<std::string>>{{},
                                             {"camera.position=[10, 20, 30]", "camera.target=[1, 2, 3]"},
                                             {"light.0.power=[1, 2, 3]"},
                                             {"material.jade.sigma_a.scale=2.5"},
                                             {"material.jade.sigma_s=[2, 2.1, 2.2]", "material.jade.g=0.3"},
                                             {"film.exposure=3.5"},
                                             {"ground.colour=0.1", "background=0.25"},
                                             {"view.max_branches=3"}}) {
    const Scene changed = change_scene(scene, settings), read = read_scene(path, with(settings));
    EXPECT_EQ(changed.effective_toml, read.effective_toml);
    EXPECT_EQ(changed.hash, read.hash);
    EXPECT_EQ(changed.lights.size(), 1u);
    EXPECT_EQ(changed.lights[0].power, read.lights[0].power);
    EXPECT_EQ(changed.camera.position, read.camera.position);
    EXPECT_EQ(changed.film.exposure, read.film.exposure);
    EXPECT_EQ(changed.surroundings.background, read.surroundings.background);
    EXPECT_EQ(changed.medium.materials[0].sigma_s->constant(), read.medium.materials[0].sigma_s->constant());
    EXPECT_EQ(changed.medium.frame.origin, read.medium.frame.origin);
  }
}

TEST(ChangeScene, changes_add_up_and_keep_the_fields_that_stayed) {
  const Scene scene = read_text(ball_with("sigma_a = 0.02", "sigma_a = { expression = \"0.1 + 0.01*x\" }"));
  const Scene once = change_scene(scene, {"material.jade.sigma_s=3"});
  const Scene twice = change_scene(once, {"camera.fov=20"});
  EXPECT_EQ(twice.medium.materials[0].sigma_s, once.medium.materials[0].sigma_s);
  EXPECT_EQ(twice.medium.materials[0].sigma_a, scene.medium.materials[0].sigma_a);
  EXPECT_NE(once.medium.materials[0].sigma_s, scene.medium.materials[0].sigma_s);
  EXPECT_EQ(twice.camera.fov, 20.0f);
}

TEST(ChangeScene, refuses_what_it_cannot_change_and_values_out_of_range) {
  const Scene scene = read_text(kBall);
  for (const char* setting : {"domain.resolution=64", "object.0.radius=3", "unit=\"cm\"", "solver.tolerance=1e-3"})
    EXPECT_HOLDS(refusal(scene, {setting}), "can't be changed while the scene is shown") << setting;
  EXPECT_HOLDS(refusal(scene, {"material.gold.eta=2"}), "there is no material \"gold\"");
  EXPECT_BEGINS(refusal(scene, {"camera.fov=200"}), "-D camera.fov=200: fov = 200: must be in (0, 170]");
  EXPECT_HOLDS(refusal(scene, {"light.3.power=1"}), "expected an index from 0 to 0");
  EXPECT_HOLDS(refusal(scene, {"light.0.power=-1"}), "must be >= 0");
  EXPECT_HOLDS(refusal(scene, {"material.jade.sigma_s=nan"}), "must be");
  EXPECT_HOLDS(refusal(scene, {"camera.colour=1"}), "unknown key");
  EXPECT_HOLDS(refusal(scene, {"nonsense"}), "expected key.sub=value");
}

}  // namespace
}  // namespace turbid::test
