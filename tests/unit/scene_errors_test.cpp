// SPDX-License-Identifier: Apache-2.0
// What the scene reader refuses: the exact place and words.
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

using test::ball_with;
using test::error_of;
using test::Folder;
using test::kBall;
using test::read_text;

TEST(SceneErrors, unknown_keys_are_named_with_the_nearest_known_one) {
  EXPECT_EQ(error_of(ball_with("radius = 10", "radios = 10")),
            "s.toml:10:1: radios = 10: unknown key (did you mean \"radius\"?); a sphere has name, shape, radius, "
            "material, scale, "
            "origin, rotate, translate, interface");
  EXPECT_BEGINS(error_of(std::string("seed = 3\n") + kBall),
                "s.toml:1:1: seed = 3: unknown key; a scene has unit, background");
  EXPECT_BEGINS(error_of(std::string(kBall) + "fovv = 3"),
                "s.toml:18:1: fovv = 3: unknown key (did you mean \"fov\"?)");
}

TEST(SceneErrors, repeated_keys_are_refused) {
  EXPECT_BEGINS(error_of(ball_with("eta = 1.4", "eta = 1.4\neta = 1.5")), "s.toml:6:");
  EXPECT_BEGINS(error_of(std::string(kBall) + "[camera]\n"), "s.toml:18:");
}

TEST(SceneErrors, missing_keys_are_named_with_their_table) {
  EXPECT_EQ(error_of(ball_with("radius = 10", "")), "s.toml:8:1: [[object]] lacks the key radius");
  EXPECT_EQ(error_of(ball_with("position = [0, 0, 60]", "")), "s.toml:16:1: [camera] lacks the key position");
  EXPECT_EQ(error_of(ball_with("shape = \"sphere\"\nradius = 10", "")),
            "s.toml:8:1: [[object]] lacks the key mesh or shape");
  EXPECT_EQ(error_of(ball_with("material = \"jade\"", "")), "s.toml:8:1: [[object]] lacks the key material");
  EXPECT_EQ(error_of(ball_with("type = \"point\"", "")), "s.toml:12:1: [[light]] lacks the key type");
}

TEST(SceneErrors, ill_typed_values_say_what_was_expected) {
  EXPECT_EQ(error_of(ball_with("resolution = 32", "resolution = 32.5")),
            "s.toml:3:14: resolution = 32.5: expected a whole number >= 8 [voxels]");
  EXPECT_EQ(error_of(ball_with("radius = 10", "radius = \"10\"")),
            "s.toml:10:10: radius = \"10\": expected a number > 0 [mm]");
  EXPECT_EQ(error_of(ball_with("[30, 0, 0]", "[30, 0]")), "s.toml:14:12: position = [30, 0]: expected [x, y, z] [mm]");
  EXPECT_EQ(error_of(ball_with("[30, 0, 0]", "[30, \"a\", 0]")),
            "s.toml:14:17: position[1] = \"a\": expected a number [mm]");
  EXPECT_EQ(error_of(ball_with("\"jade\"\n[[", "3\n[[")),
            "s.toml:11:12: material = 3: expected the name of a material in quotes");
  EXPECT_EQ(error_of(ball_with("eta = 1.4", "eta = [1, 1, 1]")),
            "s.toml:5:7: eta = [1, 1, 1]: expected a number in [1, 10], { expression = ... }, { field = ... } or { vdb "
            "= ... }");
  EXPECT_EQ(error_of(ball_with("[camera]", "[[camera]]")).substr(0, 12), "s.toml:16:1:");
  EXPECT_BEGINS(error_of(ball_with("[[light]]", "[light]")),
                "s.toml:12:1: [light]: expected a list of tables, [[light]]");
}

TEST(SceneErrors, values_out_of_range_say_the_range) {
  EXPECT_EQ(error_of(ball_with("sigma_a = 0.02", "sigma_a = -3")), "s.toml:7:11: sigma_a = -3: must be >= 0 [1/mm]");
  EXPECT_EQ(error_of(ball_with("1.4, 0.9", "-1.4, 0.9")), "s.toml:6:17: sigma_s[1] = -1.4: must be >= 0 [1/mm]");
  EXPECT_EQ(error_of(ball_with("eta = 1.4", "eta = 0.9")), "s.toml:5:7: eta = 0.9: must be in [1, 10]");
  EXPECT_EQ(error_of(ball_with("eta = 1.4", "eta = 1.4\ng = 1")), "s.toml:6:5: g = 1: must be in (-1, 1)");
  EXPECT_EQ(error_of(ball_with("power = 1", "power = 0")),
            "s.toml:15:9: power = 0: must be > 0 [W] in one colour at least");
  EXPECT_EQ(error_of(std::string(kBall) + "fov = 0"), "s.toml:18:7: fov = 0: must be in (0, 170] [degrees]");
  EXPECT_EQ(error_of(std::string(kBall) + "samples = 5"),
            "s.toml:18:11: samples = 5: must be a square number: 1, 4, 9, 16, ...");
}

