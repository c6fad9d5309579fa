// SPDX-License-Identifier: Apache-2.0
// Picture files read back with OpenImageIO, failures to write them, tone mapping and exposure.
#include "host/view/image.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>

#include "host/base/errors.h"
#include "tests/unit/scratch_folder.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

ViewImage constant_picture(int width, int height, glm::vec4 colour) {
  const std::size_t n = std::size_t(width) * height;
  ViewImage image;
  image.width = width;
  image.height = height;
  image.colour.assign(n, colour);
  image.direct.assign(n, glm::vec3(colour));
  image.scattered.assign(n, glm::vec3(0));
  image.depth.assign(n, 1e10f);
  image.normal.assign(n, glm::vec3(0));
  return image;
}

/// A different value in every channel of every pixel.
ViewImage numbered_picture(int width, int height) {
  ViewImage image = constant_picture(width, height, glm::vec4(0));
  for (std::size_t i = 0; i < image.colour.size(); ++i) {
    const float v = float(i);
    image.colour[i] = {v + 0.1f, v + 0.2f, v + 0.3f, 1};
    image.direct[i] = {v + 1.1f, v + 1.2f, v + 1.3f};
    image.scattered[i] = {v + 2.1f, v + 2.2f, v + 2.3f};
    image.depth[i] = v + 3.00001f;
    image.normal[i] = glm::normalize(glm::vec3(v, 1, 2));
  }
  return image;
}

class ImageFiles : public ScratchFolder {
 protected:
  long entries() const { return std::distance(fs::directory_iterator(folder()), fs::directory_iterator()); }
};

struct File {
  OIIO::ImageSpec spec;
  std::vector<float> values;
  float at(int x, int y, const std::string& channel) const {
    const int c = spec.channelindex(channel);
    return c < 0 ? std::nanf("") : values[(std::size_t(y) * spec.width + x) * spec.nchannels + c];
  }
};

File read(const std::string& path) {
  File file;
  const auto input = OIIO::ImageInput::open(path);
  if (!input) throw std::runtime_error(OIIO::geterror());
  file.spec = input->spec();
  file.values.resize(std::size_t(file.spec.width) * file.spec.height * file.spec.nchannels);
  if (!input->read_image(0, 0, 0, file.spec.nchannels, OIIO::TypeDesc::FLOAT, file.values.data()))
    throw std::runtime_error(input->geterror());
  return file;
}

TEST_F(ImageFiles, ExrGivesBackEveryLayerInItsPrecision) {
  const ViewImage image = numbered_picture(17, 9);
  write_exr(image, {}, path("a.exr"));
  const File file = read(path("a.exr"));
  EXPECT_EQ(file.spec.width, 17);
  EXPECT_EQ(file.spec.height, 9);
  EXPECT_EQ(std::set<std::string>(file.spec.channelnames.begin(), file.spec.channelnames.end()),
            (std::set<std::string>{"R", "G", "B", "A", "direct.R", "direct.G", "direct.B", "scattered.R", "scattered.G",
                                   "scattered.B", "depth.Z", "N.X", "N.Y", "N.Z"}));
  for (int c = 0; c < file.spec.nchannels; ++c) {
    const std::string name = file.spec.channel_name(c);
    EXPECT_EQ(file.spec.channelformat(c), OIIO::TypeDesc::FLOAT) << name;
  }
  const char* rgb[] = {"R", "G", "B", "A"};
  const char* xyz[] = {"X", "Y", "Z"};
  for (int y = 0; y < 9; ++y)
    for (int x = 0; x < 17; ++x) {
      const std::size_t i = std::size_t(y) * 17 + x;
      for (int c = 0; c < 4; ++c) EXPECT_EQ(file.at(x, y, rgb[c]), image.colour[i][c]);
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(file.at(x, y, std::string("direct.") + rgb[c]), image.direct[i][c]);
        EXPECT_EQ(file.at(x, y, std::string("scattered.") + rgb[c]), image.scattered[i][c]);
        EXPECT_EQ(file.at(x, y, std::string("N.") + xyz[c]), image.normal[i][c]);
      }
      EXPECT_EQ(file.at(x, y, "depth.Z"), image.depth[i]);
    }
}

