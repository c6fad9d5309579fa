// SPDX-License-Identifier: Apache-2.0
// From values to places on paper: the range of an axis and its ticks. Private to host/report.
#pragma once
#include <string>
#include <vector>

#include "host/report/plot.h"

namespace turbid {

/// Whether an axis can show the value: finite, and positive on a logarithmic one.
bool showable(const Axis&, double value);

/// Maps [low, high] to [from, to], which may run either way.
struct Scale {
  double low = 0, high = 1;
  bool log = false;
  double from = 0, to = 1;

  double operator()(double value) const;
  bool contains(double value) const { return value >= low && value <= high; }
};

/// The axis' own range if it is usable, else that of the values it can show, with some room around them; never empty.
Scale fitted_scale(const Axis&, const std::vector<double>& values);

struct Tick {
  double at = 0;
  std::string label = {};  ///< empty: a minor tick
};

struct Ticks {
  std::vector<Tick> ticks;
  std::string factor;  ///< what the labels are to be multiplied by, "×10^-5"; mostly empty
};

/// About `wanted` labelled ticks, at least two where the range allows it. Linear: steps of 1, 2, 5. Logarithmic: powers
/// of ten with minor ticks between them, fewer if there are many, and 2 and 5 too if there are few.
Ticks ticks_for(const Scale&, int wanted);

}  // namespace turbid
