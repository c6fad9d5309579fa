// SPDX-License-Identifier: Apache-2.0
// A quantity measured several times.
#pragma once
#include <vector>

namespace turbid {

struct Spread {
  double min = 0, median = 0, max = 0;  ///< not a number if nothing was measured
  int count = 0;
  /// (max - min) / median [-]
  double relative() const { return (max - min) / median; }
};

Spread spread_of(std::vector<double> values);

/// Slope of log y over log x by least squares: the exponent p of y ~ x^p. Throws std::invalid_argument unless there are two
/// different x > 0 and all y > 0.
double exponent_of(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace turbid
