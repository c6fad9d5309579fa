// SPDX-License-Identifier: Apache-2.0
// Colours read back from picture files, plain colour pictures, the colour map, and grids read in pairs.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "host/base/errors.h"
#include "host/view/image.h"
#include "host/view/rgb_image.h"
#include "tests/unit/scratch_folder.h"
#include "volumes/read_vdb_values.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

class ReadFiles : public ScratchFolder {
 protected:
  /// A file with these channels, every value its own number / 16.
  void write(const std::string& name, OIIO::ImageSpec spec, const std::vector<std::string>& channels) const {
    spec.channelnames = channels;
    std::vector<float> values(std::size_t(spec.width) * spec.height * spec.nchannels);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) / 16;
    const auto output = OIIO::ImageOutput::create(path(name));
    ASSERT_TRUE(output && output->open(path(name), spec)) << OIIO::geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
    ASSERT_TRUE(output->close());
  }
};

template <typename Action>
std::string input_error(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST_F(ReadFiles, a_rendered_picture_gives_its_colours_and_layers) {
  ViewImage image{2,      1,       {{1, 2, 3, 0.5f}, {4, 5, 6, 1}}, {{7, 8, 9}, {1, 1, 1}}, {{0, 1, 2}, {3, 3, 3}},
                  {1, 1}, {{}, {}}};
  write_exr(image, {}, path("a.exr"));
  const RgbImage main = read_image(path("a.exr"));
  EXPECT_TRUE(main.linear);
  EXPECT_EQ(main.width, 2);
  EXPECT_EQ(main.height, 1);
  EXPECT_EQ(main.pixels, (std::vector<glm::vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(read_image(path("a.exr"), "direct").pixels[0], glm::vec3(7, 8, 9));
  EXPECT_EQ(read_image(path("a.exr"), "scattered").pixels[0], glm::vec3(0, 1, 2));
  EXPECT_NE(input_error([&] { read_image(path("a.exr"), "caustics"); }).find("a.exr: lacks the channels caustics.R"),
            std::string::npos);
}

TEST_F(ReadFiles, colours_of_a_png_are_not_multiplied_by_alpha) {
  OIIO::ImageSpec spec(2, 2, 4, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:UnassociatedAlpha", 1);
  write("a.png", spec, {"R", "G", "B", "A"});
  const RgbImage image = read_image(path("a.png"));
  EXPECT_FALSE(image.linear);
  for (int i = 0; i < 4; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixels[i][c], (4 * i + c) / 16.0, 0.51 / 255);  // 8 bit
}

TEST_F(ReadFiles, one_colour_gives_three_and_any_order_of_channels_is_put_right) {
  write("grey.exr", OIIO::ImageSpec(2, 2, 1, OIIO::TypeDesc::HALF), {"Y"});
  EXPECT_EQ(read_image(path("grey.exr")).pixels[3], glm::vec3(3 / 16.0f));
  write("grey.png", OIIO::ImageSpec(2, 2, 1, OIIO::TypeDesc::UINT16), {"Y"});
  EXPECT_NEAR(read_image(path("grey.png")).pixels[2].g, 2 / 16.0, 1e-4);  // 16 bit
  write("order.exr", OIIO::ImageSpec(2, 2, 4, OIIO::TypeDesc::FLOAT), {"Z", "B", "G", "R"});
  // OpenEXR sorts channels by name; each keeps its values.
  EXPECT_EQ(read_image(path("order.exr")).pixels[1], glm::vec3(7, 6, 5) / 16.0f);
}

TEST_F(ReadFiles, what_cannot_be_compared_pixel_by_pixel_is_refused_with_its_name) {
  OIIO::ImageSpec crop(2, 2, 3, OIIO::TypeDesc::FLOAT);
  crop.x = 1;
  crop.full_width = crop.full_height = 4;
  write("crop.exr", crop, {"R", "G", "B"});
  EXPECT_NE(input_error([&] { read_image(path("crop.exr")); }).find("crop.exr: its pixels are a crop"),
            std::string::npos);
  std::ofstream(path("text.png")) << "hello";
  EXPECT_EQ(input_error([&] { read_image(path("text.png")); }).rfind(path("text.png") + ": cannot be read", 0), 0u);
  write("cut.exr", OIIO::ImageSpec(64, 64, 3, OIIO::TypeDesc::FLOAT), {"R", "G", "B"});
  fs::resize_file(path("cut.exr"), fs::file_size(path("cut.exr")) / 2);
  EXPECT_EQ(input_error([&] { read_image(path("cut.exr")); }).rfind(path("cut.exr") + ": ", 0), 0u);
}

TEST_F(ReadFiles, plain_pictures_come_back) {
  const RgbImage image{2, 1, {{-1, 0, 1e-7f}, {0.2f, 1, 7}}, true};
  write_rgb_exr(image, path("a.exr"));
  EXPECT_EQ(read_image(path("a.exr")).pixels, image.pixels);
  write_rgb_png(image, path("a.png"));
  const RgbImage shown = read_image(path("a.png"));
  EXPECT_EQ(shown.pixels[0], glm::vec3(0));
  EXPECT_FLOAT_EQ(shown.pixels[1].r, 51 / 255.0f);
  EXPECT_EQ(shown.pixels[1].b, 1);
}

TEST(ColourMap, gets_lighter_all_the_way_from_black) {
  float before = -1;
  for (int i = 0; i <= 1000; ++i) {
    const glm::vec3 colour = magma(float(i) / 1000);
    const float luma = glm::dot(colour, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    EXPECT_GT(luma, before) << i;
    before = luma;
  }
  EXPECT_LT(glm::length(magma(0)), 0.02f);
  EXPECT_EQ(magma(7), magma(1));
  EXPECT_EQ(magma(std::nanf("")), magma(0));
}

/// Two grids in one file: density (float) and fluence (Vec3), both of one voxel size.
void write_grids(const std::string& path, float shift, double voxel_size = 0.5) {
  openvdb::initialize();
  const auto density = openvdb::FloatGrid::create(1.0f);
  density->setName("density");
  density->tree().setValue(openvdb::Coord(0), 2 + shift);
  if (shift > 0) density->tree().setValue(openvdb::Coord(100), 5);
  const auto fluence = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
  fluence->setName("fluence");
  fluence->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(7)), openvdb::Vec3s(1, 2, 3 + shift));  // a tile
  const auto owner = openvdb::Int32Grid::create(0);
  owner->setName("owner");
  for (openvdb::GridBase* grid :
       {static_cast<openvdb::GridBase*>(density.get()), static_cast<openvdb::GridBase*>(fluence.get())})
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size));
  openvdb::io::File(path).write({density, fluence, owner});
}

TEST_F(ReadFiles, grids_come_in_pairs_over_the_voxels_active_in_either) {
  write_grids(path("a.vdb"), 1);
  write_grids(path("b.vdb"), 0);
  std::vector<GridPair> pairs;
  for_each_grid_pair(path("a.vdb"), path("b.vdb"), "", [&](const GridPair& pair) { pairs.push_back(pair); });
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].name, "density");
  EXPECT_EQ(pairs[0].a, (std::vector<float>{3, 5}));
  EXPECT_EQ(pairs[0].b, (std::vector<float>{2, 1}));  // the background where b is not active
  EXPECT_EQ(pairs[1].components, 3);
  ASSERT_EQ(pairs[1].a.size(), 3u * 512);
  EXPECT_EQ(pairs[1].a[1535], 4);
  EXPECT_EQ(pairs[1].b[1535], 3);
  int visits = 0;
  for_each_grid_pair(path("a.vdb"), path("b.vdb"), "fluence", [&](const GridPair& pair) {
    EXPECT_EQ(pair.name, "fluence");
    ++visits;
  });
  EXPECT_EQ(visits, 1);
}

