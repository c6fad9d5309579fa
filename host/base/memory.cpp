// SPDX-License-Identifier: Apache-2.0
// See memory.h.
#include "host/base/memory.h"

#include <fstream>
#include <string>

namespace turbid {

std::uint64_t peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    std::uint64_t kibibytes = 0;
    status >> kibibytes;
    return kibibytes * 1024;
  }
  return 0;
}

void reset_peak_memory() {
  std::ofstream("/proc/self/clear_refs") << "5\n";  // Linux 4.0: resets VmHWM
}

}  // namespace turbid
