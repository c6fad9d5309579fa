// SPDX-License-Identifier: Apache-2.0
// How [domain] becomes a grid: sizes, growth, exact periodic and mirrored axes, what is refused.
#include <gtest/gtest.h>

#include "tests/unit/scene_files.h"

namespace turbid {
namespace {

using test::error_of;
using test::read_text;

/// A ball of radius 10 about the origin in a domain with these keys.
std::string ball(const std::string& domain, const std::string& object = "") {
  return "[domain]\n" + domain +
         "\n[material.m]\nsigma_s = 1\n[[object]]\nshape = \"sphere\"\nradius = 10\nmaterial = \"m\"\n" + object;
}

GridFrame frame_of(const std::string& domain) {
  return read_text(ball(domain)).medium.frame;
}

TEST(Frame, resolution_counts_voxels_along_the_longest_side) {
  const GridFrame frame = frame_of("resolution = 64\nmin = [-16, -12, -10]\nmax = [16, 12, 10]");
  EXPECT_FLOAT_EQ(frame.voxel_size, 0.5f);
  EXPECT_EQ(frame.voxels, glm::ivec3(64, 48, 40));
  EXPECT_EQ(frame.origin, glm::vec3(-16, -12, -10));
}

TEST(Frame, rounds_up_to_blocks_and_grows_by_whole_voxels) {
  // 27 voxels become 32: two more below, three above, so that voxels of the user's grid are voxels here.
  const GridFrame frame = frame_of("voxel_size = 1\nmin = [-11, -12, -13]\nmax = [11, 12, 14]");
  EXPECT_EQ(frame.voxels, glm::ivec3(24, 24, 32));
  EXPECT_EQ(frame.origin, glm::vec3(-12, -12, -15));
  // The shortest side is 21.3 voxels: still, a voxel's face lies on its min.
  const GridFrame odd = frame_of("voxel_size = 1\nmin = [-10.3, -12, -12]\nmax = [11, 12, 12]");
  EXPECT_EQ(odd.voxels, glm::ivec3(24));
  EXPECT_NEAR(odd.origin.x, -11.3f, 1e-5f);
}

TEST(Frame, tells_when_the_domain_grows_and_what_fills_it_changes_the_light) {
  const std::string fog = "\n[material.m]\nsigma_s = 1\n";
  const std::string given = "voxel_size = 1\nmin = [0, 0, 0]\nmax = [91, 91, 91]\n";
  const Scene filled = read_text("[domain]\n" + given + "material = \"m\"" + fog);
  ASSERT_EQ(filled.warnings.size(), 1u);
  EXPECT_HOLDS(filled.warnings[0],
            "s.toml:1:1: [domain] from [0.0, 0.0, 0.0] to [91.0, 91.0, 91.0] is no whole number of 8-voxel blocks: it became "
            "[-2.0, -2.0, -2.0] to [94.0, 94.0, 94.0], all filled with \"m\"; resolutions that fit exactly are 80, 88, 96, "
            "104, 112");
  EXPECT_TRUE(read_text("[domain]\nresolution = 96\nmin = [0, 0, 0]\nmax = [91, 91, 91]\nmaterial = \"m\"" + fog).warnings.empty());
  // Nothing but more vacuum around a ball; but of a ball that is cut, more is lit.
  EXPECT_TRUE(read_text(ball("voxel_size = 1\nmin = [-11, -11, -11]\nmax = [11, 11, 11]")).warnings.empty());
  const Scene cut = read_text(ball("voxel_size = 1\nmin = [-9, -11, -11]\nmax = [9, 11, 11]"));
  ASSERT_EQ(cut.warnings.size(), 1u);
  EXPECT_HOLDS(cut.warnings[0], "all filled with the objects that reach beyond it; resolutions that fit exactly are 88, 176");
}

TEST(Frame, automatic_domain_leaves_two_voxels_around_the_objects) {
  const GridFrame frame = frame_of("resolution = 64");
  EXPECT_NEAR(frame.voxel_size, 20.0f / 60.0f, 1e-4f);  // the sphere's triangles may reach a trifle less far
  EXPECT_EQ(frame.voxels, glm::ivec3(64));
  EXPECT_NEAR(frame.origin.y, -10.0f - 2 * frame.voxel_size, 1e-2f);
}

TEST(Frame, periodic_axes_keep_their_extent_and_shrink_the_voxels) {
  const GridFrame frame =
      frame_of("voxel_size = 1.0\nmin = [-10, -10, -10]\nmax = [10, 10, 10]\nboundary = { x = \"periodic\" }");
  EXPECT_EQ(frame.voxels.x, 24);
  EXPECT_NEAR(frame.size().x, 20.0f, 1e-5f);
  EXPECT_FLOAT_EQ(frame.origin.x, -10.0f);
}

TEST(Frame, periodic_axes_that_fit_keep_the_voxel_size) {
  const GridFrame frame = frame_of(
      "voxel_size = 0.5\nmin = [-12, -12, -10]\nmax = [12, 12, 10]\nboundary = { x = \"periodic\", y = \"mirror\" }");
  EXPECT_EQ(frame.voxels, glm::ivec3(48, 48, 40));
  EXPECT_FLOAT_EQ(frame.voxel_size, 0.5f);
}

TEST(Frame, tells_when_it_changes_the_voxel_size) {
  const Scene scene =
      read_text(ball("voxel_size = 1\nmin = [-10, -10, -10]\nmax = [10, 10, 10]\nboundary = \"periodic\""));
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_HOLDS(scene.warnings[0], "voxel_size = 1 became 0.8333333");
}

TEST(Frame, extents_without_a_common_voxel_size_name_resolutions_that_work) {
  const std::string box =
      "min = [-12, -10.5, -10]\nmax = [12, 10.5, 10]\nboundary = { x = \"periodic\", y = \"periodic\" }\n";
  const std::string error = error_of(ball(box + "resolution = 72"));  // 24 : 21 = 8 : 7
  EXPECT_HOLDS(error, "s.toml:5:14: resolution = 72: mirror and periodic axes keep their exact extent");
  EXPECT_HOLDS(error, "resolutions that work are 64, 128, 192, 256");
  for (const char* works : {"64", "128", "192"})
    EXPECT_NO_THROW(read_text(ball(box + "resolution = " + works))) << works;
}

TEST(Frame, an_axis_with_one_mirror_grows_at_its_open_end_only) {
  const GridFrame frame =
      frame_of("voxel_size = 1\nmin = [0, -12, -12]\nmax = [11, 12, 12]\nboundary = { x_min = \"mirror\" }");
  EXPECT_EQ(frame.voxels.x, 16);
  EXPECT_EQ(frame.origin.x, 0.0f);
}

TEST(Frame, boundaries_may_be_given_per_face_and_per_axis) {
  const auto faces = read_text(ball("min = [-12, -12, -12]\nmax = [12, 12, 12]\nresolution = 24\n"
                                    "boundary = { x = \"periodic\", y_max = \"mirror\" }"))
                         .medium.faces;
  EXPECT_EQ(faces[0], FaceBoundary::periodic);
  EXPECT_EQ(faces[1], FaceBoundary::periodic);
  EXPECT_EQ(faces[2], FaceBoundary::open);
  EXPECT_EQ(faces[3], FaceBoundary::mirror);
  EXPECT_EQ(faces[5], FaceBoundary::open);
}

TEST(FrameErrors, boundaries_must_make_sense) {
  EXPECT_EQ(error_of(ball("min = [-12, -12, -12]\nmax = [12, 12, 12]\nboundary = { x_min = \"periodic\" }")),
            "s.toml:4:22: x_min = \"periodic\": an axis is periodic at both of its faces or at none");
  EXPECT_HOLDS(error_of(ball("boundary = \"mirror\"")), "mirror and periodic faces need [domain] min and max");
  EXPECT_HOLDS(error_of(ball("boundary = \"closed\"")),
               "s.toml:2:12: boundary = \"closed\": expected \"open\", \"mirror\", \"periodic\"");
  EXPECT_HOLDS(error_of(ball("boundary = { x = \"open\", x_min = \"open\" }")),
               "x is given as well: expected one of the two");
}

TEST(FrameErrors, absurd_sizes_name_the_memory_they_would_need) {
  EXPECT_EQ(error_of(ball("min = [-16, -16, -16]\nmax = [16, 16, 16]\nresolution = 4096")),
            "s.toml:4:14: resolution = 4096: 4096 x 4096 x 4096 voxels would need about 13.7 TB of memory; the limit "
            "is 64 GB: use a "
            "resolution of at most about 683");
  EXPECT_HOLDS(error_of(ball("voxel_size = 1e-6")), "use a voxel size of at least about ");
  EXPECT_HOLDS(error_of(ball("resolution = 9000000000000000000")), "s.toml:2:14: ");
}

TEST(FrameErrors, resolution_must_be_a_block_at_least) {
  EXPECT_EQ(error_of(ball("resolution = 0")), "s.toml:2:14: resolution = 0: must be >= 8 [voxels]");
  EXPECT_EQ(error_of(ball("resolution = -5")), "s.toml:2:14: resolution = -5: must be >= 8 [voxels]");
  EXPECT_EQ(error_of(ball("voxel_size = 0")), "s.toml:2:14: voxel_size = 0: must be > 0 [mm]");
  EXPECT_EQ(error_of(ball("resolution = 8\nvoxel_size = 1")),
            "s.toml:3:14: voxel_size = 1: resolution is given as well: expected one of the two");
}

TEST(FrameErrors, min_and_max_come_together_and_in_order) {
  EXPECT_EQ(error_of(ball("min = [0, 0, 0]")), "s.toml:2:7: min = [0, 0, 0]: expected both min and max, or neither");
  EXPECT_EQ(error_of(ball("min = [0, 0, 0]\nmax = [1, 0, 1]")),
            "s.toml:3:7: max = [1, 0, 1]: must be greater than min in x, y and z");
}

TEST(FrameErrors, an_object_outside_the_domain_is_refused_and_one_that_is_cut_is_pointed_out) {
  const std::string domain = "min = [-12, -12, -12]\nmax = [12, 12, 12]\nresolution = 24";
  EXPECT_HOLDS(error_of(ball(domain, "translate = [40, 0, 0]\n")), "s.toml:7:1: object \"sphere\" reaches from [30.0");
  const Scene cut = read_text(ball(domain, "translate = [5, 0, 0]\n"));
  ASSERT_EQ(cut.warnings.size(), 1u);
  EXPECT_HOLDS(cut.warnings[0], "s.toml:7:1: object \"sphere\" is cut by the domain");
  const Scene far_larger = read_text(ball(domain, "scale = 100\n"));
  EXPECT_HOLDS(far_larger.warnings.at(0), "times as large: is its scale right?");
  EXPECT_TRUE(read_text(ball(domain)).warnings.empty());
}

TEST(FrameErrors, an_object_may_reach_beyond_periodic_faces) {
  const Scene scene =
      read_text(ball("min = [-12, -12, -12]\nmax = [12, 12, 12]\nresolution = 24\nboundary = { x = \"periodic\" }",
                     "translate = [5, 0, 0]\n"));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(FrameErrors, a_scene_of_ambient_only_needs_an_explicit_domain) {
  const std::string fog = "material = \"m\"\n[material.m]\nsigma_s = 1\n";
  EXPECT_HOLDS(error_of("[domain]\n" + fog), "s.toml:1:1: a scene without objects needs [domain] min and max");
  EXPECT_EQ(read_text("[domain]\nmin = [0, 0, 0]\nmax = [4, 2, 2]\nresolution = 16\n" + fog).medium.frame.voxels,
            glm::ivec3(16, 8, 8));
}

}  // namespace
}  // namespace turbid
