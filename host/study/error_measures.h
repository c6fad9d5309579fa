// SPDX-License-Identifier: Apache-2.0
// How far values lie from reference values: the measures of `turbid compare` and of convergence studies. Pure
// functions.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace turbid {

struct MeasureSettings {
  /// epsilon of relMSE is (relative_floor * mean |b|)^2: 0.1 is the customary 0.01 for a picture exposed to a mean of
  /// 1, and does not depend on the unit of the values.
  double relative_floor = 0.1;
  /// Fraction of relMSE's largest terms that is left out, in [0, 1): 0.001 ignores a few fireflies. Others are
  /// unaffected.
  double trim = 0;
  /// Peak of PSNR in the unit of the values; 0 means the largest |b|.
  double peak = 0;
};

/// Of values a against reference values b. Pairs with a NaN or an infinity are left out of every measure and counted.
/// 0 / 0 counts as 0 and x / 0 as infinity.
struct ErrorMeasures {
  std::size_t values = 0;      ///< pairs compared, all finite
  std::size_t not_finite = 0;  ///< pairs left out
  double mae = 0;              ///< mean |a - b|
  double rmse = 0;             ///< sqrt(mean (a - b)^2)
  double linf = 0;             ///< max |a - b|
  double rel_l1 = 0;           ///< sum |a - b| / sum |b|
  double rel_l2 = 0;           ///< sqrt(sum (a - b)^2 / sum b^2)
  double relmse = 0;           ///< mean of (a - b)^2 / (b^2 + epsilon)
  double psnr = 0;             ///< 10 log10(peak^2 / mean (a - b)^2) [dB], infinite if all are equal
  double epsilon = 0;          ///< that of relmse
  double peak = 0;             ///< that of psnr
  std::optional<double> flip;  ///< mean FLIP error, in [0, 1]; for pictures only, filled in by who has the picture
};

/// The spans have one length.
ErrorMeasures measure_errors(std::span<const float> a, std::span<const float> b, const MeasureSettings& = {});

/// sqrt(sum (a - b)^2 / sum b^2); 0 / 0 is 0; not a number if any value is none, unlike measure_errors.
double relative_l2(std::span<const float> a, std::span<const float> b);
/// Root of `turbid compare`'s relMSE: sqrt(mean (a - b)^2 / (b^2 + (0.1 mean |b|)^2)), how far off a pixel is, relative
/// to itself. Unlike relative_l2 it is not ruled by a few bright pixels.
double root_relmse(std::span<const float> a, std::span<const float> b);

/// A measure by its name on the command line and in reports.
struct Measure {
  std::string name;
  std::string meaning;
  std::optional<double>
      tolerance;  ///< up to which (from which, for psnr) two files count as alike; none if it has a unit
  bool larger_is_better = false;

  double of(const ErrorMeasures&) const;  ///< NaN if it was not computed
  /// False for NaN.
  bool within(double value, double tolerance) const;
};

const std::vector<Measure>& measures();
/// Null if there is none of that name.
const Measure* find_measure(const std::string& name);

}  // namespace turbid
