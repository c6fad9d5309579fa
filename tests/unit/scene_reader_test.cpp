// SPDX-License-Identifier: Apache-2.0
// What the scene reader accepts, the effective scene and its hash, where objects stand.
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

using test::ball_with;
using test::Folder;
using test::kBall;
using test::read_text;
using test::with;

TEST(SceneReader, fills_in_what_a_short_scene_leaves_out) {
  const Scene scene = read_text(kBall);
  ASSERT_EQ(scene.medium.bodies.size(), 1u);
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.name, "s");
  EXPECT_EQ(scene.unit, "mm");
  EXPECT_TRUE(scene.has_camera);
  EXPECT_EQ(scene.medium.materials[0].sigma_s->constant(), glm::vec3(1.0f, 1.4f, 0.9f));
  EXPECT_EQ(scene.medium.materials[0].sigma_a->constant(), glm::vec3(0.02f));
  EXPECT_EQ(scene.medium.materials[0].emission->constant(), glm::vec3(0));
  EXPECT_EQ(scene.medium.ambient_material, -1);
  EXPECT_EQ(scene.medium.bodies[0].name, "sphere");
  EXPECT_EQ(scene.lights[0].name, "light 1");
  EXPECT_EQ(scene.solver.solver, "steady");
  EXPECT_FALSE(scene.film.exposure);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(SceneReader, reads_every_kind_of_light) {
  const Scene scene = read_text(std::string(kBall) + R"(
[[light]]
type = "spot"
position = [0, 30, 0]
target = [0, 10, 0]
angle = 20
power = [1, 2, 3]
[[light]]
type = "directional"
direction = [0, 0, -4]
irradiance = 2
)");
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[1].kind, LightKind::spot);
  EXPECT_EQ(scene.lights[1].direction, glm::vec3(0, -1, 0));
  EXPECT_EQ(scene.lights[1].power, glm::vec3(1, 2, 3));
  EXPECT_EQ(scene.lights[2].kind, LightKind::directional);
  EXPECT_EQ(scene.lights[2].direction, glm::vec3(0, 0, -1));
  EXPECT_EQ(scene.lights[2].irradiance, glm::vec3(2));
}

TEST(SceneReader, tolerance_of_the_solver_is_that_of_each_solver_unless_it_has_its_own) {
  const Scene scene = read_text(std::string(kBall) + "[solver]\ntolerance = 1e-3\n[solver.steady]\ntolerance = 1e-5\n");
  EXPECT_FLOAT_EQ(scene.solver.lattice.tolerance, 1e-3f);
  EXPECT_FLOAT_EQ(scene.solver.steady.tolerance, 1e-5f);
}

TEST(SceneReader, bounds_of_settings_belong_to_their_ranges) {
  const Scene scene = read_text(
      std::string(kBall) + "[solver]\ntolerance = 0.1\n[solver.march]\nmin_power = 0.1\n[view]\nmin_weight = 0.1\n");
  EXPECT_FLOAT_EQ(scene.solver.steady.tolerance, 0.1f);
  EXPECT_NO_THROW(read_text(std::string(kBall) + "[solver]\ntolerance = 1e-6\n"));
}

// Round trip and hash.

constexpr char kRich[] = R"toml(unit = "cm"
background = [0.1, 0.2, 0.3]
[domain]
voxel_size = 0.37
min = [-10, -12, -14]
max = [10, 12, 14]
boundary = { x = "open", y_min = "mirror" }
material = "fog"
smoothing = 1.5
[material.fog]
sigma_s = { expression = ["0.01*x*x", "0.02", "0.1 + 0.05*noise(x, y, z)"] }
[material."wall paint"]
opaque = [0.1, 0.2, 0.3]
checker = { colour = 0.7, size = 0.3 }
[material.lens]
eta = { field = "luneburg", radius = 5, centre = [1, 0, 0] }
g = -0.3
[[object]]
name = "a \"quoted\" name"
shape = "box"
size = [1, 2, 0.1]
rotate = [10, 20, 30]
translate = [-8, 0, 0]
scale = 0.333
material = "wall paint"
[[object]]
shape = "cylinder"
radius = 4
height = 3
origin = "base"
interface = "smooth"
material = "lens"
[[light]]
type = "directional"
direction = [1, -2, 3]
irradiance = [1, 0.1, 0.0001]
[camera]
position = [0, 0, 60]
up = [0.1, 1, 0]
[ground]
height = -12
[film]
exposure = -0.7
[solver]
seed = 17
tolerance = 3e-4
)toml";

