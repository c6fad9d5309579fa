// SPDX-License-Identifier: Apache-2.0
// turbid compare on written pictures and volumes: statuses, verdicts, difference pictures, JSON.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <nlohmann/json.hpp>

#include "host/view/rgb_image.h"
#include "tests/support/run.h"

namespace turbid::test {
namespace {

using Words = std::vector<std::string>;

/// 24 x 16 pixels, a ramp in each colour times `factor`.
RgbImage ramp(float factor, int width = 24) {
  RgbImage image{width, 16, {}, true};
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < width; ++x) image.pixels.push_back(factor * glm::vec3(x + 1, y + 1, x + y + 1) / 48.0f);
  return image;
}

void write_volume(const std::string& path, float value, double voxel_size = 1) {
  openvdb::initialize();
  const auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  grid->setName("fluence");
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size));
  grid->denseFill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(9)), openvdb::Vec3s(value, 2, 3));
  openvdb::io::File(path).write({grid});
}

void expect_line(const Outcome& outcome, int status, const Words& words) {
  EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
  ASSERT_EQ(outcome.error_lines().size(), 1u) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("turbid: ")) << outcome.err;
  for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
}

class Compare : public testing::Test {
 protected:
  void SetUp() override {
    write_rgb_exr(ramp(1), place.path("b.exr"));
    write_rgb_exr(ramp(1.01f), place.path("near.exr"));
    write_rgb_exr(ramp(1.5f), place.path("far.exr"));
  }
  Workplace place;
};

TEST_F(Compare, a_picture_is_like_itself_and_like_one_that_is_near) {
  const Outcome same = place.turbid({"compare", "b.exr", "b.exr"});
  EXPECT_EQ(same.status, 0);
  EXPECT_EQ(same.err, "");
  EXPECT_NE(same.out.find("alike: relmse 0, up to 0.001 is allowed"), std::string::npos) << same.out;
  EXPECT_EQ(place.turbid({"compare", "near.exr", "b.exr"}).status, 0);
  EXPECT_EQ(place.content(), (Words{"b.exr", "far.exr", "near.exr"}));
}

TEST_F(Compare, a_picture_that_is_far_is_different_in_one_line_and_status_1) {
  const Outcome outcome = place.turbid({"compare", "far.exr", "b.exr"});
  expect_line(outcome, 1, {"far.exr: differs from b.exr: relmse 0.2", "up to 0.001 is allowed"});
  EXPECT_NE(outcome.out.find("rel-l2"), std::string::npos);
}

TEST_F(Compare, the_measure_and_tolerance_asked_for_decide) {
  EXPECT_EQ(place.turbid({"compare", "far.exr", "b.exr", "--measure", "rel-l1", "--tolerance", "0.49"}).status, 1);
  EXPECT_EQ(place.turbid({"compare", "far.exr", "b.exr", "--measure", "psnr"}).status, 1);
  EXPECT_EQ(place.turbid({"compare", "far.exr", "b.exr", "--measure", "flip"}).status, 1);
  EXPECT_EQ(place.turbid({"compare", "near.exr", "b.exr", "--measure", "linf", "--tolerance", "0.01"}).status, 0);
}

TEST_F(Compare, json_holds_every_measure_and_the_verdict) {
  const Outcome outcome = place.turbid({"compare", "far.exr", "b.exr", "--json"});
  EXPECT_EQ(outcome.status, 1);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["format"], "turbid compare 1");
  EXPECT_EQ(json["kind"], "linear picture");
  EXPECT_EQ(json["alike"], false);
  const auto& part = json["parts"][0];
  EXPECT_EQ(part["values"], 24 * 16 * 3);
  EXPECT_NEAR(part["rel-l1"], 0.5, 1e-6);
  EXPECT_NEAR(part["rel-l2"], 0.5, 1e-6);
  for (const char* name : {"mae", "rmse", "linf", "relmse", "psnr", "flip"}) EXPECT_GT(part[name], 0) << name;
  const auto same = nlohmann::json::parse(place.turbid({"compare", "b.exr", "b.exr", "--json"}).out);
  EXPECT_TRUE(same["parts"][0]["psnr"].is_null());
  EXPECT_EQ(same["parts"][0]["flip"], 0);
}

