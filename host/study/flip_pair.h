// SPDX-License-Identifier: Apache-2.0
// What LDR-FLIP and HDR-FLIP share: the filters of one picture size, and FLIP of two linear pictures in [0, 1]. Private
// to host/study/flip*.cpp.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "host/study/flip.h"

namespace turbid {

class FlipPair {
 public:
  FlipPair(int width, int height, const FlipSettings&);
  /// Throws std::invalid_argument if a picture of so many pixels is not of this size.
  void require_size(std::size_t test, std::size_t reference) const;
  std::vector<float> compare(std::span<const glm::vec3> test, std::span<const glm::vec3> reference) const;

 private:
  /// Blurred by the contrast sensitivity of each opponent channel; L*a*b* with Hunt's adjustment.
  std::vector<glm::vec3> seen_colours(std::span<const glm::vec3> linear) const;
  /// Strength of edges and of points in the luminance.
  std::vector<glm::vec2> features(std::span<const glm::vec3> linear) const;

  int width_, height_, colour_radius_ = 0, feature_radius_ = 0;
  std::vector<glm::vec4> colour_;   ///< luminance, red-green, blue-yellow wide and narrow; each sums to 1
  float wide_share_ = 1;            ///< of the wide one in blue-yellow
  std::vector<glm::vec3> feature_;  ///< Gaussian, first and second derivative
};

FlipMap flip_map(int width, int height, std::vector<float> error);

}  // namespace turbid
