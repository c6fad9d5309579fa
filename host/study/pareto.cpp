// SPDX-License-Identifier: Apache-2.0
// See pareto.h.
#include "host/study/pareto.h"

#include <cmath>

namespace turbid {
namespace {

constexpr double kSameError = 0.01;

bool usable(const SettingRun& run) {
  return std::isfinite(run.error) && std::isfinite(run.seconds) && run.error >= 0 && run.seconds >= 0;
}

bool dominates(const SettingRun& a, const SettingRun& b) {
  return (a.seconds < b.seconds && a.error <= (1 + kSameError) * b.error) ||
         (a.seconds <= b.seconds && a.error < b.error);
}

}  // namespace

void mark_efficient(std::vector<SettingRun>& runs) {
  for (SettingRun& run : runs) {
    run.efficient = usable(run);
    for (const SettingRun& other : runs)
      if (usable(other) && dominates(other, run)) run.efficient = false;
  }
}

std::optional<std::size_t> recommended(const std::vector<SettingRun>& runs, double aim) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (usable(runs[i]) && runs[i].error <= aim && (!best || runs[i].seconds < runs[*best].seconds)) best = i;
  return best;
}

double photon_seconds(double error, double seconds, double at_error) {
  return seconds * (error / at_error) * (error / at_error);
}

}  // namespace turbid
