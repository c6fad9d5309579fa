// SPDX-License-Identifier: Apache-2.0
// A context on one device with its in-order queues; programs from kernel files; typed buffers and kernels.
#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "host/base/progress.h"
#include "host/cl/device.h"
#include "host/cl/handle.h"
#include "host/cl/memory_count.h"
#include "host/cl/recorder.h"

namespace turbid::cl {

/// An in-order command queue.
class Queue {
 public:
  Queue(cl_context context, cl_device_id device, std::string name, Recorder& recorder);
  cl_command_queue get() const { return handle_.get(); }
  const std::string& name() const { return name_; }
  /// Null unless commands are being recorded.
  Recorder* recorder() const { return recorder_->on() ? recorder_ : nullptr; }
  /// Blocks until everything enqueued has run. Stands only where the host reads.
  void finish();
  /// Starts what is enqueued without waiting.
  void flush() { check(clFlush(handle_.get()), "starting the device"); }

 private:
  QueueHandle handle_;
  std::string name_;
  Recorder* recorder_ = nullptr;
};

/// Records one command if its queue's recorder is on; made just before the command is enqueued.
class Recording {
 public:
  Recording(Queue& queue, std::string name, std::string program = {});
  /// Where the command's event goes; null if nobody wants it.
  cl_event* event() { return wanted_ || recorder_ ? &event_ : nullptr; }
  /// Asks for the event although nothing is recorded.
  void want_event() { wanted_ = true; }
  void touches(std::string argument, std::size_t bytes, const void* object) {
    if (recorder_) command_.buffers.push_back({std::move(argument), bytes, object});
  }
  bool on() const { return recorder_ != nullptr; }
  Command& command() { return command_; }
  /// After the enqueue: hands the command over and gives the event to who wants it (else null).
  EventHandle finish();

 private:
  Recorder* recorder_;
  Command command_;
  cl_event event_ = nullptr;
  bool wanted_ = false;
};

/// A typed block of device memory.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(cl_context context, std::size_t count, const std::shared_ptr<MemoryCount>& memory = {}) : count_(count) {
    cl_int status = CL_SUCCESS;
    // OpenCL forbids empty buffers: a stage that has nothing to store keeps one element.
    handle_ =
        MemoryHandle(clCreateBuffer(context, CL_MEM_READ_WRITE, sizeof(T) * (count ? count : 1), nullptr, &status));
    check(status, "allocating device memory");
    counted_ = CountedBytes(memory, bytes());
  }
  cl_mem get() const { return handle_.get(); }
  std::size_t count() const { return count_; }
  std::size_t bytes() const { return count_ * sizeof(T); }

 private:
  MemoryHandle handle_;
  CountedBytes counted_;
  std::size_t count_ = 0;
};

struct Range {
  std::size_t x = 1, y = 1;
};

template <class... Args>
class Kernel;

class Program {
 public:
  Program() = default;
  explicit Program(ProgramHandle handle, std::string file) : handle_(std::move(handle)), file_(std::move(file)) {}
  cl_program get() const { return handle_.get(); }
  const std::string& file() const { return file_; }
  KernelHandle kernel(const char* name) const;

 private:
  ProgramHandle handle_;
  std::string file_;
};

/// What the kernel's source calls an argument; its number where the driver can't tell.
std::string argument_name(cl_kernel kernel, cl_uint index);

/// A kernel whose arguments are checked by the compiler: buffers by reference, scalars and structs by value.
template <class... Args>
class Kernel {
 public:
  Kernel() = default;
  Kernel(const Program& program, const char* name)
      : handle_(program.kernel(name)), name_(name), file_(program.file()) {}

  /// Enqueues global work-items in groups of local; the queue is in order, `waits` adds events of other queues.
  void enqueue(Queue& queue, Range global, Range local, const Args&... args, std::span<const cl_event> waits = {},
               EventHandle* done = nullptr) {
    cl_uint index = 0;
    (set(index++, args), ...);
    Recording recording(queue, name_, file_);
    if (recording.on()) {
      index = 0;
      (note(recording, index++, args), ...);
    }
    const std::size_t groups_x = (global.x + local.x - 1) / local.x, groups_y = (global.y + local.y - 1) / local.y;
    if (groups_x == 0 || groups_y == 0) return;
    const std::size_t global_size[2] = {groups_x * local.x, groups_y * local.y};
    const std::size_t local_size[2] = {local.x, local.y};
    recording.command().global = {global_size[0], global_size[1]};
    recording.command().local = {local_size[0], local_size[1]};
    if (done) recording.want_event();
    check(clEnqueueNDRangeKernel(queue.get(), handle_.get(), 2, nullptr, global_size, local_size,
                                 static_cast<cl_uint>(waits.size()), waits.empty() ? nullptr : waits.data(),
                                 recording.event()),
          name_);
    EventHandle event = recording.finish();
    if (done) *done = std::move(event);
  }