TEST(EffectiveScene, reads_back_as_the_same_scene) {
  for (const char* text : {kBall, kRich}) {
    const Scene first = read_text(text);
    const Scene second = read_text(first.effective_toml);
    EXPECT_EQ(first.effective_toml, second.effective_toml);
    EXPECT_EQ(first.hash, second.hash);
    EXPECT_EQ(first.hash.size(), 16u);
    EXPECT_EQ(first.medium.frame.voxels, second.medium.frame.voxels);
    EXPECT_EQ(first.medium.frame.origin, second.medium.frame.origin);
  }
}

TEST(EffectiveScene, hash_follows_what_matters_and_nothing_else) {
  const std::string hash = read_text(kBall).hash;
  EXPECT_EQ(read_text(std::string("# a comment\n") + kBall).hash, hash);
  EXPECT_EQ(read_text(ball_with("radius = 10", "radius = 10.0")).hash, hash);
  EXPECT_EQ(read_text(kBall, with({"camera.fov=35"})).hash, hash);
  EXPECT_NE(read_text(ball_with("radius = 10", "radius = 11")).hash, hash);
  EXPECT_NE(read_text(kBall, with({"solver.seed=1"})).hash, hash);
}

constexpr char kTetrahedron[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST(EffectiveScene, hash_follows_the_content_of_files_not_their_place) {
  const std::string text = ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"t.obj\"\nscale = 10");
  const Folder a, b;
  a.write("t.obj", kTetrahedron);
  b.write("t.obj", kTetrahedron);
  const std::string hash = read_scene(a.write("s.toml", text)).hash;
  EXPECT_EQ(read_scene(b.write("s.toml", text)).hash, hash);
  b.write("t.obj", std::string(kTetrahedron) + "# moved\n");
  EXPECT_NE(read_scene(b.file("s.toml")).hash, hash);
}

// Where objects stand.

TEST(Objects, centre_and_base_put_the_bounding_box_at_the_origin) {
  const Folder folder;
  folder.write("t.obj", kTetrahedron);
  const auto box_with = [&](const std::string& keys) {
    return bounds(
        read_scene(folder.write("s.toml", ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"t.obj\"\n" + keys)))
            .medium.bodies[0]
            .solid.mesh);
  };
  const auto expect_near = [](glm::vec3 a, glm::vec3 b) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f);
  };
  expect_near(box_with("").lower, {0, 0, 0});
  expect_near(box_with("origin = \"centre\"\nscale = 4").lower, {-2, -2, -2});
  expect_near(box_with("origin = \"base\"\nfit = 8").lower, {-4, 0, -4});
  expect_near(box_with("origin = \"base\"\nfit = 8\ntranslate = [0, 3, 1]").lower, {-4, 3, -3});
  EXPECT_NEAR(box_with("origin = \"base\"\nfit = 8\nrotate = [35, 20, 120]").lower.y, 0.0f, 1e-5f);
  expect_near(box_with("rotate = [0, 0, 90]").lower, {-1, 0, 0});
  expect_near(box_with("rotate = [90, 0, 90]").upper, {1, 1, 1});  // x first: (x, y, z) -> (z, x, y)
}

TEST(Objects, a_shape_can_stand_on_the_ground) {
  const Scene scene = read_text(ball_with("radius = 10", "radius = 10\norigin = \"base\"\ntranslate = [0, 2, 0]"));
  EXPECT_NEAR(bounds(scene.medium.bodies[0].solid.mesh).lower.y, 2.0f, 1e-4f);
  EXPECT_NEAR(scene.medium.bodies[0].solid.signed_distance({0, 12, 0}), -10.0f, 1e-4f);
}

TEST(Objects, materials_that_nothing_uses_are_pointed_out) {
  const Scene scene = read_text(std::string(kBall) + "[material.spare]\n");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_HOLDS(scene.warnings[0], "material \"spare\" is not used");
}

}  // namespace
}  // namespace turbid
