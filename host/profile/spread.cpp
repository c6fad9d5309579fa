// SPDX-License-Identifier: Apache-2.0
// Order statistics, and the slope of a power law.
#include "host/profile/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace turbid {

Spread spread_of(std::vector<double> values) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNone, kNone, kNone, 0};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {values.front(), 0.5 * (values[(n - 1) / 2] + values[n / 2]), values.back(), static_cast<int>(n)};
}

double exponent_of(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  if (n != y.size()) throw std::invalid_argument("exponent_of: as many x as y");
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(x[i] > 0 && y[i] > 0)) throw std::invalid_argument("exponent_of: values must be > 0");
    mean_x += std::log(x[i]) / static_cast<double>(n);
    mean_y += std::log(y[i]) / static_cast<double>(n);
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double dx = std::log(x[i]) - mean_x;
    xx += dx * dx;
    xy += dx * (std::log(y[i]) - mean_y);
  }
  if (!(xx > 0)) throw std::invalid_argument("exponent_of: needs two different x");
  return xy / xx;
}

}  // namespace turbid
