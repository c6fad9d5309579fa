// SPDX-License-Identifier: Apache-2.0
// What a run tells its user while it works: stage lines, a progress bar with the time left, warnings; and Ctrl-C.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace turbid {

enum class Verbosity { quiet, normal, verbose };

/// One stage's name and wall time [s], in the order in which the stages ended.
struct StageTime {
  std::string name;
  double seconds = 0;
};

/// Prints to standard error. A terminal gets a bar that is redrawn; anything else gets one plain line per stage.
class Progress {
 public:
  explicit Progress(Verbosity verbosity = Verbosity::normal);
  ~Progress() { clear_bar(); }

  /// Starts a stage (ends the one before). Throws Interrupted if the user has asked to stop.
  void stage(const std::string& name);
  /// Fraction in [0, 1] of the current stage that is done. Throws Interrupted if the user has asked to stop.
  void update(double fraction);
  /// Ends the current stage and remembers its wall time.
  void finish();
  /// Called with each stage's name as it begins, and with "" when it ends.
  void watch(std::function<void(const std::string&)> watcher) { watcher_ = std::move(watcher); }
  /// Called with the current stage and the fraction of it that is done; may throw Interrupted to stop it.
  void on_update(std::function<void(const std::string&, double)> watcher) { update_watcher_ = std::move(watcher); }
  /// The times so far, which are forgotten here; a stage that was left by an exception is forgotten too.
  std::vector<StageTime> take_times();
  void warn(const std::string& sentence);
  /// Shown only with -v.
  void detail(const std::string& line);

  const std::vector<StageTime>& times() const { return times_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  Verbosity verbosity() const { return verbosity_; }

 private:
  void draw(double fraction);
  void clear_bar();

  Verbosity verbosity_;
  bool terminal_ = false;
  bool bar_shown_ = false;
  std::string current_;
  std::function<void(const std::string&)> watcher_;
  std::function<void(const std::string&, double)> update_watcher_;
  double started_ = 0;
  double last_drawn_ = 0;
  std::vector<StageTime> times_;
  std::vector<std::string> warnings_;
};

/// Installs the Ctrl-C handler: the first signal asks running stages to stop, a second one ends the process at once.
void install_interrupt_handler();
bool interrupt_requested();
/// Wall clock [s] from a steady clock.
double wall_time();
/// Processor time of all threads of this process so far [s].
double processor_time();

}  // namespace turbid