TEST_F(Compare, difference_pictures_show_flip_or_hold_a_minus_b) {
  EXPECT_EQ(place.turbid({"compare", "far.exr", "b.exr", "--difference", "d.exr"}).status, 1);
  const RgbImage difference = read_image(place.path("d.exr"));
  for (std::size_t i = 0; i < difference.pixels.size(); ++i)
    EXPECT_NEAR(difference.pixels[i].b, 0.5f * ramp(1).pixels[i].b, 1e-6);
  EXPECT_EQ(place.turbid({"compare", "b.exr", "b.exr", "--difference", "same.png"}).status, 0);
  for (const glm::vec3& pixel : read_image(place.path("same.png")).pixels)
    EXPECT_LT(glm::length(pixel - magma(0)), 0.005f);  // 8 bit
  expect_line(place.turbid({"compare", "far.exr", "b.exr", "--difference", "d.tif"}), 2, {"d.tif", ".png or .exr"});
  expect_line(place.turbid({"compare", "far.exr", "b.exr", "--difference", "b.exr"}), 2, {"one of the pictures"});
}

TEST_F(Compare, display_pictures_are_compared_as_shown_with_peak_1) {
  write_rgb_png(ramp(0.5f), place.path("a.png"));
  write_rgb_png(ramp(0.5f), place.path("b.png"));
  const auto json = nlohmann::json::parse(place.turbid({"compare", "a.png", "b.png", "--json"}).out);
  EXPECT_EQ(json["kind"], "picture");
  EXPECT_EQ(json["parts"][0]["peak"], 1);
  expect_line(place.turbid({"compare", "a.png", "b.exr"}), 2, {"display colours", "EXR with EXR"});
}

TEST_F(Compare, a_value_that_is_not_finite_is_a_difference) {
  RgbImage spoilt = ramp(1);
  spoilt.pixels[7].g = std::nanf("");
  write_rgb_exr(spoilt, place.path("nan.exr"));
  expect_line(place.turbid({"compare", "nan.exr", "b.exr"}), 1, {"1 pairs of values hold a NaN or an infinity"});
}

TEST_F(Compare, what_cannot_be_compared_is_one_line_and_status_2) {
  write_rgb_exr(ramp(1, 25), place.path("wide.exr"));
  place.write("text.exr", "hello");
  write_volume(place.path("v.vdb"), 1);
  expect_line(place.turbid({"compare", "wide.exr", "b.exr"}), 2,
              {"wide.exr: is of 25 x 16 pixels", "b.exr of 24 x 16"});
  expect_line(place.turbid({"compare", "none.exr", "b.exr"}), 2, {"none.exr: no such file"});
  expect_line(place.turbid({"compare", "b.exr", "text.exr"}), 2, {"text.exr: "});
  expect_line(place.turbid({"compare", "b.exr", "v.vdb"}), 2, {"one is a picture, the other a volume"});
  expect_line(place.turbid({"compare", "b.exr", "b.exr", "--layer", "direct"}), 2, {"lacks the channels direct.R"});
  expect_line(place.turbid({"compare", "b.exr", "b.exr", "--measure", "ssim"}), 2, {"no such measure; there are mae"});
  expect_line(place.turbid({"compare", "b.exr", "b.exr", "--measure", "mae"}), 2, {"give one with --tolerance"});
  expect_line(place.turbid({"compare", "b.exr", "b.exr", "--tolerance", "nan"}), 2, {"--tolerance"});
  expect_line(place.turbid({"compare", "b.exr", "b.exr", "--trim", "1"}), 2, {"--trim: must be in [0, 1)"});
  expect_line(place.turbid({"compare", "v.vdb", "v.vdb", "--measure", "flip"}), 2, {"is for pictures"});
}

TEST_F(Compare, volumes_are_compared_grid_by_grid) {
  write_volume(place.path("v.vdb"), 1);
  write_volume(place.path("near.vdb"), 1.001f);
  write_volume(place.path("far.vdb"), 2);
  write_volume(place.path("coarse.vdb"), 1, 2);
  EXPECT_EQ(place.turbid({"compare", "near.vdb", "v.vdb"}).status, 0);
  const Outcome far = place.turbid({"compare", "far.vdb", "v.vdb", "--json", "--measure", "rel-l2"});
  expect_line(far, 1, {"far.vdb: differs from v.vdb: rel-l2 0.2673 in the grid fluence"});  // sqrt(1 / 14)
  const auto json = nlohmann::json::parse(far.out);
  EXPECT_EQ(json["kind"], "volume");
  EXPECT_EQ(json["parts"][0]["name"], "fluence");
  EXPECT_EQ(json["parts"][0]["values"], 3000);
  EXPECT_EQ(json["parts"][0]["linf"], 1);
  EXPECT_FALSE(json["parts"][0].contains("flip"));
  expect_line(place.turbid({"compare", "coarse.vdb", "v.vdb"}), 2, {"has voxels of 2 x 2 x 2"});
  expect_line(place.turbid({"compare", "v.vdb", "v.vdb", "--grid", "heat"}), 2, {"holds no grid \"heat\""});
}

}  // namespace
}  // namespace turbid::test
