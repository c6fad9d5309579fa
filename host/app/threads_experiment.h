// SPDX-License-Identifier: Apache-2.0
// How time falls with the cores that the device may use. PoCL takes their number from the environment as it loads, so each
// number is measured by a process of its own.
#pragma once
#include "host/bench/experiment.h"
#include "host/cl/device.h"

namespace turbid::app {

/// No rows, and a sentence why, on devices other than PoCL's.
Experiment measure_threads(const BenchSettings&, const cl::DeviceInfo&);

}  // namespace turbid::app
