// SPDX-License-Identifier: Apache-2.0
// The event timeline: every command that a session's queues are given while a recorder is switched on, the programs that
// were built, and host stages. Off (the default) it costs one comparison per command.
//
// A command's four times come from the device's clock (OpenCL 1.2, table 5.17). They are put on the host's clock by the
// commands themselves: each was queued between two readings of the host's clock, and the offset that fits all is taken.
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "host/cl/handle.h"

namespace turbid::cl {

/// A buffer that a command was given.
struct TouchedBuffer {
  std::string argument;         ///< the kernel's name for it; "to" or "from" for copies
  std::size_t bytes = 0;        ///< of the whole buffer
  const void* object = nullptr; ///< tells buffers apart, nothing else
};

/// One command of a queue. Times [s] on the host's clock (wall_time).
struct Command {
  std::string name;             ///< of the kernel, or "fill", "write", "read", "copy"
  std::string program;          ///< kernel file; empty for what is no kernel
  std::string queue;
  std::string stage;            ///< of the host when it was enqueued
  double called = 0;            ///< the host began to enqueue it
  double returned = 0;          ///< the host went on; of a blocking copy, after it was done
  double queued = 0, submitted = 0, started = 0, ended = 0;
  std::array<std::size_t, 2> global{}, local{};
  std::vector<TouchedBuffer> buffers;
  std::map<std::string, long> integers;  ///< whole-numbered arguments of a kernel by name

  bool is_kernel() const { return !program.empty(); }
  double seconds() const { return ended - started; }
  std::size_t bytes() const;    ///< of all its buffers, each counted once
  /// Bytes of the buffer that the kernel knows by this name; 0 if there is none.
  std::size_t bytes_of(const std::string& argument) const;
};

/// A program built while the recorder was on.
struct BuiltProgram {
  std::string file;             ///< kernel file
  std::string options;          ///< its -D integers
  std::string stage;
  double started = 0, ended = 0;  ///< [s], host
};

/// A stage of the host. Times [s] on the host's clock.
struct HostStage {
  std::string name;
  double started = 0, ended = 0;
};

class Recorder {
 public:
  bool on() const { return on_; }
  /// Forgets what was recorded and begins.
  void start();
  /// Ends recording, waits for the commands and puts their times on the host's clock.
  void stop();
  /// What the host does from now on; "" for nothing in particular.
  void stage(const std::string& name);

  /// In the order in which they were enqueued; filled by stop().
  const std::vector<Command>& commands() const { return commands_; }
  const std::vector<BuiltProgram>& programs() const { return programs_; }
  const std::vector<HostStage>& stages() const { return stages_; }
  double started() const { return started_; }  ///< [s], host
  double ended() const { return ended_; }

  /// For Queue, Kernel and Session only. `event` becomes the recorder's.
  void add(Command command, cl_event event);
  void add(BuiltProgram program);

 private:
  void read_times();

  bool on_ = false;
  std::string stage_;
  double started_ = 0, ended_ = 0;
  std::vector<Command> commands_;
  std::vector<EventHandle> events_;  ///< of the commands
  std::vector<BuiltProgram> programs_;
  std::vector<HostStage> stages_;
};

}  // namespace turbid::cl
