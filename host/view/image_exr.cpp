// SPDX-License-Identifier: Apache-2.0
// write_exr(): all layers of a picture in one linear OpenEXR file. 32-bit floats throughout: radiance of a lamp of a watt is
// often below 1e-5, where 16-bit half floats have a few bits left.
#include <algorithm>
#include <cstddef>
#include <limits>

#include "host/view/encode_image.h"

namespace turbid {
namespace {

/// No infinity in a file: it would spoil every mean taken of it. NaN stays NaN, so that `turbid info` can count it.
float finite_range(float value) {
  return std::clamp(value, std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max());
}

/// A pixel of the file; the channels' order is that of kChannels.
struct Pixel {
  float colour[4], direct[3], scattered[3], depth, normal[3];
};
constexpr const char* kChannels[] = {"R",        "G",        "B",           "A",           "direct.R",
                                     "direct.G", "direct.B", "scattered.R", "scattered.G", "scattered.B",
                                     "depth.Z",  "N.X",      "N.Y",         "N.Z"};
constexpr int kDepth = 10;
static_assert(sizeof(Pixel) == std::size(kChannels) * sizeof(float));

OIIO::ImageSpec layered_spec(int width, int height) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(std::size(kChannels)), OIIO::TypeDesc::FLOAT);
  spec.channelnames.assign(std::begin(kChannels), std::end(kChannels));
  spec.alpha_channel = 3;
  spec.z_channel = kDepth;
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
    for (int c = 0; c < 4; ++c) out.colour[c] = finite_range(image.colour[i][c]);
    for (int c = 0; c < 3; ++c) {
      out.direct[c] = finite_range(image.direct[i][c]);
      out.scattered[c] = finite_range(image.scattered[i][c]);
      out.normal[c] = image.normal[i][c];
    }
    out.depth = image.depth[i];
  }
  write_image_file(path, "openexr", spec, OIIO::TypeDesc::FLOAT, pixels.data());
}

}  // namespace turbid
