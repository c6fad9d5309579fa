// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP. Two pipelines, after [Andersson et al. 2020] sections 4.1 and 4.2: colours, blurred as the eye blurs each
// opponent channel, and features (edges and points) of the luminance.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "host/base/parallel.h"
#include "host/study/flip_pair.h"

namespace turbid {
namespace {

constexpr float kPi = 3.14159265f;
constexpr float kColourExponent = 0.7f, kFeatureExponent = 0.5f;  // q_c, q_f
constexpr float kKneeAt = 0.4f, kKneeTo = 0.95f;                  // p_c, p_t
constexpr float kFeatureWidth = 0.082f;                           // w [degrees]

// Rec. 709 primaries and D65, divided by the white point row by row, so that white is (1, 1, 1).
const glm::mat3 kRgbToXyz = [] {
  const glm::mat3 rows(0.4123908f, 0.3575843f, 0.1804808f, 0.2126390f, 0.7151687f, 0.0721923f, 0.0193308f, 0.1191948f,
                       0.9505322f);
  glm::mat3 m(rows);
  for (int row = 0; row < 3; ++row) m[row] /= rows[row].x + rows[row].y + rows[row].z;
  return glm::transpose(m);
}();
const glm::mat3 kXyzToRgb = glm::inverse(kRgbToXyz);

/// Luminance, red-green, blue-yellow: YCxCz without its factors, which cancel because all that is done in it is linear.
glm::vec3 opponents(glm::vec3 linear) {
  const glm::vec3 xyz = kRgbToXyz * linear;
  return {xyz.y, xyz.x - xyz.y, xyz.y - xyz.z};
}
glm::vec3 from_opponents(glm::vec3 o) {
  return kXyzToRgb * glm::vec3(o.x + o.y, o.x, o.x - o.z);
}

float lab_curve(float t) {  // CIE 1976
  constexpr float kLinearBelow = 6.0f / 29;
  return t > kLinearBelow * kLinearBelow * kLinearBelow ? std::cbrt(t)
                                                        : t / (3 * kLinearBelow * kLinearBelow) + 4.0f / 29;
}

/// CIELAB, its chroma scaled by lightness after Hunt: dark colours look less colourful.
glm::vec3 hunt_lab(glm::vec3 linear) {
  const glm::vec3 xyz = kRgbToXyz * linear;
  const glm::vec3 f(lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z));
  const float lightness = 116 * f.y - 16;
  return {lightness, 0.01f * lightness * 500 * (f.x - f.y), 0.01f * lightness * 200 * (f.y - f.z)};
}

float hyab(glm::vec3 a, glm::vec3 b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

/// Large differences all look large: [0, p_c] of the largest possible one is stretched over [0, p_t].
float redistribute(float difference) {
  static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), kColourExponent);
  const float knee = kKneeAt * largest;
  if (difference < knee) return difference * kKneeTo / knee;
  return kKneeTo + (difference - knee) / (largest - knee) * (1 - kKneeTo);
}

int clamped(int i, int count) {
  return std::clamp(i, 0, count - 1);
}

/// For each row y of the picture, row(y) in parallel.
template <class Row>
void for_rows(int height, Row row) {
  parallel_ranges(height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) row(y);
  });
}

}  // namespace

FlipPair::FlipPair(int width, int height, const FlipSettings& settings) : width_(width), height_(height) {
  const float ppd = settings.pixels_per_degree;
  // Contrast sensitivity as sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees; blue-yellow has two.
  const glm::vec4 amplitude(1, 1, 34.1f, 13.5f), b(0.0047f, 0.0053f, 0.04f, 0.025f);
  colour_radius_ = static_cast<int>(std::ceil(3 * std::sqrt(0.04f / (2 * kPi * kPi)) * ppd));
  glm::vec4 sum(0);
  for (int i = -colour_radius_; i <= colour_radius_; ++i) {
    const float x = float(i) / ppd;
    colour_.push_back(glm::exp(-kPi * kPi * x * x / b));
    sum += colour_.back();
  }
  for (glm::vec4& weight : colour_) weight /= sum;
  const glm::vec4 share = amplitude * glm::sqrt(kPi / b) * sum * sum;
  wide_share_ = share.z / (share.z + share.w);

  // Gaussian, its first and second derivative; positive and negative weights of the derivatives sum to 1 and -1.
  const float deviation = 0.5f * kFeatureWidth * ppd;
  feature_radius_ = static_cast<int>(std::ceil(3 * deviation));
  glm::vec3 positive(0), negative(0);
  for (int i = -feature_radius_; i <= feature_radius_; ++i) {
    const float x = float(i), gauss = std::exp(-x * x / (2 * deviation * deviation));
    feature_.push_back(gauss * glm::vec3(1, -x, x * x / (deviation * deviation) - 1));
    positive += glm::max(feature_.back(), glm::vec3(0));
    negative -= glm::min(feature_.back(), glm::vec3(0));
  }
  negative.x = 1;
  for (glm::vec3& weight : feature_)
    for (int c = 0; c < 3; ++c) weight[c] /= weight[c] > 0 ? positive[c] : negative[c];
}

