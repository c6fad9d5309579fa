// SPDX-License-Identifier: Apache-2.0
// Runs the program as a user does: in a folder of its own, with its own environment, limits and signals.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace turbid::test {

struct Outcome {
  int status = -1;  ///< exit status; 128 + number after a deadly signal
  std::string out, err;
  double seconds_after_interrupt = 0;
  /// Lines of `err`.
  std::vector<std::string> error_lines() const;
};

struct RunSettings {
  std::map<std::string, std::string> environment = {};  ///< added to the caller's; TURBID_... of the caller are removed
  std::size_t largest_file = 0;                         ///< limit of a written file [bytes]; 0: none
  /// Called with the first line of standard output while the program goes on running; then SIGINT.
  std::function<void(const std::string&)> visit = {};
  std::string interrupt_at = {};                        ///< SIGINT once standard error has a line that begins so
};

/// A folder to work in, removed when this object goes.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const;
  /// All files and folders, sorted, with a slash after folders' names.
  std::vector<std::string> content() const;

  /// Runs a program with this folder as the current one.
  Outcome run(const std::vector<std::string>& command, const RunSettings& = {}) const;
  /// Runs turbid.
  Outcome turbid(std::vector<std::string> arguments, const RunSettings& = {}) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace turbid::test
