// SPDX-License-Identifier: Apache-2.0
// See scale.h.
#include "host/report/scale.h"

#include <algorithm>
#include <cmath>

#include "host/report/markup.h"
#include "host/report/table.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

constexpr double kRoom = 0.06;      // around the data, of the axis' length
constexpr double kMostMinor = 7;    // decades; with more, minor ticks are a grey smear
constexpr double kLargest = 1e250;  // differences and ratios of what is shown stay finite
constexpr const char* kTimes = "\xC3\x97";

/// 1, 2 or 5 times a power of ten, the least that gives at most `wanted` steps in the span.
double nice_step(double span, int wanted) {
  const double rough = span / std::max(wanted, 1);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

Ticks linear_ticks(const Scale& scale, int wanted) {
  Ticks result;
  const double step = nice_step(scale.high - scale.low, wanted);
  const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
  const int exponent = static_cast<int>(std::floor(std::log10(largest)));
  const int factored = exponent >= 5 || exponent < -3 ? exponent : 0;
  if (factored != 0) result.factor = kTimes + std::string("10^") + std::to_string(factored);
  const double unit = std::pow(10.0, factored);
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step / unit) - 1e-9)), 0, 12);
  const double first = std::ceil(scale.low / step - 1e-9), last = std::floor(scale.high / step + 1e-9);
  if (last - first > 50) return result;  // the range is below the numbers' precision
  for (double i = first; i <= last; ++i) {
    const double at = i == 0 ? 0 : i * step;
    result.ticks.push_back({at, with_power_of_ten(line("%.*f", decimals, at / unit))});
  }
  return result;
}

std::string log_label(int digit, int power, bool plain) {
  if (plain) return number_text(digit * std::pow(10.0, power), 1, NumberStyle::significant);
  return (digit == 1 ? "" : std::to_string(digit) + kTimes) + "10^" + std::to_string(power);
}

Ticks log_ticks(const Scale& scale, int wanted) {
  const double low = std::log10(scale.low), high = std::log10(scale.high);
  const int first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::ceil(high));
  const int stride = std::max(1, static_cast<int>(std::ceil((high - low) / std::max(wanted, 1))));
  const bool plain = std::ceil(low) >= -2 && std::floor(high) <= 4;
  const double decades = high - low;
  // Which digits of a decade have labels: 1 alone, 1 2 5, or all of them.
  const auto labelled = [&](int digit) {
    if (digit == 1 || decades < 0.5) return true;
    return decades < 1.75 && (digit == 2 || digit == 5);
  };
  Ticks result;
  for (int power = first; power <= last; ++power)
    for (int digit = 1; digit <= 9; ++digit) {
      const double at = digit * std::pow(10.0, power);
      if (at < scale.low * (1 - 1e-9) || at > scale.high * (1 + 1e-9)) continue;
      const bool named = labelled(digit) && (digit != 1 || power % stride == 0);
      if (named || decades <= kMostMinor || digit == 1)
        result.ticks.push_back({at, named ? log_label(digit, power, plain) : ""});
    }
  const auto names =
      std::count_if(result.ticks.begin(), result.ticks.end(), [](const Tick& t) { return !t.label.empty(); });
  // Less than from one digit to the next: as on a linear axis.
  return names >= 2 ? result : linear_ticks(scale, wanted);
}

}  // namespace

bool showable(const Axis& axis, double value) {
  return std::abs(value) <= kLargest && (!axis.log || value >= 1 / kLargest);
}

double Scale::operator()(double value) const {
  const double part =
      log ? (std::log(value) - std::log(low)) / (std::log(high) - std::log(low)) : (value - low) / (high - low);
  return from + (to - from) * part;
}

Scale fitted_scale(const Axis& axis, const std::vector<double>& values) {
  Scale scale;
  scale.log = axis.log;
  if (axis.range && showable(axis, axis.range->first) && showable(axis, axis.range->second) &&
      axis.range->first < axis.range->second) {
    scale.low = axis.range->first;
    scale.high = axis.range->second;
    return scale;
  }
  bool any = false;
  for (const double value : values) {
    if (!showable(axis, value)) continue;
    scale.low = any ? std::min(scale.low, value) : value;
    scale.high = any ? std::max(scale.high, value) : value;
    any = true;
  }
  if (!any) return {axis.log ? 0.1 : 0.0, axis.log ? 10.0 : 1.0, axis.log};
  if (axis.log) {
    const double decades = std::log10(scale.high) - std::log10(scale.low);
    const double room = decades < 0.005 ? 2.0 : std::pow(10.0, kRoom * decades);
    scale.low /= room;
    scale.high *= room;
    return scale;
  }
  const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
  double room = kRoom * (scale.high - scale.low);
  if (!(scale.high - scale.low > 1e-9 * largest)) room = largest > 0 ? 0.5 * largest : 1;
  // Zero is part of the picture when the data come near it, and no room is needed beyond it.
  const bool from_zero = scale.low >= 0 && scale.low <= 0.4 * scale.high;
  scale.low = from_zero ? 0 : scale.low - room;
  scale.high += room;
  return scale;
}

Ticks ticks_for(const Scale& scale, int wanted) {
  return scale.log ? log_ticks(scale, wanted) : linear_ticks(scale, wanted);
}

}  // namespace turbid
