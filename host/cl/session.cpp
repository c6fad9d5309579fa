// SPDX-License-Identifier: Apache-2.0
// Context, queues and programs.
#include "host/cl/session.h"

#include <sstream>

#include "host/base/errors.h"
#include "host/cl/kernel_source.h"

namespace turbid::cl {

Queue::Queue(cl_context context, cl_device_id device, std::string name, Recorder& recorder)
    : name_(std::move(name)), recorder_(&recorder) {
  cl_int status = CL_SUCCESS;
  handle_ = QueueHandle(clCreateCommandQueue(context, device, CL_QUEUE_PROFILING_ENABLE, &status));
  check(status, "creating a command queue");
}

void Queue::finish() { check(clFinish(handle_.get()), "waiting for the device"); }

Recording::Recording(Queue& queue, std::string name, std::string program) : recorder_(queue.recorder()) {
  if (!recorder_) return;
  command_.name = std::move(name);
  command_.program = std::move(program);
  command_.queue = queue.name();
  command_.called = wall_time();
}

EventHandle Recording::finish() {
  EventHandle result;
  if (wanted_) {
    if (recorder_) check(clRetainEvent(event_), "keeping an event");
    result = EventHandle(event_);
  }
  if (recorder_) {
    command_.returned = wall_time();
    recorder_->add(std::move(command_), event_);
  }
  return result;
}

std::string argument_name(cl_kernel kernel, cl_uint index) {
  char name[128] = "";
  if (clGetKernelArgInfo(kernel, index, CL_KERNEL_ARG_NAME, sizeof name, name, nullptr) != CL_SUCCESS || !name[0])
    return "argument " + std::to_string(index);
  return name;
}

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
  march_ = std::make_unique<Queue>(context(), device_.device, "march", *recorder_);
  lattice_ = std::make_unique<Queue>(context(), device_.device, "lattice", *recorder_);
}

void Session::stage(const std::string& name) {
  memory_->stage = name;
  recorder_->stage(name);
}

void Session::require_memory(std::size_t bytes) const {
  if (bytes <= device_.max_allocation) return;
  std::ostringstream text;
  text << "needs a buffer of " << bytes / 1048576 << " MB on " << device_.label() << ", which offers "
       << device_.max_allocation / 1048576 << " MB at once; lower the resolution";
  throw DeviceError(text.str());
}

Program Session::build(const std::string& file, const std::vector<Define>& defines) const {
  std::ostringstream options;
  options << "-cl-std=CL1.2 -cl-mad-enable -cl-no-signed-zeros -cl-kernel-arg-info";
  for (const Define& define : defines) options << " -D" << define.name << "=" << define.value;
  const std::string source = kernel_source(file);
  ProgramHandle& known = programs_[options.str() + "\n" + source];
  if (known.get()) {
    check(clRetainProgram(known.get()), file.c_str());
    return Program(ProgramHandle(known.get()), file);
  }
  const double started = wall_time();
  const char* pointer = source.c_str();
  const std::size_t length = source.size();
  cl_int status = CL_SUCCESS;
  ProgramHandle handle(clCreateProgramWithSource(context(), 1, &pointer, &length, &status));
  check(status, file.c_str());

  status = clBuildProgram(handle.get(), 1, &device_.device, options.str().c_str(), nullptr, nullptr);
  if (status != CL_SUCCESS) {
    std::size_t size = 0;
    clGetProgramBuildInfo(handle.get(), device_.device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size);
    std::string log(size, '\0');
    clGetProgramBuildInfo(handle.get(), device_.device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
    throw DeviceError(file + " does not build (" + options.str() + "): " + status_name(status) + "\n" + log);
  }
  if (recorder_->on()) recorder_->add(BuiltProgram{file, options.str(), {}, started, wall_time()});
  check(clRetainProgram(handle.get()), file.c_str());
  known = ProgramHandle(handle.get());
  return Program(std::move(handle), file);
}

}  // namespace turbid::cl
