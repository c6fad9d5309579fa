// SPDX-License-Identifier: Apache-2.0
// write_rgb_exr(), write_rgb_png() and the colour map of difference pictures.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "host/base/atomic_file.h"
#include "host/view/encode_image.h"
#include "host/view/rgb_image.h"

namespace turbid {
namespace {

OIIO::ImageSpec spec_of(const RgbImage& image, OIIO::TypeDesc type, const char* space) {
  if (image.width <= 0 || image.height <= 0 || image.pixels.size() != std::size_t(image.width) * image.height)
    throw std::invalid_argument("an RgbImage needs width * height > 0 pixels");
  OIIO::ImageSpec spec(image.width, image.height, 3, type);
  spec.attribute("oiio:ColorSpace", space);
  spec.attribute("Software", "Turbid " TURBID_VERSION);
  return spec;
}

/// Every 16th entry of the map's table, and the last.
constexpr std::array<glm::vec3, 17> kMagma{{{0.001f, 0.000f, 0.014f},
                                            {0.039f, 0.031f, 0.133f},
                                            {0.112f, 0.065f, 0.276f},
                                            {0.210f, 0.062f, 0.417f},
                                            {0.315f, 0.071f, 0.485f},
                                            {0.413f, 0.110f, 0.504f},
                                            {0.511f, 0.147f, 0.508f},
                                            {0.611f, 0.181f, 0.499f},
                                            {0.713f, 0.214f, 0.476f},
                                            {0.814f, 0.254f, 0.438f},
                                            {0.901f, 0.316f, 0.390f},
                                            {0.959f, 0.414f, 0.360f},
                                            {0.986f, 0.530f, 0.380f},
                                            {0.996f, 0.648f, 0.442f},
                                            {0.997f, 0.763f, 0.530f},
                                            {0.993f, 0.878f, 0.634f},
                                            {0.987f, 0.991f, 0.750f}}};

}  // namespace

void write_rgb_exr(const RgbImage& image, const std::string& path) {
  OIIO::ImageSpec spec = spec_of(image, OIIO::TypeDesc::FLOAT, "Linear");
  spec.attribute("compression", "zip");
  write_image_file(path, "openexr", spec, OIIO::TypeDesc::FLOAT, image.pixels.data());
}

std::vector<unsigned char> png_bytes(const RgbImage& image) {
  const OIIO::ImageSpec spec = spec_of(image, OIIO::TypeDesc::UINT8, "sRGB");
  std::vector<unsigned char> bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const glm::vec3& pixel : image.pixels)
    for (int c = 0; c < 3; ++c)
      bytes.push_back(static_cast<unsigned char>(pixel[c] > 0 ? std::lround(255 * std::min(pixel[c], 1.0f)) : 0));
  return encode_image("a picture", "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

void write_rgb_png(const RgbImage& image, const std::string& path) {
  const std::vector<unsigned char> bytes = png_bytes(image);
  write_file_atomically(path, bytes.data(), bytes.size());
}

glm::vec3 magma(float value) {
  const float at = (value > 0 ? std::min(value, 1.0f) : 0.0f) * (kMagma.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), kMagma.size() - 2);
  return glm::mix(kMagma[below], kMagma[below + 1], at - static_cast<float>(below));
}

}  // namespace turbid
