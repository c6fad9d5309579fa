// SPDX-License-Identifier: Apache-2.0
// One line of `turbid bench goals`: a ratio measured side by side in one run, and what it should be.
#pragma once
#include <string>

namespace turbid {

struct Goal {
  std::string name;
  double ratio = 0;        ///< measured [-]; for iterations and exponents the number itself
  double aim = 0;
  bool at_least = true;    ///< the ratio shall not be below the aim; else not above it
  std::string ours;        ///< what was measured, with its figure
  std::string against;     ///< what it was measured against, with its figure
  std::string error;       ///< the error at which it was reached: how far the two answers differ
  bool passed() const;     ///< false for a ratio that is not a number
};

}  // namespace turbid
