// SPDX-License-Identifier: Apache-2.0
// Context, queues and programs.
#include "host/cl/session.h"

#include <sstream>

#include "host/base/errors.h"
#include "host/cl/kernel_source.h"

namespace turbid::cl {

Queue::Queue(cl_context context, cl_device_id device) {
  cl_int status = CL_SUCCESS;
  handle_ = QueueHandle(clCreateCommandQueue(context, device, CL_QUEUE_PROFILING_ENABLE, &status));
  check(status, "creating a command queue");
}

void Queue::finish() { check(clFinish(handle_.get()), "waiting for the device"); }

KernelHandle Program::kernel(const char* name) const {
  cl_int status = CL_SUCCESS;
  KernelHandle handle(clCreateKernel(get(), name, &status));
  check(status, (file_ + ": kernel " + name).c_str());
  return handle;
}

Session::Session(const DeviceChoice& choice) : device_(choice.device) {
  cl_int status = CL_SUCCESS;
  context_ = ContextHandle(clCreateContext(nullptr, 1, &device_.device, nullptr, nullptr, &status));
  check(status, "creating an OpenCL context");
  march_ = std::make_unique<Queue>(context(), device_.device);
  lattice_ = std::make_unique<Queue>(context(), device_.device);
}

void Session::require_memory(std::size_t bytes) const {
  if (bytes <= device_.max_allocation) return;
  std::ostringstream text;
  text << "needs a buffer of " << bytes / 1048576 << " MB on " << device_.label() << ", which offers "
       << device_.max_allocation / 1048576 << " MB at once; lower the resolution";
  throw DeviceError(text.str());
}

Program Session::build(const std::string& file, const std::vector<Define>& defines) const {
  const std::string source = kernel_source(file);
  const char* pointer = source.c_str();
  const std::size_t length = source.size();
  cl_int status = CL_SUCCESS;
  ProgramHandle handle(clCreateProgramWithSource(context(), 1, &pointer, &length, &status));
  check(status, file.c_str());

  std::ostringstream options;
  options << "-cl-std=CL1.2 -cl-mad-enable -cl-no-signed-zeros";
  for (const Define& define : defines) options << " -D" << define.name << "=" << define.value;
  status = clBuildProgram(handle.get(), 1, &device_.device, options.str().c_str(), nullptr, nullptr);
  if (status != CL_SUCCESS) {
    std::size_t size = 0;
    clGetProgramBuildInfo(handle.get(), device_.device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(handle.get(), device_.device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    throw DeviceError(file + " does not build (" + options.str() + "): " + status_name(status) + "\n" + log);
  }
  return Program(std::move(handle), file);
}

}  // namespace turbid::cl
