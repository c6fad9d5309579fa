// SPDX-License-Identifier: Apache-2.0
// See report_context.h.
#include "host/report/report_context.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>
#include <thread>

#include "host/report/scene_report.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

/// As Linux names it; else the kind of machine alone.
std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  for (std::string one; std::getline(cpuinfo, one);)
    if (one.starts_with("model name")) {
      const std::size_t at = one.find(": ");
      if (at != std::string::npos) return one.substr(at + 2);
    }
  utsname names{};
  return uname(&names) == 0 ? names.machine : "unknown";
}

std::string memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && size > 0 ? megabytes(std::uint64_t(pages) * std::uint64_t(size)) : "unknown";
}

std::string load_average() {
  double loads[3];
  return getloadavg(loads, 3) == 3 ? line("%.2f %.2f %.2f", loads[0], loads[1], loads[2]) : "unknown";
}

std::string date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &utc);
  return text;
}

}  // namespace

NamedTexts report_context(const std::string& command_line, const cl::DeviceInfo* device) {
  NamedTexts context{{"command", command_line}, {"version", "Turbid " TURBID_VERSION}, {"compiler", __VERSION__}};
  if (device) {
    context.emplace_back("device", device->label());
    context.emplace_back("platform", device->platform_name + ", " + device->version);
    context.emplace_back("driver", device->driver);
    context.emplace_back("compute units", std::to_string(device->compute_units));
  }
  context.emplace_back("processor", processor());
  context.emplace_back("threads", std::to_string(std::thread::hardware_concurrency()));
  context.emplace_back("memory", memory());
  context.emplace_back("load (1, 5, 15 min)", load_average());
  context.emplace_back("date", date());
  return context;
}

}  // namespace turbid
