// SPDX-License-Identifier: Apache-2.0
// What `turbid compare` found, for people and as JSON.
#pragma once
#include <string>
#include <vector>

#include "host/study/error_measures.h"

namespace turbid {

/// A picture's colours, or a grid of a volume.
struct ComparedPart {
  std::string name;
  ErrorMeasures errors;
};

struct CompareReport {
  std::string a, b;  ///< files; b is the reference
  std::string kind;  ///< "picture" (sRGB-encoded), "linear picture" or "volume"
  std::vector<ComparedPart> parts;
  Measure measure;              ///< that decides
  double tolerance = 0;         ///< of that measure
  double trim = 0;              ///< of relmse, see MeasureSettings
  std::string difference = {};  ///< file written, if any

  /// A value that is not finite makes a part different, whatever the measure says of the others.
  bool alike(const ComparedPart&) const;
  bool alike() const;
  /// One sentence: the verdict and, if different, the part that lies farthest off.
  std::string verdict() const;
};

std::string compare_text(const CompareReport&);
/// Infinity (the psnr of equal values) and NaN become null.
std::string compare_json(const CompareReport&);

}  // namespace turbid
