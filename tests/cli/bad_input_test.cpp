// SPDX-License-Identifier: Apache-2.0
// Wrong scenes, files and places: one clear line, status 2, nothing written. Meshes' own faults are unit tests.
#include <gtest/gtest.h>

#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

using Words = std::vector<std::string>;

/// Status 2, and standard error holds one line besides those of finished stages, which holds the words.
void expect_refused(const Outcome& outcome, const Words& words) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  const Words lines = outcome.error_lines();
  ASSERT_EQ(lines.size(), 1u) << outcome.err;
  EXPECT_TRUE(lines.back().starts_with("turbid: ")) << outcome.err;
  for (const std::string& word : words)
    EXPECT_NE(lines.back().find(word), std::string::npos) << "no \"" << word << "\" in " << outcome.err;
}

/// Renders a scene that must be refused, beside the files that the place holds already.
void expect_scene_refused(const Workplace& place, const std::string& scene, const Words& words,
                          const Words& more = {}) {
  place.write("s.toml", scene);
  const Words before = place.content();
  Words arguments{"render", "s.toml", "-q", "-o", "pictures"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  expect_refused(place.turbid(arguments), words);
  EXPECT_EQ(place.content(), before);
}

std::string with_mesh(const std::string& file) {
  return milky_ball_with("shape = \"sphere\"\nradius = 10", "mesh = \"" + file + "\"");
}
std::string with_grid(const std::string& what) {
  return milky_ball_with("sigma_s = [1.0, 1.2, 1.5]", "sigma_s = { vdb = " + what + " }");
}

TEST(BadInput, a_scene_that_is_not_there) {
  const Workplace place;
  expect_refused(place.turbid({"render", "nowhere.toml"}), {"nowhere.toml: no such file"});
  EXPECT_EQ(place.content(), Words{});
}

TEST(BadInput, a_folder_for_a_scene) {
  const Workplace place;
  expect_refused(place.turbid({"check", "."}), {"is a folder"});
}

TEST(BadInput, a_scene_that_is_not_toml) {
  expect_scene_refused(Workplace(), "unit = \"mm\"\n[domain\n", {"s.toml:2:"});
}

TEST(BadInput, a_misspelt_key) {
  expect_scene_refused(Workplace(), milky_ball_with("radius", "radios"),
                       {"s.toml:10:1: radios = 10: unknown key", "radius"});
}

TEST(BadInput, a_scene_without_a_camera_can_be_solved_but_not_rendered) {
  const Workplace place;
  const std::string scene = kMilkyBall.substr(0, kMilkyBall.find("[camera]"));
  expect_scene_refused(place, scene, {"s.toml: has no [camera]", "turbid solve"});
  EXPECT_EQ(place.turbid({"solve", "s.toml", "-q"}).status, 0);
}

TEST(BadInput, a_storage_that_there_is_not) {
  const std::string scene = kMilkyBall + "[solver]\nname = \"lattice\"\nstorage = \"double\"\n";
  expect_scene_refused(Workplace(), scene, {"s.toml:", "storage = \"double\"", "\"float\"", "\"half\""});
}

TEST(BadInput, a_mesh_that_is_not_there) {
  expect_scene_refused(Workplace(), with_mesh("nowhere.obj"), {"s.toml:9:8: mesh = \"nowhere.obj\": no such file"});
}

TEST(BadInput, a_text_for_a_mesh) {
  const Workplace place;
  place.write("letter.obj", "Dear reader,\n");
  expect_scene_refused(place, with_mesh("letter.obj"), {"s.toml:9:8", "letter.obj"});
}

TEST(BadInput, an_empty_mesh) {
  const Workplace place;
  place.write("empty.off", "OFF\n0 0 0\n");
  expect_scene_refused(place, with_mesh("empty.off"), {"s.toml:9:8", "empty.off"});
}

TEST(BadInput, an_open_mesh) {
  const Workplace place;
  place.write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  expect_scene_refused(place, with_mesh("open.obj"), {"s.toml:9:8", "open.obj"});
}

TEST(BadInput, a_mesh_with_a_corner_that_is_no_number) {
  const Workplace place;
  place.write("nan.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  expect_scene_refused(place, with_mesh("nan.obj"), {"s.toml:9:8", "nan.obj"});
}

TEST(BadInput, an_object_outside_the_domain) {
  expect_scene_refused(
      Workplace(), milky_ball_with("resolution = 24", "resolution = 24\nmin = [100, 100, 100]\nmax = [120, 120, 120]"),
      {"s.toml:10:1: object \"sphere\"", "outside the domain"});
}

TEST(BadInput, an_object_far_larger_than_the_domain_is_cut_with_a_warning) {
  const Workplace place;
  place.write("s.toml", milky_ball_with("resolution = 24", "resolution = 24\nmin = [-1, -1, -1]\nmax = [1, 1, 1]"));
  const Outcome outcome = place.turbid({"check", "s.toml", "-q"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("is cut by the domain"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("10.0 times as large: is its scale right?"), std::string::npos) << outcome.out;
}

TEST(BadInput, a_grid_file_that_is_no_openvdb_file) {
  const Workplace place;
  place.write("smoke.vdb", "smoke\n");
  expect_scene_refused(place, with_grid("\"smoke.vdb\", grid = \"density\""), {"s.toml:6:", "smoke.vdb", "VDB file"});
}

TEST(BadInput, a_grid_file_that_lacks_the_grid_or_holds_a_level_set_where_a_density_is_meant) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  ASSERT_EQ(place.turbid({"voxelise", "s.toml", "-q", "-o", "medium.vdb"}).status, 0);
  expect_scene_refused(place, with_grid("\"medium.vdb\", grid = \"density\""), {"s.toml:6:", "medium.vdb", "density"});
  expect_scene_refused(place, with_grid("\"medium.vdb\", grid = \"signed_distance\""),
                       {"s.toml:6:", "medium.vdb", "level set"});
}

TEST(BadInput, coefficients_out_of_range) {
  expect_scene_refused(Workplace(), milky_ball_with("[1.0, 1.2, 1.5]", "-1"),
                       {"s.toml:6:11: sigma_s = -1: must be >= 0 [1/mm]"});
  expect_scene_refused(Workplace(), milky_ball_with("[1.0, 1.2, 1.5]", "nan"), {"s.toml:6:11: sigma_s = nan"});
  expect_scene_refused(Workplace(), milky_ball_with("eta = 1.3", "eta = 0.9"),
                       {"s.toml:5:7: eta = 0.9: must be in [1, 10]"});
  expect_scene_refused(Workplace(), milky_ball_with("eta = 1.3", "eta = nan"), {"s.toml:5:7: eta = nan"});
}

TEST(BadInput, expressions_that_leave_the_range_name_the_place_where) {
  expect_scene_refused(Workplace(), milky_ball_with("[1.0, 1.2, 1.5]", "{ expression = \"x\" }"), {"milk", "sigma_s"});
  expect_scene_refused(Workplace(), milky_ball_with("[1.0, 1.2, 1.5]", "{ expression = \"sqrt(x)\" }"),
                       {"milk", "sigma_s"});
  expect_scene_refused(Workplace(), milky_ball_with("eta = 1.3", "eta = { expression = \"1 + 0.1*x\" }"),
                       {"milk", "eta"});
}

TEST(BadInput, resolutions_of_nothing_and_of_more_memory_than_there_is) {
  expect_scene_refused(Workplace(), milky_ball_with("= 24", "= 0"), {"s.toml:3:14: resolution = 0"});
  expect_scene_refused(Workplace(), milky_ball_with("= 24", "= 100000"), {"s.toml:3:14: resolution = 100000", "GB"});
  expect_scene_refused(Workplace(), kMilkyBall, {"--resolution 0"}, {"--resolution", "0"});
  expect_scene_refused(Workplace(), kMilkyBall, {"--resolution 90000", "GB"}, {"--resolution", "90000"});
}

TEST(BadInput, unknown_devices_and_solvers) {
  expect_scene_refused(Workplace(), kMilkyBall, {"--device warp: no such OpenCL device; there is: 0:0"},
                       {"--device", "warp"});
  expect_scene_refused(Workplace(), kMilkyBall, {"--solver magic", "steady", "lattice"}, {"--solver", "magic"});
}

TEST(BadInput, settings_of_the_command_line_are_as_strict_as_the_file) {
  expect_scene_refused(Workplace(), kMilkyBall, {"-D camera.fov=500"}, {"-D", "camera.fov=500"});
  expect_scene_refused(Workplace(), kMilkyBall, {"-D camera.zoom=2", "unknown key"}, {"-D", "camera.zoom=2"});
}

TEST(BadInput, places_that_take_no_output) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  place.write("taken", "mine\n");
  place.write("folder.vdb/x", "");
  const Words before = place.content();
  const auto expect = [&](const char* command, const char* output, const Words& words) {
    expect_refused(place.turbid({command, "s.toml", "-o", output}), words);
    EXPECT_EQ(place.content(), before);
  };
  expect("render", "taken", {"-o: taken is a file, expected a folder"});
  expect("render", "taken/pictures", {"-o: taken is a file"});
  expect("render", "/proc/turbid", {"-o: the folder /proc/turbid cannot be made"});
  expect("render", "picture.png", {"-o picture.png: expected a folder, or a file that ends in .exr"});
  expect("solve", "fluence.txt", {"-o fluence.txt: expected a name that ends in .vdb"});
  expect("solve", "folder.vdb", {"-o: folder.vdb is a folder"});
  expect("solve", "/proc/f.vdb", {"-o: the folder /proc cannot be written to"});
  expect("voxelise", "taken/m.vdb", {"-o: taken is a file"});
}

TEST(BadInput, files_that_info_can_not_read) {
  const Workplace place;
  place.write("letter.txt", "Dear reader,\n");
  place.write("letter.exr", "Dear reader,\n");
  place.write("letter.vdb", "Dear reader,\n");
  expect_refused(place.turbid({"info", "nowhere.exr"}), {"nowhere.exr: no such file"});
  expect_refused(place.turbid({"info", "."}), {"is a folder"});
  expect_refused(place.turbid({"info", "letter.txt"}), {"letter.txt: is neither"});
  expect_refused(place.turbid({"info", "letter.exr"}), {"letter.exr: cannot be read as an image"});
  expect_refused(place.turbid({"info", "letter.vdb"}), {"letter.vdb: is not an OpenVDB file"});
}

TEST(BadInput, a_machine_without_opencl_is_told_what_to_install) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const RunSettings without{.environment = {{"OCL_ICD_VENDORS", "/nonexistent"}}};
  for (const Words& command : {Words{"render", "s.toml"}, Words{"solve", "s.toml"}, Words{"devices"}})
    expect_refused(place.turbid(command, without), {"no OpenCL platform found", "apt-get install pocl-opencl-icd"});
  EXPECT_EQ(place.content(), Words{"s.toml"});
  // What needs no device still works.
  EXPECT_EQ(place.turbid({"voxelise", "s.toml", "-o", "m.vdb"}, without).status, 0);
  EXPECT_EQ(place.turbid({"check", "s.toml"}, without).status, 0);
}

}  // namespace
}  // namespace turbid::test