 private:
  template <class T>
  void set(cl_uint index, const Buffer<T>& buffer) {
    const cl_mem memory = buffer.get();
    check(clSetKernelArg(handle_.get(), index, sizeof(cl_mem), &memory), name_);
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void set(cl_uint index, const T& value) { check(clSetKernelArg(handle_.get(), index, sizeof(T), &value), name_); }

  template <class T>
  void note(Recording& recording, cl_uint index, const Buffer<T>& buffer) {
    recording.touches(argument_name(handle_.get(), index), buffer.bytes(), buffer.get());
  }
  template <class T>
  void note(Recording& recording, cl_uint index, const T& value) {
    if constexpr (std::is_integral_v<T>)
      recording.command().integers[argument_name(handle_.get(), index)] = static_cast<long>(value);
  }

  KernelHandle handle_;
  const char* name_ = "";
  std::string file_;
};

/// -D integers that fix a program's structure; a kernel file that lacks one of its own stops with #error.
struct Define {
  std::string name;
  long value;
};

class Session {
 public:
  explicit Session(const DeviceChoice& choice);
  cl_context context() const { return context_.get(); }
  const DeviceInfo& device() const { return device_; }
  /// Rays and views run here, the solvers' sweeps on the other.
  Queue& march_queue() { return *march_; }
  Queue& lattice_queue() { return *lattice_; }

  /// Builds kernels/<file> with the given integers, or takes what this session has built of them before. Throws
  /// DeviceError with the compiler's log.
  Program build(const std::string& file, const std::vector<Define>& defines) const;

  template <class T>
  Buffer<T> allocate(std::size_t count) const {
    require_memory(count * sizeof(T));
    return Buffer<T>(context(), count, memory_);
  }
  template <class T>
  Buffer<T> upload(std::span<const T> values) {
    Buffer<T> buffer = allocate<T>(values.size());
    write(*march_, buffer, values);
    return buffer;
  }
  template <class T>
  Buffer<T> upload(const std::vector<T>& values) {
    return upload(std::span<const T>(values));
  }
  template <class T>
  Buffer<T> zeros(std::size_t count) {
    Buffer<T> buffer = allocate<T>(count);
    fill_zero(*march_, buffer);
    march_->finish();
    return buffer;
  }
  /// Blocking copies; those that don't block need `values` until the queue has finished.
  template <class T>
  void write(Queue& queue, Buffer<T>& buffer, std::span<const T> values, bool block = true) {
    if (values.empty()) return;
    Recording recording(queue, "write");
    recording.touches("to", values.size_bytes(), buffer.get());
    check(clEnqueueWriteBuffer(queue.get(), buffer.get(), block, 0, values.size_bytes(), values.data(), 0, nullptr,
                               recording.event()),
          "writing to the device");
    recording.finish();
  }
  template <class T>
  void read(Queue& queue, const Buffer<T>& buffer, std::span<T> values, bool block = true) {
    if (values.empty()) return;
    Recording recording(queue, "read");
    recording.touches("from", values.size_bytes(), buffer.get());
    check(clEnqueueReadBuffer(queue.get(), buffer.get(), block, 0, values.size_bytes(), values.data(), 0, nullptr,
                              recording.event()),
          "reading from the device");
    recording.finish();
  }
  /// Some values from the one numbered `first` on; doesn't block, but returns the event of their arrival.
  template <class T>
  EventHandle read_part(Queue& queue, const Buffer<T>& buffer, std::size_t first, std::span<T> values) {
    Recording recording(queue, "read");
    recording.touches("from", values.size_bytes(), buffer.get());
    recording.want_event();
    check(clEnqueueReadBuffer(queue.get(), buffer.get(), false, first * sizeof(T), values.size_bytes(), values.data(),
                              0, nullptr, recording.event()),
          "reading from the device");
    return recording.finish();
  }
  template <class T>
  std::vector<T> read(Queue& queue, const Buffer<T>& buffer) {
    std::vector<T> values(buffer.count());
    read(queue, buffer, std::span<T>(values));
    return values;
  }
  template <class T>
  void fill_zero(Queue& queue, Buffer<T>& buffer) {
    if (buffer.count() == 0) return;
    const cl_uchar zero = 0;
    Recording recording(queue, "fill");
    recording.touches("to", buffer.bytes(), buffer.get());
    check(clEnqueueFillBuffer(queue.get(), buffer.get(), &zero, 1, 0, buffer.bytes(), 0, nullptr, recording.event()),
          "clearing device memory");
    recording.finish();
  }
  /// Copies a buffer into another of the same size on the device.
  template <class T>
  void copy(Queue& queue, const Buffer<T>& from, Buffer<T>& to) {
    if (from.count() == 0) return;
    Recording recording(queue, "copy");
    recording.touches("from", from.bytes(), from.get());
    recording.touches("to", to.bytes(), to.get());
    check(clEnqueueCopyBuffer(queue.get(), from.get(), to.get(), 0, 0, from.bytes(), 0, nullptr, recording.event()),
          "copying on the device");
    recording.finish();
  }

  /// Records commands, builds and stages while it is on.
  Recorder& recorder() { return *recorder_; }
  /// Names what the host does from now on, for the recorder and the count of memory.
  void stage(const std::string& name);
  const MemoryCount& memory() const { return *memory_; }
  /// Counts the peak and the stages anew from what is held now.
  void restart_memory_count() {
    memory_->peak = memory_->now;
    memory_->allocations = 0;
    memory_->by_stage.clear();
  }

 private:
  /// Everything built so far, by file and options.
  struct Built {
    std::mutex mutex;
    std::map<std::string, Program> programs;
  };

  void require_memory(std::size_t bytes) const;

  DeviceInfo device_;
  ContextHandle context_;
  std::shared_ptr<MemoryCount> memory_ = std::make_shared<MemoryCount>();
  std::unique_ptr<Recorder> recorder_ = std::make_unique<Recorder>();
  std::unique_ptr<Queue> march_, lattice_;
  std::unique_ptr<Built> built_ = std::make_unique<Built>();
};

}  // namespace turbid::cl