TEST(SceneErrors, nan_and_infinity_are_refused) {
  EXPECT_EQ(error_of(ball_with("sigma_a = 0.02", "sigma_a = nan")),
            "s.toml:7:11: sigma_a = nan: must be a finite number >= 0 [1/mm]");
  EXPECT_EQ(error_of(ball_with("radius = 10", "radius = inf")),
            "s.toml:10:10: radius = inf: must be a finite number > 0 [mm]");
  EXPECT_BEGINS(error_of(ball_with("radius = 10", "radius = 1e300")),
                "s.toml:10:10: radius = 1e+300: must be a finite number");
}

TEST(SceneErrors, words_are_listed) {
  EXPECT_EQ(error_of(ball_with("\"sphere\"", "\"shpere\"")),
            "s.toml:9:9: shape = \"shpere\": expected \"sphere\", \"box\", \"cylinder\" (did you mean \"sphere\"?)");
  EXPECT_EQ(error_of(ball_with("\"jade\"\n[[", "\"jad\"\n[[")),
            "s.toml:11:12: material = \"jad\": no such material (did you mean \"jade\"?); there are \"jade\"");
}

TEST(SceneErrors, keys_of_another_kind_of_light_are_refused) {
  EXPECT_BEGINS(error_of(ball_with("power = 1", "power = 1\nangle = 3")),
                "s.toml:16:1: angle = 3: unknown key; a point light has");
}

TEST(SceneErrors, expressions_are_checked_when_read) {
  EXPECT_BEGINS(error_of(ball_with("sigma_a = 0.02", "sigma_a = { expression = \"2 + nois(x)\" }")),
                "s.toml:7:26: sigma_a: expression \"2 + nois(x)\", character 5: ");
  EXPECT_EQ(error_of(ball_with("sigma_a = 0.02", "sigma_a = { expression = \"1 - 2\" }")),
            "s.toml:7:11: sigma_a = { expression = \"1 - 2\" }: is -1.0 everywhere: must be >= 0 [1/mm]");
  EXPECT_BEGINS(error_of(ball_with("sigma_a = 0.02", "sigma_a = { expresion = \"1\" }")),
                "s.toml:7:13: expresion = \"1\": unknown key (did you mean \"expression\"?)");
  EXPECT_BEGINS(error_of(ball_with("eta = 1.4", "eta = { expression = [\"1\", \"2\", \"3\"] }")),
                "s.toml:5:22: expression = [");
}

TEST(SceneErrors, files_that_do_not_exist_are_named_with_their_full_path) {
  const std::string mesh = error_of(ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"none.obj\""));
  EXPECT_EQ(mesh, "s.toml:9:8: mesh = \"none.obj\": no such file, none.obj");
  EXPECT_HOLDS(error_of(ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"meshes/bunny.obj\"")),
               "; run scripts/setup, which fetches the meshes of the bundled scenes");
  EXPECT_BEGINS(error_of(ball_with("sigma_a = 0.02", "sigma_a = { vdb = \"v.vdb\" }")),
                "s.toml:7:19: vdb = \"v.vdb\": no such file");
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
  EXPECT_BEGINS(error_of(std::string(kBall) + "target = [0, 0, 60]"),
                "s.toml:17:12: position = [0, 0, 60]: must differ from target");
  EXPECT_BEGINS(error_of(std::string(kBall) + "up = [0, 0, 1]"),
                "s.toml:18:6: up = [0, 0, 1]: the camera looks along up");
}

TEST(SceneErrors, opaque_materials_have_no_coefficients_and_can_not_fill_the_domain) {
  EXPECT_BEGINS(error_of(ball_with("eta = 1.4", "opaque = 0.5")),
                "s.toml:6:1: sigma_s = [1.0, 1.4, 0.9]: unknown key; an opaque material has");
  EXPECT_BEGINS(
      error_of(ball_with("[material.jade]", "material = \"wall\"\n[material.wall]\nopaque = 1\n[material.jade]")),
      "s.toml:4:12: material = \"wall\": is opaque");
}

}  // namespace
}  // namespace turbid
