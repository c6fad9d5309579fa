// SPDX-License-Identifier: Apache-2.0
// Gradient noise on a hashed integer lattice: see noise.h.
#include "volumes/noise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace turbid {
namespace {

// Twelve unit-edge gradients at the corners of the cell reach 1.0364 at the most (searched over the cell).
constexpr double kScale = 1.0 / 1.0366;

// Finaliser of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input reaches every bit of the result.
std::uint64_t mix(std::uint64_t h) {
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ull;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebull;
  return h ^ (h >> 31);
}

double gradient_dot(std::uint64_t h, double x, double y, double z) {
  const int edge = static_cast<int>((h >> 32) % 12);
  const double u = edge < 8 ? x : y;
  const double v = edge < 4 ? y : z;
  return ((edge & 1) ? -u : u) + ((edge & 2) ? -v : v);
}

double fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}
double lerp(double t, double a, double b) {
  return a + t * (b - a);
}

}  // namespace

double gradient_noise(double x, double y, double z) {
  constexpr double limit = 9e15;  // beyond 2^53 every double is an integer, where the noise is 0
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return std::numeric_limits<double>::quiet_NaN();
  if (std::max({std::fabs(x), std::fabs(y), std::fabs(z)}) > limit) return 0.0;
  const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const auto i = static_cast<std::int64_t>(fx), j = static_cast<std::int64_t>(fy), k = static_cast<std::int64_t>(fz);
  x -= fx;
  y -= fy;
  z -= fz;
  double corner[2][2][2];
  // The corners' hashes are of i, then j, then k: those of a line or plane begin alike.
  for (int a = 0; a < 2; ++a) {
    const std::uint64_t of_x = mix(static_cast<std::uint64_t>(i + a) + 0x9e3779b97f4a7c15ull);
    for (int b = 0; b < 2; ++b) {
      const std::uint64_t of_xy = mix(of_x + static_cast<std::uint64_t>(j + b));
      for (int c = 0; c < 2; ++c) {
        corner[c][b][a] = gradient_dot(mix(of_xy + static_cast<std::uint64_t>(k + c)), x - a, y - b, z - c);
      }
    }
  }
  const double u = fade(x), v = fade(y), w = fade(z);
  const double lower = lerp(v, lerp(u, corner[0][0][0], corner[0][0][1]), lerp(u, corner[0][1][0], corner[0][1][1]));
  const double upper = lerp(v, lerp(u, corner[1][0][0], corner[1][0][1]), lerp(u, corner[1][1][0], corner[1][1][1]));
  return kScale * lerp(w, lower, upper);
}

double fractal_noise(double x, double y, double z, int octaves) {
  double sum = 0.0, amplitude = 1.0;
  for (int octave = 0; octave < std::clamp(octaves, 1, 16); ++octave) {
    sum += amplitude * gradient_noise(x, y, z);
    amplitude *= 0.5;
    // The shift keeps the zeros at integer points of one octave away from those of the next.
    x = 2.0 * x + 0.3127;
    y = 2.0 * y + 0.5791;
    z = 2.0 * z + 0.7363;
  }
  return sum;
}

}  // namespace turbid
