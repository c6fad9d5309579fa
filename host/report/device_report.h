// SPDX-License-Identifier: Apache-2.0
// The list of OpenCL devices for `turbid devices`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/cl/device.h"

namespace turbid {

/// `problem`: why none was chosen.
std::string devices_json(const std::vector<cl::DeviceInfo>&, const std::optional<cl::DeviceChoice>&,
                         const std::string& problem);
std::string devices_text(const std::vector<cl::DeviceInfo>&, const std::optional<cl::DeviceChoice>&);

}  // namespace turbid
