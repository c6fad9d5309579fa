// SPDX-License-Identifier: Apache-2.0
// write_exr(): all layers of a picture in one linear OpenEXR file.
#include <algorithm>
#include <cstddef>

#include "host/view/encode_image.h"

namespace turbid {
namespace {

constexpr float kLargestHalf = 65504.0f;

/// Radiance is stored as half: what is too bright for it becomes the brightest half, not infinity. NaN stays NaN, so
/// that `turbid info` can count it.
float to_half_range(float value) {
  return std::clamp(value, -kLargestHalf, kLargestHalf);
}

/// A pixel of the file; the channels' order is that of kChannels.
struct Pixel {
  float colour[4], direct[3], scattered[3], depth, normal[3];
};
constexpr const char* kChannels[] = {"R",        "G",        "B",           "A",           "direct.R",
                                     "direct.G", "direct.B", "scattered.R", "scattered.G", "scattered.B",
                                     "depth.Z",  "N.X",      "N.Y",         "N.Z"};
constexpr int kFirstFloat = 10;  ///< depth and normal are 32-bit floats, what is before them half
static_assert(sizeof(Pixel) == std::size(kChannels) * sizeof(float));

OIIO::ImageSpec layered_spec(int width, int height) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(std::size(kChannels)), OIIO::TypeDesc::FLOAT);
  spec.channelnames.assign(std::begin(kChannels), std::end(kChannels));
  for (int c = 0; c < spec.nchannels; ++c)
    spec.channelformats.push_back(c < kFirstFloat ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
  spec.alpha_channel = 3;
  spec.z_channel = kFirstFloat;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("Software", "Turbid " TURBID_VERSION);
  return spec;
}

}  // namespace

void write_exr(const ViewImage& image, const ImageMetadata& metadata, const std::string& path) {
  require_whole(image);
  OIIO::ImageSpec spec = layered_spec(image.width, image.height);
  for (const auto& [name, text] : metadata.text) spec.attribute(name, text);
  for (const auto& [name, number] : metadata.numbers) spec.attribute(name, number);

  std::vector<Pixel> pixels(image.colour.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    Pixel& out = pixels[i];
    for (int c = 0; c < 4; ++c) out.colour[c] = to_half_range(image.colour[i][c]);
    for (int c = 0; c < 3; ++c) {
      out.direct[c] = to_half_range(image.direct[i][c]);
      out.scattered[c] = to_half_range(image.scattered[i][c]);
      out.normal[c] = image.normal[i][c];
    }
    out.depth = image.depth[i];
  }
  write_image_file(path, "openexr", spec, OIIO::TypeDesc::FLOAT, pixels.data());
}

}  // namespace turbid
