// SPDX-License-Identifier: Apache-2.0
// read_image(): the colours of an EXR or PNG file.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>

#include "host/base/errors.h"
#include "host/view/rgb_image.h"

namespace turbid {
namespace {

std::array<int, 3> channels_of(const OIIO::ImageSpec& spec, const std::string& path, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  std::array<int, 3> channels;
  for (int c = 0; c < 3; ++c) channels[c] = spec.channelindex(prefix + "RGB"[c]);
  if (std::count(channels.begin(), channels.end(), -1) == 0) return channels;
  const int grey = spec.channelindex(prefix + "Y");
  if (grey >= 0) return {grey, grey, grey};
  if (layer.empty() && spec.nchannels == 1) return {0, 0, 0};
  std::string names;
  for (const std::string& name : spec.channelnames) names += (names.empty() ? "" : ", ") + name;
  throw InputError(path + ": lacks the channels " + prefix + "R, " + prefix + "G and " + prefix + "B; it has " + names);
}

}  // namespace

RgbImage read_image(const std::string& path, const std::string& layer) {
  OIIO::ImageSpec wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as they lie in the file, not multiplied by alpha
  const auto input = OIIO::ImageInput::open(path, &wishes);
  if (!input) throw InputError(path + ": cannot be read as an image: " + OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.deep) throw InputError(path + ": is a deep image, which has no one value per pixel");
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    throw InputError(path + ": its pixels are a crop of, or reach beyond, the " + std::to_string(spec.full_width) +
                     " x " + std::to_string(spec.full_height) + " that it says to show");
  const std::array<int, 3> channels = channels_of(spec, path, layer);
  const auto [first, last] = std::minmax_element(channels.begin(), channels.end());
  const int begin = *first, count = *last - *first + 1;

  RgbImage image{spec.width, spec.height, {}, spec.format.is_floating_point()};
  const std::size_t pixels = std::size_t(spec.width) * spec.height;
  std::vector<float> values(pixels * count);
  if (!input->read_image(0, 0, begin, begin + count, OIIO::TypeDesc::FLOAT, values.data()))
    throw InputError(path + ": its pixels cannot be read: " + input->geterror());
  image.pixels.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) image.pixels[i][c] = values[i * count + channels[c] - begin];
  return image;
}

}  // namespace turbid
