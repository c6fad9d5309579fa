// SPDX-License-Identifier: Apache-2.0
// The scene reader: what it accepts, and the exact words and places of what it refuses.
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

using test::error_of;
using test::Folder;
using test::read_text;

constexpr char kBall[] = R"(unit = "mm"
[domain]
resolution = 32
[material.jade]
eta = 1.4
sigma_s = [1.0, 1.4, 0.9]
sigma_a = 0.02
[[object]]
shape = "sphere"
radius = 10
material = "jade"
[[light]]
type = "point"
position = [30, 0, 0]
power = 1
[camera]
position = [0, 0, 60]
)";

std::string ball_with(const std::string& old, const std::string& replacement) {
  std::string text = kBall;
  text.replace(text.find(old), old.size(), replacement);
  return text;
}

SceneOverrides with(std::vector<std::string> settings) {
  SceneOverrides overrides;
  overrides.settings = std::move(settings);
  return overrides;
}

std::string error_with(const std::string& setting) { return error_of(kBall, with({setting})); }

#define EXPECT_BEGINS(text, start) EXPECT_EQ((text).substr(0, std::string(start).size()), start) << (text)
#define EXPECT_HOLDS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

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
  const Scene scene = read_text(std::string(kBall) + "[solver]\ntolerance = 0.1\n[solver.march]\nmin_power = 0.1\n[view]\nmin_weight = 0.1\n");
  EXPECT_FLOAT_EQ(scene.solver.steady.tolerance, 0.1f);
  EXPECT_NO_THROW(read_text(std::string(kBall) + "[solver]\ntolerance = 1e-6\n"));
}

// Places and words of errors.

TEST(SceneErrors, unknown_keys_are_named_with_the_nearest_known_one) {
  EXPECT_EQ(error_of(ball_with("radius = 10", "radios = 10")),
            "s.toml:10:1: radios = 10: unknown key (did you mean \"radius\"?); a sphere has name, shape, radius, material, scale, "
            "origin, rotate, translate, interface");
  EXPECT_BEGINS(error_of(std::string("seed = 3\n") + kBall), "s.toml:1:1: seed = 3: unknown key; a scene has unit, background");
  EXPECT_BEGINS(error_of(std::string(kBall) + "fovv = 3"), "s.toml:18:1: fovv = 3: unknown key (did you mean \"fov\"?)");
}

TEST(SceneErrors, repeated_keys_are_refused) {
  EXPECT_BEGINS(error_of(ball_with("eta = 1.4", "eta = 1.4\neta = 1.5")), "s.toml:6:");
  EXPECT_BEGINS(error_of(std::string(kBall) + "[camera]\n"), "s.toml:18:");
}

TEST(SceneErrors, missing_keys_are_named_with_their_table) {
  EXPECT_EQ(error_of(ball_with("radius = 10", "")), "s.toml:8:1: [[object]] lacks the key radius");
  EXPECT_EQ(error_of(ball_with("position = [0, 0, 60]", "")), "s.toml:16:1: [camera] lacks the key position");
  EXPECT_EQ(error_of(ball_with("shape = \"sphere\"\nradius = 10", "")), "s.toml:8:1: [[object]] lacks the key mesh or shape");
  EXPECT_EQ(error_of(ball_with("material = \"jade\"", "")), "s.toml:8:1: [[object]] lacks the key material");
  EXPECT_EQ(error_of(ball_with("type = \"point\"", "")), "s.toml:12:1: [[light]] lacks the key type");
}

TEST(SceneErrors, ill_typed_values_say_what_was_expected) {
  EXPECT_EQ(error_of(ball_with("resolution = 32", "resolution = 32.5")),
            "s.toml:3:14: resolution = 32.5: expected a whole number >= 8 [voxels]");
  EXPECT_EQ(error_of(ball_with("radius = 10", "radius = \"10\"")), "s.toml:10:10: radius = \"10\": expected a number > 0 [mm]");
  EXPECT_EQ(error_of(ball_with("[30, 0, 0]", "[30, 0]")), "s.toml:14:12: position = [30, 0]: expected [x, y, z] [mm]");
  EXPECT_EQ(error_of(ball_with("[30, 0, 0]", "[30, \"a\", 0]")), "s.toml:14:17: position[1] = \"a\": expected a number [mm]");
  EXPECT_EQ(error_of(ball_with("\"jade\"\n[[", "3\n[[")), "s.toml:11:12: material = 3: expected the name of a material in quotes");
  EXPECT_EQ(error_of(ball_with("eta = 1.4", "eta = [1, 1, 1]")),
            "s.toml:5:7: eta = [1, 1, 1]: expected a number in [1, 10], { expression = ... }, { field = ... } or { vdb = ... }");
  EXPECT_EQ(error_of(ball_with("[camera]", "[[camera]]")).substr(0, 12), "s.toml:16:1:");
  EXPECT_BEGINS(error_of(ball_with("[[light]]", "[light]")), "s.toml:12:1: [light]: expected a list of tables, [[light]]");
}

