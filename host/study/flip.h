// SPDX-License-Identifier: Apache-2.0
// FLIP: the difference that an observer sees who flips between two pictures, per pixel in [0, 1].
//   Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild 2020, "FLIP: A Difference Evaluator for
//   Alternating Images"; Andersson, Nilsson, Shirley, Akenine-Moller 2021, "Visualizing Errors in Rendered High Dynamic
//   Range Images".
// Pure functions; rows top down, x fastest.
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace turbid {

struct FlipSettings {
  /// Pixels per degree of the visual field: 0.7 m away from a screen 0.7 m wide of 3840 pixels, as in the papers.
  float pixels_per_degree = 67.0206f;
};

struct FlipMap {
  int width = 0, height = 0;
  std::vector<float> error;
  double mean = 0;
};

/// Of pictures as shown: sRGB-encoded values in [0, 1]; others are clamped and NaN is black.
FlipMap flip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width, int height,
             const FlipSettings& = {});

/// Exposures [stops] under which two linear pictures are looked at: evenly spaced from `start` to `stop`.
struct FlipExposures {
  float start = 0, stop = 0;
  int count = 1;
  float at(int i) const { return count > 1 ? start + (stop - start) * float(i) / float(count - 1) : start; }
};

/// From the one at which the brightest luminance of the reference is shown (by the ACES curve) at 0.85 to the one at
/// which its median is, a stop or less apart. Where the paper says nothing: black pixels are left out of the median if
/// that would be 0 without, and the range ends 23 stops (float's precision) above its start.
FlipExposures flip_exposures(std::span<const glm::vec3> reference);

/// HDR-FLIP of linear pictures: per pixel the largest FLIP over flip_exposures(reference).
FlipMap hdr_flip(std::span<const glm::vec3> test, std::span<const glm::vec3> reference, int width, int height,
                 const FlipSettings& = {});

}  // namespace turbid
