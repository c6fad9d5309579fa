// SPDX-License-Identifier: Apache-2.0
// HDR-FLIP: linear pictures shown at all exposures that show something of the reference.   [Andersson et al. 2021]
#include <algorithm>
#include <cmath>

#include "host/study/flip_pair.h"

namespace turbid {
namespace {

constexpr float kShownAt = 0.85f;  ///< t: what the brightest and the median luminance are mapped to
constexpr float kMostStops = 23;

/// The ACES curve as Narkowicz fitted it (2016), for scene values times 0.6: (a x^2 + b x) / (c x^2 + d x + e).
constexpr float kA = 0.36f * 2.51f, kB = 0.6f * 0.03f, kC = 0.36f * 2.43f, kD = 0.6f * 0.59f, kE = 0.14f;

float aces(float x) {
  if (!(x > 0)) return 0;  // NaN too
  const float y = std::min(x, 1e6f);
  return std::clamp((kA * y * y + kB * y) / (kC * y * y + kD * y + kE), 0.0f, 1.0f);
}

/// Where the curve reaches kShownAt.
float shown_at() {
  const float a = kA - kShownAt * kC, b = kB - kShownAt * kD, c = -kShownAt * kE;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

/// The upper one of the two middle ones of an even number, as in the authors' program.
float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

FlipExposures flip_exposures(std::span<const glm::vec3> reference) {
  std::vector<float> luminances;
  luminances.reserve(reference.size());
  for (const glm::vec3& pixel : reference) {
    const float y = glm::dot(pixel, glm::vec3(0.2126f, 0.7152f, 0.0722f));
    luminances.push_back(std::isfinite(y) ? std::max(y, 0.0f) : 0.0f);
  }
  if (luminances.empty()) return {};
  const float brightest = *std::max_element(luminances.begin(), luminances.end());
  if (brightest == 0) return {};
  float middle = median(luminances);
  if (middle == 0) {
    std::erase(luminances, 0.0f);
    middle = median(luminances);
  }
  FlipExposures exposures;
  exposures.start = std::log2(shown_at() / brightest);
  exposures.stop = std::min(std::log2(shown_at() / middle), exposures.start + kMostStops);
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop - exposures.start)));
  return exposures;
}

FlipMap hdr_flip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width, int height,
                 const FlipSettings& settings) {
  const FlipPair pair(width, height, settings);
  pair.require_size(test.size(), reference.size());
  const FlipExposures exposures = flip_exposures(reference);
  std::vector<glm::vec3> test_shown(test.size()), reference_shown(reference.size());
  std::vector<float> error(test.size(), 0.0f);
  for (int e = 0; e < exposures.count; ++e) {
    const float gain = std::exp2(exposures.at(e));
    const auto show = [&](std::span<const glm::vec3> linear, std::vector<glm::vec3>& shown) {
      for (std::size_t i = 0; i < linear.size(); ++i)
        for (int c = 0; c < 3; ++c) shown[i][c] = aces(gain * linear[i][c]);
    };
    show(test, test_shown);
    show(reference, reference_shown);
    const std::vector<float> one = pair.compare(test_shown, reference_shown);
    for (std::size_t i = 0; i < error.size(); ++i) error[i] = std::max(error[i], one[i]);
  }
  return flip_map(width, height, std::move(error));
}

}  // namespace turbid
