// SPDX-License-Identifier: Apache-2.0
// What all measurements share: sentences with figures in them, and a stopwatch.
#pragma once
#include <string>

#include "host/base/progress.h"

namespace turbid {

/// As printf; at most 399 characters.
std::string figures(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// Wall time of work() [s].
template <class Work>
double seconds_of(const Work& work) {
  const double start = wall_time();
  work();
  return wall_time() - start;
}

}  // namespace turbid