TEST(SceneErrors, values_out_of_range_say_the_range) {
  EXPECT_EQ(error_of(ball_with("sigma_a = 0.02", "sigma_a = -3")), "s.toml:7:11: sigma_a = -3: must be >= 0 [1/mm]");
  EXPECT_EQ(error_of(ball_with("1.4, 0.9", "-1.4, 0.9")), "s.toml:6:17: sigma_s[1] = -1.4: must be >= 0 [1/mm]");
  EXPECT_EQ(error_of(ball_with("eta = 1.4", "eta = 0.9")), "s.toml:5:7: eta = 0.9: must be in [1, 10]");
  EXPECT_EQ(error_of(ball_with("eta = 1.4", "eta = 1.4\ng = 1")), "s.toml:6:5: g = 1: must be in (-1, 1)");
  EXPECT_EQ(error_of(ball_with("power = 1", "power = 0")), "s.toml:15:9: power = 0: must be > 0 [W] in one colour at least");
  EXPECT_EQ(error_of(std::string(kBall) + "fov = 0"), "s.toml:18:7: fov = 0: must be in (0, 170] [degrees]");
  EXPECT_EQ(error_of(std::string(kBall) + "samples = 5"), "s.toml:18:11: samples = 5: must be a square number: 1, 4, 9, 16, ...");
}

TEST(SceneErrors, nan_and_infinity_are_refused) {
  EXPECT_EQ(error_of(ball_with("sigma_a = 0.02", "sigma_a = nan")), "s.toml:7:11: sigma_a = nan: must be a finite number >= 0 [1/mm]");
  EXPECT_EQ(error_of(ball_with("radius = 10", "radius = inf")), "s.toml:10:10: radius = inf: must be a finite number > 0 [mm]");
  EXPECT_BEGINS(error_of(ball_with("radius = 10", "radius = 1e300")), "s.toml:10:10: radius = 1e+300: must be a finite number");
}

TEST(SceneErrors, words_are_listed) {
  EXPECT_EQ(error_of(ball_with("\"sphere\"", "\"shpere\"")),
            "s.toml:9:9: shape = \"shpere\": expected \"sphere\", \"box\", \"cylinder\" (did you mean \"sphere\"?)");
  EXPECT_EQ(error_of(ball_with("\"jade\"\n[[", "\"jad\"\n[[")),
            "s.toml:11:12: material = \"jad\": no such material (did you mean \"jade\"?); there are \"jade\"");
}

TEST(SceneErrors, keys_of_another_kind_of_light_are_refused) {
  EXPECT_BEGINS(error_of(ball_with("power = 1", "power = 1\nangle = 3")), "s.toml:16:1: angle = 3: unknown key; a point light has");
}

TEST(SceneErrors, expressions_are_checked_when_read) {
  EXPECT_BEGINS(error_of(ball_with("sigma_a = 0.02", "sigma_a = { expression = \"2 + nois(x)\" }")),
                "s.toml:7:26: sigma_a: expression \"2 + nois(x)\", character 5: ");
  EXPECT_EQ(error_of(ball_with("sigma_a = 0.02", "sigma_a = { expression = \"1 - 2\" }")),
            "s.toml:7:11: sigma_a = { expression = \"1 - 2\" }: is -1.0 everywhere: must be >= 0 [1/mm]");
  EXPECT_BEGINS(error_of(ball_with("sigma_a = 0.02", "sigma_a = { expresion = \"1\" }")),
                "s.toml:7:13: expresion = \"1\": unknown key (did you mean \"expression\"?)");
  EXPECT_BEGINS(error_of(ball_with("eta = 1.4", "eta = { expression = [\"1\", \"2\", \"3\"] }")), "s.toml:5:22: expression = [");
}

TEST(SceneErrors, files_that_do_not_exist_are_named_with_their_full_path) {
  const std::string mesh = error_of(ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"none.obj\""));
  EXPECT_EQ(mesh, "s.toml:9:8: mesh = \"none.obj\": no such file, none.obj");
  EXPECT_HOLDS(error_of(ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"meshes/bunny.obj\"")),
               "; run scripts/setup, which fetches the meshes of the bundled scenes");
  EXPECT_BEGINS(error_of(ball_with("sigma_a = 0.02", "sigma_a = { vdb = \"v.vdb\" }")), "s.toml:7:19: vdb = \"v.vdb\": no such file");
}

