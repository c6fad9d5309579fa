// SPDX-License-Identifier: Apache-2.0
// Summed-area tables give the mean over any square in constant time.
#include "host/transport/ground_light.h"

#include <algorithm>

#include "host/base/parallel.h"

namespace turbid {
namespace {

constexpr int kEnoughRays = 24;
constexpr int kLargestReach = 24;  // texels

class SummedArea {
 public:
  template <class Value>
  SummedArea(int size, const Value& value) : width_(size + 1), sums_(static_cast<std::size_t>(width_) * width_, 0.0) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        at(x + 1, y + 1) = value(y * size + x) + at(x, y + 1) + at(x + 1, y) - at(x, y);
      }
    }
  }
  /// Sum over [x0, x1) x [y0, y1).
  double sum(int x0, int y0, int x1, int y1) const { return at(x1, y1) - at(x0, y1) - at(x1, y0) + at(x0, y0); }

 private:
  double& at(int x, int y) { return sums_[static_cast<std::size_t>(y) * width_ + x]; }
  double at(int x, int y) const { return sums_[static_cast<std::size_t>(y) * width_ + x]; }
  int width_;
  std::vector<double> sums_;
};

}  // namespace

void smooth_ground_light(GroundLight* ground, const std::vector<int>& rays) {
  const int size = ground->size;
  if (size == 0) return;
  const SummedArea counts(size, [&](int i) { return static_cast<double>(rays[i]); });
  const SummedArea power[3] = {{size, [&](int i) { return static_cast<double>(ground->irradiance[i].r); }},
                               {size, [&](int i) { return static_cast<double>(ground->irradiance[i].g); }},
                               {size, [&](int i) { return static_cast<double>(ground->irradiance[i].b); }}};
  parallel_ranges(size, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < size; ++x) {
        for (int reach = 0; reach <= kLargestReach; ++reach) {
          const int x0 = std::max(x - reach, 0), x1 = std::min(x + reach + 1, size);
          const int y0 = std::max(y - reach, 0), y1 = std::min(y + reach + 1, size);
          if (counts.sum(x0, y0, x1, y1) < kEnoughRays && reach < kLargestReach) continue;
          const double area = static_cast<double>(x1 - x0) * (y1 - y0);
          for (int c = 0; c < 3; ++c)
            ground->irradiance[y * size + x][c] = static_cast<float>(power[c].sum(x0, y0, x1, y1) / area);
          break;
        }
      }
  });
}

}  // namespace turbid
