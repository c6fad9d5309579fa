// SPDX-License-Identifier: Apache-2.0
// Move-only owners of OpenCL objects, and the check that turns an OpenCL status into a DeviceError.
#pragma once
#include <CL/cl.h>

#include <string>
#include <utility>

namespace turbid::cl {

/// Throws DeviceError "<what>: <name of status>" unless status is CL_SUCCESS.
void check(cl_int status, const char* what);
/// The symbolic name of an OpenCL status, e.g. CL_OUT_OF_RESOURCES.
std::string status_name(cl_int status);

/// Releases its object when it goes out of scope.
template <class T, cl_int (*Release)(T)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(T object) : object_(object) {}
  Handle(Handle&& other) noexcept : object_(std::exchange(other.object_, nullptr)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (object_) Release(object_);
  }
  T get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  T object_ = nullptr;
};

using ContextHandle = Handle<cl_context, clReleaseContext>;
using QueueHandle = Handle<cl_command_queue, clReleaseCommandQueue>;
using ProgramHandle = Handle<cl_program, clReleaseProgram>;
using KernelHandle = Handle<cl_kernel, clReleaseKernel>;
using MemoryHandle = Handle<cl_mem, clReleaseMemObject>;
using EventHandle = Handle<cl_event, clReleaseEvent>;

}  // namespace turbid::cl