TEST(SceneErrors, a_file_that_is_no_mesh_is_refused_at_its_key) {
  const Folder folder;
  folder.write("text.obj", "this is no mesh\n");
  const std::string path = folder.write("s.toml", ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"text.obj\""));
  try {
    read_scene(path);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_HOLDS(std::string(error.what()), "s.toml:9:8: mesh: ");
  }
}

TEST(SceneErrors, syntax_errors_have_their_place) {
  EXPECT_BEGINS(error_of("unit = \"mm\"\n[domain\n"), "s.toml:2:8: ");
  EXPECT_BEGINS(error_of("unit = mm\n"), "s.toml:1:8: ");
}

TEST(SceneErrors, a_scene_file_must_exist_and_be_a_file) {
  const Folder folder;
  for (const std::string& name : {std::string("none.toml"), std::string(".")}) {
    try {
      read_scene(folder.file(name));
      FAIL();
    } catch (const InputError& error) {
      EXPECT_HOLDS(std::string(error.what()), name == "." ? "is a folder" : "no such file");
    }
  }
}

TEST(SceneErrors, a_scene_needs_something_to_see_and_light_to_see_it_by) {
  const std::string text = kBall;
  const std::string unlit = text.substr(0, text.find("[[light]]"));
  EXPECT_HOLDS(error_of(unlit + "[camera]\nposition = [0, 0, 60]\n"), "has a camera but no light");
  EXPECT_EQ(error_of(unlit), "no error");
  EXPECT_FALSE(read_text(unlit).has_camera);
  const std::string glowing = ball_with("sigma_a = 0.02", "emission = 1");
  EXPECT_EQ(error_of(glowing.substr(0, glowing.find("[[light]]")) + "[camera]\nposition = [0, 0, 60]\n"), "no error");
  EXPECT_HOLDS(error_of("[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n"), "holds nothing that light could meet");
}

TEST(SceneErrors, camera_and_target_must_differ_and_up_must_not_point_along_the_view) {
  EXPECT_BEGINS(error_of(std::string(kBall) + "target = [0, 0, 60]"), "s.toml:17:12: position = [0, 0, 60]: must differ from target");
  EXPECT_BEGINS(error_of(std::string(kBall) + "up = [0, 0, 1]"), "s.toml:18:6: up = [0, 0, 1]: the camera looks along up");
}

TEST(SceneErrors, opaque_materials_have_no_coefficients_and_can_not_fill_the_domain) {
  EXPECT_BEGINS(error_of(ball_with("eta = 1.4", "opaque = 0.5")), "s.toml:6:1: sigma_s = [1.0, 1.4, 0.9]: unknown key; an opaque material has");
  EXPECT_BEGINS(error_of(ball_with("[material.jade]", "material = \"wall\"\n[material.wall]\nopaque = 1\n[material.jade]")),
                "s.toml:4:12: material = \"wall\": is opaque");
}

// Overrides.

TEST(Overrides, replace_and_add_values) {
  const Scene scene = read_text(kBall, with({"camera.fov=20", "material.jade.sigma_s=[1,2,3]", "light.0.power=7", "camera.position.2=50",
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
  const Scene scene = read_text(kBall, with({"material.jade.sigma_a={expression=\"x\"}", "material.jade.sigma_a={expression=\"3\"}"}));
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
  EXPECT_BEGINS(error_with("camra.fov=3"), "-D camra.fov=3: camra = { fov = 3 }: unknown key (did you mean \"camera\"?)");
  EXPECT_EQ(error_with("light.1.power=3"), "-D light.1.power=3: light is a list of 1: expected an index from 0 to 0, not 1");
  EXPECT_EQ(error_with("camera.fov"), "-D camera.fov: expected key.sub=value, e.g. -D camera.fov=30");
  EXPECT_BEGINS(error_with("camera.fov=[1,"), "-D camera.fov=[1,: ");
  EXPECT_BEGINS(error_with("camera.position.0=a"), "-D camera.position.0=a: position[0] = \"a\": expected a number");
}

TEST(Overrides, of_the_command_lines_own_options_name_these) {
  SceneOverrides overrides;
  overrides.resolution = 0;
  EXPECT_EQ(error_of(kBall, overrides), "--resolution 0: resolution = 0: must be >= 8 [voxels]");
  overrides = {};
  overrides.solver = "photon";
  EXPECT_EQ(error_of(kBall, overrides), "--solver photon: name = \"photon\": expected \"steady\", \"lattice\"");
  overrides = {};
  overrides.seed = 42;
  EXPECT_EQ(read_text(kBall, overrides).solver.seed, 42u);
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
    return bounds(read_scene(folder.write("s.toml", ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"t.obj\"\n" + keys)))
                      .medium.bodies[0].solid.mesh);
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
