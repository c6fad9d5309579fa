// SPDX-License-Identifier: Apache-2.0
// describe_image(): what `turbid info` says about a picture file of any format that OpenImageIO reads.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "host/base/errors.h"
#include "host/view/image.h"

namespace turbid {
namespace {

struct ChannelRange {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, sum = 0;
  std::size_t finite = 0, nan = 0, infinite = 0;

  void add(float value) {
    if (std::isnan(value)) {
      ++nan;
    } else if (std::isinf(value)) {
      ++infinite;
    } else {
      ++finite;
      sum += value;
      lowest = std::min<double>(lowest, value);
      highest = std::max<double>(highest, value);
    }
  }
};

std::vector<ChannelRange> read_ranges(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const std::string& path) {
  constexpr int kRows = 64;  // at a time, for pictures larger than memory
  std::vector<ChannelRange> ranges(spec.nchannels);
  std::vector<float> rows(std::size_t(kRows) * spec.width * spec.nchannels);
  // Tiled files are read through their scanline emulation only as a whole.
  const int step = spec.tile_width > 0 ? spec.height : kRows;
  if (step > kRows) rows.resize(std::size_t(step) * spec.width * spec.nchannels);
  for (int y = 0; y < spec.height; y += step) {
    const int count = std::min(step, spec.height - y);
    const bool good = spec.tile_width > 0
                          ? input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, rows.data())
                          : input.read_scanlines(0, 0, spec.y + y, spec.y + y + count, 0, 0, spec.nchannels,
                                                 OIIO::TypeDesc::FLOAT, rows.data());
    if (!good) throw InputError(path + ": its pixels cannot be read: " + input.geterror());
    const std::size_t values = std::size_t(count) * spec.width * spec.nchannels;
    for (std::size_t i = 0; i < values; ++i) ranges[i % spec.nchannels].add(rows[i]);
  }
  return ranges;
}

std::string text_line(const char* format, auto... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

}  // namespace

std::string describe_image(const std::string& path) {
  const auto input = OIIO::ImageInput::open(path);
  if (!input) throw InputError(path + ": cannot be read as an image: " + OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.deep) throw InputError(path + ": is a deep image, which has no one value per pixel");
  const std::vector<ChannelRange> ranges = read_ranges(*input, spec, path);

  std::string out = path + ": " + std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels, " +
                    std::to_string(spec.nchannels) + " channels, " + input->format_name() + "\n";
  std::size_t width = 7;
  for (const std::string& name : spec.channelnames) width = std::max(width, name.size());
  const int w = static_cast<int>(std::min<std::size_t>(width, 40));
  out += text_line("  %-*s %-7s %12s %12s %12s %8s %8s\n", w, "channel", "type", "min", "max", "mean", "NaN", "Inf");
  for (int c = 0; c < spec.nchannels; ++c) {
    const ChannelRange& r = ranges[c];
    const double none = std::numeric_limits<double>::quiet_NaN();
    out += text_line("  %-*s %-7s %12.6g %12.6g %12.6g %8zu %8zu\n", w, spec.channel_name(c).c_str(),
                     spec.channelformat(c).c_str(), r.finite ? r.lowest : none, r.finite ? r.highest : none,
                     r.finite ? r.sum / double(r.finite) : none, r.nan, r.infinite);
  }
  if (!spec.format.is_floating_point()) out += "  (integers as fractions of their largest value)\n";

  std::map<std::string, std::string> metadata;
  for (const OIIO::ParamValue& value : spec.extra_attribs)
    metadata[value.name().string()] = OIIO::ImageSpec::metadata_val(value, true);
  if (!metadata.empty()) out += "metadata:\n";
  for (const auto& [name, value] : metadata) out += "  " + name + " = " + value + "\n";
  return out;
}

}  // namespace turbid
