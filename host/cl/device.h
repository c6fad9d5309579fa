// SPDX-License-Identifier: Apache-2.0
// Which OpenCL devices there are, and which one a run uses.
#pragma once
#include <CL/cl.h>

#include <cstdint>
#include <string>
#include <vector>

namespace turbid::cl {

struct DeviceInfo {
  cl_platform_id platform = nullptr;
  cl_device_id device = nullptr;
  int platform_index = 0, device_index = 0;  ///< `--device P:D` names it
  std::string platform_name, name, vendor, driver, version;
  bool cpu = false, gpu = false, pocl = false;
  int compute_units = 0;
  std::uint64_t global_memory = 0;      ///< [bytes]
  std::uint64_t max_allocation = 0;     ///< [bytes]
  bool int64_atomics = false;           ///< needed by the deposit
  bool little_endian = true;
  std::string label() const;            ///< e.g. `0:0 "pthread-skylake-avx512" (PoCL)`
  /// Empty if Turbid can run here, else what is missing.
  std::string why_unusable() const;
};

/// Every device of every platform; empty if there is none.
std::vector<DeviceInfo> list_devices();

struct DeviceChoice {
  DeviceInfo device;
  std::string reason;  ///< one clause: why this one
};

/// `wanted`: "P:D", or part of a device's or platform's name, or empty: environment variable TURBID_DEVICE, else the
/// first PoCL CPU device, else the first other usable device. Throws InputError that lists what there is (or says what to
/// install when there is no OpenCL at all).
DeviceChoice choose_device(const std::string& wanted);

/// One sentence on what to install when no OpenCL device is found.
std::string installation_hint();

}  // namespace turbid::cl