TEST_F(ReadFiles, grids_that_do_not_match_are_refused) {
  const auto refusal = [&](const std::string& a, const std::string& b, const std::string& only) {
    return input_error([&] { for_each_grid_pair(path(a), path(b), only, [](const GridPair&) { FAIL(); }); });
  };
  const auto expect_said = [](const std::string& error, const std::string& words) {
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  write_grids(path("a.vdb"), 1);
  write_grids(path("finer.vdb"), 1, 0.25);
  const auto alone = openvdb::FloatGrid::create();
  alone->setName("fluence");
  openvdb::io::File(path("alone.vdb")).write({alone});
  openvdb::io::File(path("twice.vdb")).write({alone, alone->deepCopy()});
  std::ofstream(path("text.vdb")) << "hello";
  expect_said(refusal("finer.vdb", "a.vdb", ""), "\"density\" (float) has voxels of 0.25 x 0.25 x 0.25");
  expect_said(refusal("alone.vdb", "a.vdb", ""), "alone.vdb: lacks the grid \"density\" (float) of the reference");
  expect_said(refusal("a.vdb", "alone.vdb", ""), "alone.vdb: lacks the grid \"density\"");
  expect_said(refusal("alone.vdb", "a.vdb", "fluence"), "is of another type than that of the reference, vec3s");
  expect_said(refusal("a.vdb", "a.vdb", "heat"),
              "a.vdb: holds no grid \"heat\"; it has \"density\" (float), \"fluence\"");
  expect_said(refusal("twice.vdb", "a.vdb", ""), "twice.vdb: holds two grids named \"fluence\"");
  expect_said(refusal("text.vdb", "a.vdb", ""), "text.vdb: is not an OpenVDB file");
  expect_said(refusal("none.vdb", "a.vdb", ""), "none.vdb: can't be opened");
}

}  // namespace
}  // namespace turbid
