// SPDX-License-Identifier: Apache-2.0
// How much memory this process has taken at the most, from what Linux counts in /proc/self/status.
#pragma once
#include <cstdint>

namespace turbid {

/// Largest resident set [bytes] since the process or the last reset_peak_memory() began; 0 where the system does not
/// say.
std::uint64_t peak_memory();
/// Starts the count anew from what is resident now. Does nothing where the system does not allow it.
void reset_peak_memory();

}  // namespace turbid
