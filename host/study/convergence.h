// SPDX-License-Identifier: Apache-2.0
// How fast an error falls when a parameter h (voxel size, step, 1 / sqrt(photons), ...) does: error ~ C h^order.
#pragma once
#include <optional>
#include <span>

namespace turbid {

struct Level {
  double h = 0, error = 0;
};

/// From two levels: log(coarse.error / fine.error) / log(coarse.h / fine.h). NaN unless both errors are positive and
/// the h differ.
double observed_order(Level coarse, Level fine);

struct FittedOrder {
  double order = 0;     ///< slope of log error over log h by least squares
  double constant = 0;  ///< C in error = C h^order
  double low = 0;       ///< 95 % confidence interval of the order, by Student's t with levels - 2 degrees of freedom;
  double high = 0;      ///< minus and plus infinity for two levels, which say nothing of their own scatter
  int levels = 0;       ///< that were used: those with a positive error

  bool includes(double expected) const { return low <= expected && expected <= high; }
};

/// Nothing if fewer than two levels with different h have a positive, finite error.
std::optional<FittedOrder> fitted_order(std::span<const Level> levels);

/// The 97.5 % point of Student's t distribution: half the width of a 95 % interval in standard errors.
double student_t_975(int degrees_of_freedom);

struct Sample {
  double h = 0, value = 0;
};

struct Extrapolated {
  double value = 0;  ///< at h = 0
  double order = 0;  ///< that was used
  double error = 0;  ///< |fine.value - value|, what the finest level is estimated to miss
};

/// Richardson: the value at h = 0 if value(h) = value(0) + C h^order. The h differ, order > 0.
Extrapolated richardson(Sample coarse, Sample fine, double order);

/// The same with the order that three levels show, whatever the ratios of their h. Nothing if the values do not
/// converge monotonically (differences of changed sign, growing as h falls, or none), where an order would mean
/// nothing.
std::optional<Extrapolated> richardson(Sample coarse, Sample medium, Sample fine);

}  // namespace turbid