std::vector<glm::vec3> FlipPair::seen_colours(std::span<const glm::vec3> linear) const {
  std::vector<glm::vec4> along(linear.size());
  std::vector<glm::vec3> seen(linear.size());
  for_rows(height_, [&](int y) {
    std::vector<glm::vec4> row(width_);
    for (int x = 0; x < width_; ++x) {
      const glm::vec3 o = opponents(linear[std::size_t(y) * width_ + x]);
      row[x] = {o, o.z};
    }
    for (int x = 0; x < width_; ++x) {
      glm::vec4 sum(0);
      for (int k = -colour_radius_; k <= colour_radius_; ++k)
        sum += colour_[k + colour_radius_] * row[clamped(x + k, width_)];
      along[std::size_t(y) * width_ + x] = sum;
    }
  });
  for_rows(height_, [&](int y) {
    std::vector<glm::vec4> row(width_, glm::vec4(0));
    for (int k = -colour_radius_; k <= colour_radius_; ++k) {
      const glm::vec4* source = &along[std::size_t(clamped(y + k, height_)) * width_];
      for (int x = 0; x < width_; ++x) row[x] += colour_[k + colour_radius_] * source[x];
    }
    for (int x = 0; x < width_; ++x) {
      const glm::vec3 blurred(row[x].x, row[x].y, glm::mix(row[x].w, row[x].z, wide_share_));
      seen[std::size_t(y) * width_ + x] = hunt_lab(glm::clamp(from_opponents(blurred), 0.0f, 1.0f));
    }
  });
  return seen;
}

std::vector<glm::vec2> FlipPair::features(std::span<const glm::vec3> linear) const {
  std::vector<glm::vec3> along(linear.size());  // smoothed, first and second derivative along x
  std::vector<glm::vec2> found(linear.size());
  for_rows(height_, [&](int y) {
    std::vector<float> row(width_);
    for (int x = 0; x < width_; ++x) row[x] = opponents(linear[std::size_t(y) * width_ + x]).x;
    for (int x = 0; x < width_; ++x) {
      glm::vec3 sum(0);
      for (int k = -feature_radius_; k <= feature_radius_; ++k)
        sum += feature_[k + feature_radius_] * row[clamped(x + k, width_)];
      along[std::size_t(y) * width_ + x] = sum;
    }
  });
  for_rows(height_, [&](int y) {
    std::vector<glm::vec4> row(width_, glm::vec4(0));  // d/dx, d/dy, d2/dx2, d2/dy2
    for (int k = -feature_radius_; k <= feature_radius_; ++k) {
      const glm::vec3 weight = feature_[k + feature_radius_];
      const glm::vec3* source = &along[std::size_t(clamped(y + k, height_)) * width_];
      for (int x = 0; x < width_; ++x)
        row[x] +=
            glm::vec4(weight.x * source[x].y, weight.y * source[x].x, weight.x * source[x].z, weight.z * source[x].x);
    }
    for (int x = 0; x < width_; ++x)
      found[std::size_t(y) * width_ + x] = {std::hypot(row[x].x, row[x].y), std::hypot(row[x].z, row[x].w)};
  });
  return found;
}

std::vector<float> FlipPair::compare(std::span<const glm::vec3> test, std::span<const glm::vec3> reference) const {
  const auto test_seen = seen_colours(test), reference_seen = seen_colours(reference);
  const auto test_features = features(test), reference_features = features(reference);
  std::vector<float> error(test.size());
  for_rows(height_, [&](int y) {
    for (std::size_t i = std::size_t(y) * width_, end = i + width_; i < end; ++i) {
      const float colour = redistribute(std::pow(hyab(test_seen[i], reference_seen[i]), kColourExponent));
      const glm::vec2 change = glm::abs(test_features[i] - reference_features[i]);
      const float feature = std::pow(std::max(change.x, change.y) / std::sqrt(2.0f), kFeatureExponent);
      error[i] = std::pow(colour, 1 - std::min(feature, 1.0f));
    }
  });
  return error;
}

void FlipPair::require_size(std::size_t test, std::size_t reference) const {
  const std::size_t pixels = width_ > 0 && height_ > 0 ? std::size_t(width_) * height_ : 0;
  if (pixels == 0 || test != pixels || reference != pixels)
    throw std::invalid_argument("FLIP: needs width * height > 0 pixels in both pictures");
}

FlipMap flip_map(int width, int height, std::vector<float> error) {
  double sum = 0;
  for (const float value : error) sum += value;
  return {width, height, std::move(error), sum / (double(width) * height)};
}

FlipMap flip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width, int height,
             const FlipSettings& settings) {
  const FlipPair pair(width, height, settings);
  pair.require_size(test.size(), reference.size());
  const auto linear = [](std::span<const glm::vec3> shown) {
    std::vector<glm::vec3> values(shown.begin(), shown.end());
    for (glm::vec3& pixel : values)
      for (int c = 0; c < 3; ++c) {
        const float v = pixel[c] > 0 ? std::min(pixel[c], 1.0f) : 0.0f;                 // NaN becomes 0 too
        pixel[c] = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);  // IEC 61966-2-1
      }
    return values;
  };
  return flip_map(width, height, pair.compare(linear(test), linear(reference)));
}

}  // namespace turbid
