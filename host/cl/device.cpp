// SPDX-License-Identifier: Apache-2.0
// Queries platforms and devices and applies the order of preference.
#include "host/cl/device.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "host/base/errors.h"
#include "host/cl/handle.h"

namespace turbid::cl {
namespace {

std::string platform_text(cl_platform_id platform, cl_platform_info what) {
  std::size_t size = 0;
  if (clGetPlatformInfo(platform, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  clGetPlatformInfo(platform, what, size, text.data(), nullptr);
  text.resize(size - 1);
  return text;
}

std::string device_text(cl_device_id device, cl_device_info what) {
  std::size_t size = 0;
  if (clGetDeviceInfo(device, what, 0, nullptr, &size) != CL_SUCCESS || size == 0) return {};
  std::string text(size, '\0');
  clGetDeviceInfo(device, what, size, text.data(), nullptr);
  text.resize(size - 1);
  return text;
}

template <class T>
T device_value(cl_device_id device, cl_device_info what) {
  T value{};
  clGetDeviceInfo(device, what, sizeof(T), &value, nullptr);
  return value;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

DeviceInfo describe(cl_platform_id platform, cl_device_id device, int p, int d) {
  DeviceInfo info;
  info.platform = platform;
  info.device = device;
  info.platform_index = p;
  info.device_index = d;
  info.platform_name = platform_text(platform, CL_PLATFORM_NAME);
  info.name = device_text(device, CL_DEVICE_NAME);
  info.vendor = device_text(device, CL_DEVICE_VENDOR);
  info.driver = device_text(device, CL_DRIVER_VERSION);
  info.version = device_text(device, CL_DEVICE_VERSION);
  const auto type = device_value<cl_device_type>(device, CL_DEVICE_TYPE);
  info.cpu = (type & CL_DEVICE_TYPE_CPU) != 0;
  info.gpu = (type & CL_DEVICE_TYPE_GPU) != 0;
  info.pocl = lower_case(info.platform_name).find("portable computing language") != std::string::npos;
  info.compute_units = static_cast<int>(device_value<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS));
  info.global_memory = device_value<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
  info.max_allocation = device_value<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
  info.int64_atomics =
      device_text(device, CL_DEVICE_EXTENSIONS).find("cl_khr_int64_base_atomics") != std::string::npos;
  info.little_endian = device_value<cl_bool>(device, CL_DEVICE_ENDIAN_LITTLE) == CL_TRUE;
  return info;
}

}  // namespace

std::string DeviceInfo::label() const {
  return std::to_string(platform_index) + ":" + std::to_string(device_index) + " \"" + name + "\" (" +
         (pocl ? "PoCL" : platform_name) + ")";
}

std::string DeviceInfo::why_unusable() const {
  if (!int64_atomics) return "lacks cl_khr_int64_base_atomics, which the deposit of light needs";
  if (!little_endian) return "is big-endian";
  return {};
}

std::string installation_hint() {
  return "no OpenCL platform found; install PoCL, which runs on any CPU: apt-get install pocl-opencl-icd "
         "(or your GPU vendor's OpenCL driver)";
}

std::vector<DeviceInfo> list_devices() {
  cl_uint platform_count = 0;
  // The loader answers CL_PLATFORM_NOT_FOUND_KHR (-1001) where no driver is installed: no devices, not an error.
  if (clGetPlatformIDs(0, nullptr, &platform_count) != CL_SUCCESS || platform_count == 0) return {};
  std::vector<cl_platform_id> platforms(platform_count);
  check(clGetPlatformIDs(platform_count, platforms.data(), nullptr), "clGetPlatformIDs");
  std::vector<DeviceInfo> found;
  for (cl_uint p = 0; p < platform_count; ++p) {
    cl_uint device_count = 0;
    if (clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, 0, nullptr, &device_count) != CL_SUCCESS) continue;
    std::vector<cl_device_id> devices(device_count);
    check(clGetDeviceIDs(platforms[p], CL_DEVICE_TYPE_ALL, device_count, devices.data(), nullptr), "clGetDeviceIDs");
    for (cl_uint d = 0; d < device_count; ++d) {
      found.push_back(describe(platforms[p], devices[d], static_cast<int>(p), static_cast<int>(d)));
    }
  }
  return found;
}

DeviceChoice choose_device(const std::string& wanted_argument) {
  const std::vector<DeviceInfo> devices = list_devices();
  if (devices.empty()) throw InputError(installation_hint());
  std::string wanted = wanted_argument;
  std::string origin = "--device";
  if (wanted.empty()) {
    if (const char* variable = std::getenv("TURBID_DEVICE")) {
      wanted = variable;
      origin = "TURBID_DEVICE";
    }
  }
  if (!wanted.empty()) {
    for (const DeviceInfo& device : devices) {
      const std::string number = std::to_string(device.platform_index) + ":" + std::to_string(device.device_index);
      const bool matches = wanted == number ||
                           lower_case(device.name).find(lower_case(wanted)) != std::string::npos ||
                           lower_case(device.platform_name).find(lower_case(wanted)) != std::string::npos;
      if (!matches) continue;
      if (const std::string why = device.why_unusable(); !why.empty()) {
        throw InputError(origin + " " + wanted + ": device " + device.label() + " " + why);
      }
      return {device, "asked for by " + origin + " " + wanted};
    }
    std::string list;
    for (const DeviceInfo& device : devices) list += (list.empty() ? "" : ", ") + device.label();
    throw InputError(origin + " " + wanted + ": no such OpenCL device; there is: " + list);
  }
  const DeviceInfo* fallback = nullptr;
  for (const DeviceInfo& device : devices) {
    if (!device.why_unusable().empty()) continue;
    if (device.pocl && device.cpu) return {device, "the first PoCL CPU device, the default that always works"};
    if (!fallback || (device.gpu && !fallback->gpu)) fallback = &device;
  }
  if (fallback) return {*fallback, "no PoCL CPU device is installed, this is the first other usable device"};
  throw InputError("none of the OpenCL devices can run Turbid: " + devices.front().label() + " " +
                   devices.front().why_unusable());
}

}  // namespace turbid::cl
