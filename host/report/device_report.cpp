// SPDX-License-Identifier: Apache-2.0
// See device_report.h.
#include "host/report/device_report.h"

#include <cstdio>

#include "host/report/json_parts.h"
#include "host/report/scene_report.h"

namespace turbid {
namespace {

bool chosen(const cl::DeviceInfo& device, const std::optional<cl::DeviceChoice>& choice) {
  return choice && choice->device.device == device.device;
}

}  // namespace

std::string devices_text(const std::vector<cl::DeviceInfo>& devices, const std::optional<cl::DeviceChoice>& choice) {
  std::string text;
  for (const cl::DeviceInfo& d : devices) {
    const std::string why = d.why_unusable();
    text += d.label() + (chosen(d, choice) ? "  <- would be used: " + choice->reason : "") + "\n";
    text += "    " + d.platform_name + ", " + d.version + ", driver " + d.driver + "\n";
    text += "    " +
            std::string(d.gpu   ? "GPU"
                        : d.cpu ? "CPU"
                                : "other") +
            ", " + std::to_string(d.compute_units) + " compute units, " + megabytes(d.global_memory) + ", at most " +
            megabytes(d.max_allocation) + " at once\n";
    if (!why.empty()) text += "    can't be used: it " + why + "\n";
  }
  return text;
}

std::string devices_json(const std::vector<cl::DeviceInfo>& devices, const std::optional<cl::DeviceChoice>& choice,
                         const std::string& problem) {
  Json list = Json::array();
  for (const cl::DeviceInfo& d : devices) {
    Json part = device_part(d);
    part["usable"] = d.why_unusable().empty();
    part["chosen"] = chosen(d, choice);
    list.push_back(part);
  }
  Json json{{"format", "turbid devices 1"}, {"devices", list}};
  if (choice) json["reason"] = choice->reason;
  if (!problem.empty()) json["problem"] = problem;
  return document(json);
}

}  // namespace turbid
