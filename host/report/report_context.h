// SPDX-License-Identifier: Apache-2.0
// What a figure depends on and does not show: who made it, where, when, under which load.
#pragma once
#include <string>

#include "host/cl/device.h"
#include "host/report/named_texts.h"

namespace turbid {

/// Command line, version, device, driver, machine (processor, cores, memory), load average and date; options and the
/// like are the caller's to add. `device`: null for what ran without one.
NamedTexts report_context(const std::string& command_line, const cl::DeviceInfo* device);

}  // namespace turbid
