// SPDX-License-Identifier: Apache-2.0
// write_png_preview() and automatic_exposure(): from linear radiance to what a screen shows.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host/base/atomic_file.h"
#include "host/base/parallel.h"
#include "host/view/encode_image.h"

namespace turbid {
namespace {

constexpr float kKnee = 0.6f;       ///< luminance up to which the tone curve is the identity
constexpr float kNearWhite = 0.9f;  ///< where automatic exposure puts the picture's bright parts; 244 in sRGB
constexpr float kBrightPercentile = 0.99f;

float luminance(glm::vec3 c) {
  return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}  // Rec. 709

/// Identity up to the knee, then exponentially towards 1; value and slope are continuous.
float tone_curve(float y) {
  return y <= kKnee ? y : kKnee + (1 - kKnee) * (1 - std::exp(-(y - kKnee) / (1 - kKnee)));
}
float inverse_tone_curve(float y) {
  return y <= kKnee ? y : kKnee - (1 - kKnee) * std::log(1 - (y - kKnee) / (1 - kKnee));
}

/// The curve acts on luminance, so hues keep; a channel that is still above 1 is mixed with grey of the same luminance.
glm::vec3 tone_map(glm::vec3 c) {
  for (int k = 0; k < 3; ++k) c[k] = c[k] > 0 ? std::min(c[k], 1e30f) : 0.0f;  // NaN becomes 0 too
  const float y = luminance(c);
  if (!(y > 0)) return glm::vec3(0);
  const float shown = tone_curve(y);
  c *= shown / y;
  const float brightest = std::max({c.r, c.g, c.b});
  if (brightest <= 1) return c;
  const float keep = std::max((1 - shown) / (brightest - shown), 0.0f);
  return glm::vec3(shown) + keep * (c - glm::vec3(shown));
}

float srgb_transfer(float v) {  // IEC 61966-2-1
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

/// In [0, 1), evenly spread over any few neighbouring pixels (the R2 sequence on the pixel grid, Roberts 2018). The
/// three channels share it, so that grey stays grey.
float dither(int x, int y) {
  const std::uint32_t steps = std::uint32_t(x) * 3242174889u + std::uint32_t(y) * 2447445414u;  // wraps: a fraction
  return static_cast<float>(steps >> 8) / 16777216.0f;
}

}  // namespace

std::vector<unsigned char> png_preview_bytes(const ViewImage& image, float exposure_stops, int compression) {
  require_whole(image);
  const float gain = std::exp2(exposure_stops);
  std::vector<unsigned char> bytes(3 * image.colour.size());
  parallel_ranges(image.height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < image.width; ++x) {
        const std::size_t i = std::size_t(y) * image.width + x;
        const glm::vec3 shown = tone_map(gain * glm::vec3(image.colour[i]));
        for (int c = 0; c < 3; ++c)
          bytes[3 * i + c] =
              static_cast<unsigned char>(std::min(255 * srgb_transfer(std::min(shown[c], 1.0f)) + dither(x, y), 255.0f));
      }
  });
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("Software", "Turbid " TURBID_VERSION);
  spec.attribute("png:compressionLevel", compression);
  return encode_image("a picture", "png", spec, OIIO::TypeDesc::UINT8, bytes.data());
}

void write_png_preview(const ViewImage& image, float exposure_stops, const std::string& path) {
  const std::vector<unsigned char> bytes = png_preview_bytes(image, exposure_stops);
  write_file_atomically(path, bytes.data(), bytes.size());
}

float automatic_exposure(const ViewImage& image) {
  std::vector<float> covered, all;
  for (const glm::vec4& c : image.colour) {
    const float y = luminance(glm::vec3(c));
    if (!std::isfinite(y)) continue;
    all.push_back(y);
    if (c.a >= 0.5f) covered.push_back(y);
  }
  for (std::vector<float>* values : {&covered, &all}) {
    if (values->empty()) continue;
    const auto at = values->begin() + static_cast<std::ptrdiff_t>(kBrightPercentile * float(values->size() - 1));
    std::nth_element(values->begin(), at, values->end());
    // Nearly everything may be black, as with a small bright object: then its brightest point counts.
    const float bright = *at > 0 ? *at : *std::max_element(values->begin(), values->end());
    if (bright > 0) return std::log2(inverse_tone_curve(kNearWhite) / bright);
  }
  return 0;
}

}  // namespace turbid
