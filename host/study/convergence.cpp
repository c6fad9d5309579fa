// SPDX-License-Identifier: Apache-2.0
// See convergence.h.
#include "host/study/convergence.h"

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace turbid {

double observed_order(Level coarse, Level fine) {  // error ~ C h^p
  if (!(coarse.error > 0 && fine.error > 0 && coarse.h > 0 && fine.h > 0 && coarse.h != fine.h))
    return std::numeric_limits<double>::quiet_NaN();
  return std::log(coarse.error / fine.error) / std::log(coarse.h / fine.h);
}

double student_t_975(int degrees_of_freedom) {
  static constexpr std::array<double, 5> kFew{std::numeric_limits<double>::infinity(), 12.7062047362, 4.3026527297,
                                              3.1824463053, 2.7764451052};
  if (degrees_of_freedom < 1) return kFew[0];
  if (degrees_of_freedom < static_cast<int>(kFew.size())) return kFew[static_cast<std::size_t>(degrees_of_freedom)];
  // Cornish-Fisher expansion about the normal's point (Abramowitz and Stegun 26.7.5); 0.1 % too small at 5.
  const double z = 1.959963984540054, z2 = z * z, n = degrees_of_freedom;
  return z + z * (z2 + 1) / (4 * n) + z * ((5 * z2 + 16) * z2 + 3) / (96 * n * n) +
         z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / (384 * n * n * n);
}

std::optional<FittedOrder> fitted_order(std::span<const Level> levels) {
  std::vector<double> x, y;
  for (const Level& level : levels) {
    if (!(level.h > 0 && level.error > 0 && std::isfinite(level.h) && std::isfinite(level.error))) continue;
    x.push_back(std::log(level.h));
    y.push_back(std::log(level.error));
  }
  const double n = static_cast<double>(x.size());
  if (x.size() < 2) return std::nullopt;
  double mean_x = 0, mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean_x += x[i] / n;
    mean_y += y[i] / n;
  }
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(xx > 0)) return std::nullopt;
  FittedOrder fit;
  fit.levels = static_cast<int>(x.size());
  fit.order = xy / xx;
  const double intercept = mean_y - fit.order * mean_x;
  fit.constant = std::exp(intercept);
  double half = std::numeric_limits<double>::infinity();
  if (fit.levels > 2) {
    double residual = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double miss = y[i] - intercept - fit.order * x[i];
      residual += miss * miss;
    }
    half = student_t_975(fit.levels - 2) * std::sqrt(residual / (n - 2) / xx);
  }
  fit.low = fit.order - half;
  fit.high = fit.order + half;
  return fit;
}

Extrapolated richardson(Sample coarse, Sample fine, double order) {
  if (!(coarse.h > 0 && fine.h > 0 && coarse.h != fine.h && order > 0))
    throw std::invalid_argument("richardson: needs two different h > 0 and an order > 0");
  const double step = (fine.value - coarse.value) / (std::pow(coarse.h / fine.h, order) - 1);
  return {fine.value + step, order, std::abs(step)};
}

std::optional<Extrapolated> richardson(Sample coarse, Sample medium, Sample fine) {
  if (!(coarse.h > medium.h && medium.h > fine.h && fine.h > 0))
    throw std::invalid_argument("richardson: needs three levels from coarse to fine");
  const double wide = coarse.value - medium.value, narrow = medium.value - fine.value;
  if (!(wide * narrow > 0)) return std::nullopt;
  // wide / narrow = (r^p - 1) / (1 - s^p) with r = coarse.h / medium.h, s = fine.h / medium.h: rises with p.
  const double found = wide / narrow, up = coarse.h / medium.h, down = fine.h / medium.h;
  const auto shown = [&](double p) { return (std::pow(up, p) - 1) / (1 - std::pow(down, p)); };
  double low = 1e-3, high = 16;  // of no use outside: no convergence, or rounding
  if (!(shown(low) < found && found < shown(high))) return std::nullopt;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (shown(middle) < found ? low : high) = middle;
  }
  return richardson(medium, fine, 0.5 * (low + high));
}

}  // namespace turbid