TEST_F(ImageFiles, ExrKeepsMetadata) {
  ImageMetadata metadata;
  metadata.text["turbid:scene_hash"] = "0123abcd";
  metadata.numbers["turbid:seconds"] = 1.5f;
  write_exr(numbered_picture(4, 4), metadata, path("a.exr"));
  const File file = read(path("a.exr"));
  EXPECT_EQ(file.spec.get_string_attribute("turbid:scene_hash"), "0123abcd");
  EXPECT_EQ(file.spec.get_float_attribute("turbid:seconds"), 1.5f);
  EXPECT_EQ(file.spec.get_string_attribute("compression"), "zip");
}

TEST_F(ImageFiles, ExrHoldsNoInfinityAndShowsNan) {
  ViewImage image = constant_picture(4, 2, {1e9f, -std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(), 1});
  image.scattered[0].r = std::nanf("");
  write_exr(image, {}, path("a.exr"));
  const File file = read(path("a.exr"));
  EXPECT_EQ(file.at(1, 1, "R"), 1e9f);
  EXPECT_EQ(file.at(1, 1, "G"), std::numeric_limits<float>::lowest());
  EXPECT_EQ(file.at(1, 1, "B"), std::numeric_limits<float>::max());
  EXPECT_TRUE(std::isnan(file.at(0, 0, "scattered.R")));
  EXPECT_EQ(file.at(1, 0, "depth.Z"), 1e10f);
}

TEST_F(ImageFiles, WritingMakesFoldersReplacesFilesAndLeavesNothingElse) {
  write_exr(numbered_picture(4, 4), {}, path("new/deep/a.exr"));
  EXPECT_EQ(read(path("new/deep/a.exr")).spec.width, 4);
  write_exr(numbered_picture(8, 4), {}, path("new/deep/a.exr"));
  EXPECT_EQ(read(path("new/deep/a.exr")).spec.width, 8);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder() / "new/deep"), fs::directory_iterator()), 1);
}

