// SPDX-License-Identifier: Apache-2.0
// Collects commands and reads their times once they are done.
#include "host/cl/recorder.h"

#include <algorithm>
#include <limits>

#include "host/base/progress.h"

namespace turbid::cl {
namespace {

double event_time(cl_event event, cl_profiling_info what) {
  cl_ulong nanoseconds = 0;
  check(clGetEventProfilingInfo(event, what, sizeof nanoseconds, &nanoseconds, nullptr), "reading a command's times");
  return 1e-9 * static_cast<double>(nanoseconds);
}

}  // namespace

std::size_t Command::bytes() const {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const bool counted = std::any_of(buffers.begin(), buffers.begin() + static_cast<std::ptrdiff_t>(i),
                                     [&](const TouchedBuffer& other) { return other.object == buffers[i].object; });
    if (!counted) sum += buffers[i].bytes;
  }
  return sum;
}

std::size_t Command::bytes_of(const std::string& argument) const {
  for (const TouchedBuffer& buffer : buffers)
    if (buffer.argument == argument) return buffer.bytes;
  return 0;
}

void Recorder::start() {
  commands_.clear();
  events_.clear();
  programs_.clear();
  stages_.clear();
  stage_.clear();
  started_ = wall_time();
  on_ = true;
}

void Recorder::stop() {
  if (!on_) return;
  stage("");
  on_ = false;
  read_times();
  ended_ = wall_time();
}

void Recorder::stage(const std::string& name) {
  const double now = wall_time();
  if (!stages_.empty() && stages_.back().ended == 0) stages_.back().ended = now;
  stage_ = name;
  if (on_ && !name.empty()) stages_.push_back({name, now, 0});
}

void Recorder::add(Command command, cl_event event) {
  events_.emplace_back(event);
  command.stage = stage_;
  commands_.push_back(std::move(command));
}

void Recorder::add(BuiltProgram program) {
  program.stage = stage_;
  programs_.push_back(std::move(program));
}

void Recorder::read_times() {
  // host = device + offset; called <= queued + offset <= returned for every command.
  double least = -std::numeric_limits<double>::max(), most = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < commands_.size(); ++i) {
    Command& command = commands_[i];
    const cl_event event = events_[i].get();
    check(clWaitForEvents(1, &event), "waiting for a recorded command");
    command.queued = event_time(event, CL_PROFILING_COMMAND_QUEUED);
    command.submitted = event_time(event, CL_PROFILING_COMMAND_SUBMIT);
    command.started = event_time(event, CL_PROFILING_COMMAND_START);
    command.ended = event_time(event, CL_PROFILING_COMMAND_END);
    least = std::max(least, command.called - command.queued);
    most = std::min(most, command.returned - command.queued);
  }
  const double offset = 0.5 * (least + most);
  for (Command& command : commands_) {
    for (double* time : {&command.queued, &command.submitted, &command.started, &command.ended}) *time += offset;
  }
  events_.clear();
}

}  // namespace turbid::cl
