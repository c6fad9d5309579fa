// SPDX-License-Identifier: Apache-2.0
// Which of many measured settings are worth using: speed against error. Pure functions.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace turbid {

struct SettingRun {
  std::string setting;  ///< as -D flags would say it
  std::string solver = {};
  double error = 0;          ///< relative L2 of the fluence against the reference
  double picture_error = 0;  ///< root of relMSE; NaN without a picture
  double seconds = 0;
  std::uint64_t peak_memory = 0;  ///< [bytes]
  bool efficient = false;         ///< see mark_efficient
};

/// Sets `efficient`: no run is faster and as accurate to 1 %, which is more than such errors are known to, and none is
/// as fast and more accurate. Of equal runs all are. A run whose error or time is not a positive number or zero is not.
void mark_efficient(std::vector<SettingRun>&);
/// Index of the fastest run whose error is at most `aim`; nothing if there is none.
std::optional<std::size_t> recommended(const std::vector<SettingRun>&, double aim);
/// Monte Carlo: time [s] to an error, from one run's time and standard error: error ~ 1 / sqrt(time).
double photon_seconds(double error, double seconds, double at_error);

}  // namespace turbid
