// SPDX-License-Identifier: Apache-2.0
// Three colours per pixel and nothing else: pictures read back from EXR and PNG files, and pictures of differences.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace turbid {

struct RgbImage {
  int width = 0, height = 0;
  std::vector<glm::vec3> pixels;  ///< row 0 is the top row, x fastest
  bool linear = false;            ///< scene radiance from a file of floats; else sRGB-encoded in [0, 1]
};

/// The channels R, G, B, or LAYER.R, LAYER.G, LAYER.B; a picture of one colour gives three equal ones. Alpha is left
/// alone. Throws InputError if the file can't be read as an image, is a crop of a larger one or lacks the channels.
RgbImage read_image(const std::string& path, const std::string& layer = "");

/// 32-bit float channels R, G, B as they are. Written whole or not at all; throws InputError if that fails.
void write_rgb_exr(const RgbImage&, const std::string& path);
/// 8 bit, values in [0, 1] as they are, without any transfer curve. Likewise.
void write_rgb_png(const RgbImage&, const std::string& path);
/// What write_rgb_png() writes.
std::vector<unsigned char> png_bytes(const RgbImage&);

/// The perceptually uniform colour map "magma" (van der Walt and Smith, CC0): black, purple, orange, pale yellow;
/// lightness rises evenly with the value in [0, 1]. sRGB-encoded, within 3/255 of the original's 256 entries. NaN is
/// black.
glm::vec3 magma(float value);

}  // namespace turbid