template <typename Action>
std::string input_error(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST_F(ImageFiles, FailingToWriteNamesTheFileAndTheReason) {
  const ViewImage image = numbered_picture(4, 4);
  std::ofstream(path("file")) << "not a folder";
  const std::string under_file = path("file/a.exr");
  EXPECT_EQ(input_error([&] { write_exr(image, {}, under_file); }),
            under_file + ": cannot be written: Not a directory");
  EXPECT_EQ(input_error([&] { write_png_preview(image, 0, path("file/a.png")); }),
            path("file/a.png") + ": cannot be written: Not a directory");
  // /proc refuses new files even to root.
  EXPECT_NE(input_error([&] { write_exr(image, {}, "/proc/self/a.exr"); }).find("/proc/self/a.exr: cannot be written"),
            std::string::npos);
  fs::create_directories(path("taken.exr"));
  EXPECT_EQ(input_error([&] { write_exr(image, {}, path("taken.exr")); }),
            path("taken.exr") + ": cannot be written: Is a directory");
  EXPECT_EQ(entries(), 2);  // "file" and "taken.exr", nothing temporary
}

TEST_F(ImageFiles, PngHasEightBitsAndMapsBlackGreyAndBright) {
  ViewImage image = constant_picture(3, 1, {0, 0, 0, 1});
  image.colour[1] = glm::vec4(0.2140411f);  // 0.5 in sRGB
  image.colour[2] = glm::vec4(1e6f);
  write_png_preview(image, 0, path("a.png"));
  const File file = read(path("a.png"));
  EXPECT_EQ(file.spec.nchannels, 3);
  EXPECT_EQ(file.spec.format, OIIO::TypeDesc::UINT8);
  for (const char* c : {"R", "G", "B"}) {
    EXPECT_EQ(file.at(0, 0, c), 0);
    EXPECT_NEAR(file.at(1, 0, c), 0.5, 1.0 / 255);  // dither and rounding: less than one step
    EXPECT_EQ(file.at(2, 0, c), 1);
  }
  // One stop more is twice the radiance, still below the shoulder: 0.4281 is 0.6866 in sRGB.
  write_png_preview(image, 1, path("b.png"));
  EXPECT_NEAR(read(path("b.png")).at(1, 0, "G"), 0.6866, 1.0 / 255);
}

TEST_F(ImageFiles, PngHighlightsKeepTheirHueAndNanIsBlack) {
  ViewImage image = constant_picture(3, 1, {4, 2, 1, 1});
  image.colour[1] = {2, 0, 0, 1};
  image.colour[2] = glm::vec4(std::nanf(""));
  write_png_preview(image, 0, path("a.png"));
  const File file = read(path("a.png"));
  // Clipping each channel would give (1, 1, 1).
  EXPECT_GE(file.at(0, 0, "R"), file.at(0, 0, "G"));
  EXPECT_GT(file.at(0, 0, "G"), file.at(0, 0, "B"));
  EXPECT_EQ(file.at(1, 0, "R"), 1);
  EXPECT_NEAR(file.at(1, 0, "G"), file.at(1, 0, "B"), 1e-6);
  // Too bright for a red: luminance 0.425 stays, red is 1, and what is missing goes to green and blue: 0.27 each.
  EXPECT_NEAR(file.at(1, 0, "G"), 0.557, 1.0 / 255);  // 0.27 in sRGB
  EXPECT_EQ(file.at(2, 0, "R"), 0);
}

TEST_F(ImageFiles, DitheringKeepsTheMeanOfValuesBetweenTwoSteps) {
  const double linear = 0.2, step = 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  write_png_preview(constant_picture(64, 64, glm::vec4(float(linear))), 0, path("a.png"));
  const File file = read(path("a.png"));
  double sum = 0;
  std::set<float> levels;
  for (float v : file.values) sum += v, levels.insert(v);
  EXPECT_EQ(levels.size(), 2u);
  // 4096 evenly spread thresholds: the mean is known to a few in 4096 of a step.
  EXPECT_NEAR(sum / double(file.values.size()), step, 5.0 / 4096 / 255);
}

TEST(Exposure, PutsTheBrightPartsNearWhite) {
  for (const float radiance : {1e-4f, 0.18f, 50.0f}) {
    const ViewImage image = constant_picture(10, 10, glm::vec4(glm::vec3(radiance), 1));
    // The shoulder maps 0.6 + 0.4 ln 4 to 0.9; float rounding of log2.
    EXPECT_NEAR(automatic_exposure(image), std::log2((0.6 + 0.4 * std::log(4.0)) / radiance), 1e-5);
  }
}

TEST(Exposure, LooksAtCoveredPixelsOnlyAndIgnoresNan) {
  ViewImage image = constant_picture(10, 10, {1, 1, 1, 1});
  const float expected = automatic_exposure(image);
  for (int i = 0; i < 90; ++i) image.colour[i] = {100, 100, 100, 0};
  image.colour[95] = glm::vec4(std::nanf(""));
  EXPECT_EQ(automatic_exposure(image), expected);
  EXPECT_EQ(automatic_exposure(constant_picture(4, 4, glm::vec4(0))), 0);  // black stays black at any exposure
}

TEST_F(ImageFiles, DescriptionListsChannelsRangesCountsAndMetadata) {
  ViewImage image = constant_picture(4, 2, {0.5f, 1, 2, 1});
  image.colour[3].r = std::nanf("");
  image.colour[4].r = 1.5f;
  ImageMetadata metadata;
  metadata.text["turbid:b"] = "second";
  metadata.numbers["turbid:a"] = 2;
  write_exr(image, metadata, path("a.exr"));
  const std::string text = describe_image(path("a.exr"));
  EXPECT_NE(text.find("a.exr: 4 x 2 pixels, 14 channels, openexr"), std::string::npos) << text;
  // 8 values, one NaN: mean (6 * 0.5 + 1.5) / 7.
  EXPECT_NE(text.find("  R           float            0.5          1.5     0.642857        1        0"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("depth.Z     float"), std::string::npos) << text;
  const auto a = text.find("turbid:a = 2"), b = text.find("turbid:b = \"second\"");
  EXPECT_NE(b, std::string::npos) << text;
  EXPECT_LT(a, b) << text;
}

TEST_F(ImageFiles, WhatIsNoPictureIsRefusedWithItsName) {
  EXPECT_EQ(input_error([&] { describe_image(path("none.exr")); }).rfind(path("none.exr") + ": cannot be read", 0), 0u);
  std::ofstream(path("text.exr")) << "hello";
  EXPECT_EQ(input_error([&] { describe_image(path("text.exr")); }).rfind(path("text.exr") + ": ", 0), 0u);
  write_exr(numbered_picture(64, 64), {}, path("cut.exr"));
  fs::resize_file(path("cut.exr"), fs::file_size(path("cut.exr")) / 2);
  EXPECT_EQ(input_error([&] { describe_image(path("cut.exr")); }).rfind(path("cut.exr") + ": ", 0), 0u);
}

}  // namespace
}  // namespace turbid
