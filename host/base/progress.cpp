// SPDX-License-Identifier: Apache-2.0
// Stage lines and the progress bar on standard error.
#include "host/base/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <utility>

#include "host/base/errors.h"

namespace turbid {
namespace {

constexpr double kRedraw = 0.1;         ///< [s] between two drawings of the bar
constexpr double kFirstEstimate = 0.5;  ///< [s] a stage runs before its time left is worth showing
constexpr int kBarCells = 24;

int terminal_columns() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool draws_on_terminal() {
  const char* kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) && kind && std::string(kind) != "dumb";
}

std::string duration(double seconds) {
  char text[64];
  if (seconds < 10)
    std::snprintf(text, sizeof text, "%.2f s", seconds);
  else if (seconds < 60)
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  else if (seconds < 3600)
    std::snprintf(text, sizeof text, "%d min %02d s", int(seconds) / 60, int(seconds) % 60);
  else
    std::snprintf(text, sizeof text, "%.0f h %02d min", std::floor(seconds / 3600), int(std::fmod(seconds / 60, 60)));
  return text;
}

std::string stop_sentence(const std::string& how, const std::vector<StageTime>& finished) {
  std::string names;
  for (const StageTime& stage : finished) names += (names.empty() ? "" : ", ") + stage.name;
  return "stopped " + how + "; finished: " + (names.empty() ? "nothing" : names);
}

}  // namespace

Progress::Progress(Verbosity verbosity)
    : verbosity_(verbosity), terminal_(verbosity != Verbosity::quiet && draws_on_terminal()) {}

void Progress::stage(const std::string& name) {
  finish();
  if (interrupt_requested()) throw Interrupted(stop_sentence("before " + name, times_));
  current_ = name;
  if (watcher_) watcher_(name);
  started_ = last_drawn_ = wall_time();
  if (update_watcher_) update_watcher_(name, 0);
  draw(0);
}

std::vector<StageTime> Progress::take_times() {
  clear_bar();
  current_.clear();
  return std::exchange(times_, {});
}

void Progress::update(double fraction) {
  if (interrupt_requested()) {
    clear_bar();
    throw Interrupted(stop_sentence(current_.empty() ? "between two stages" : "during " + current_, times_));
  }
  if (update_watcher_ && !current_.empty()) update_watcher_(current_, fraction);
  const double now = wall_time();
  if (!terminal_ || current_.empty() || now - last_drawn_ < kRedraw) return;
  last_drawn_ = now;
  draw(fraction);
}

void Progress::finish() {
  if (current_.empty()) return;
  times_.push_back({current_, wall_time() - started_});
  if (watcher_) watcher_("");
  current_.clear();
  clear_bar();
  if (verbosity_ != Verbosity::quiet)
    std::fprintf(stderr, "%-28s %s\n", times_.back().name.c_str(), duration(times_.back().seconds).c_str());
}

void Progress::warn(const std::string& sentence) {
  warnings_.push_back(sentence);
  clear_bar();
  std::fprintf(stderr, "warning: %s\n", sentence.c_str());
}

void Progress::detail(const std::string& line) {
  if (verbosity_ != Verbosity::verbose) return;
  clear_bar();
  std::fprintf(stderr, "  %s\n", line.c_str());
}

void Progress::draw(double fraction) {
  if (!terminal_) return;
  const double done = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN draws as 0
  const int cells = int(std::lround(done * kBarCells));
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3d %%", int(100 * done));
  std::string line = current_ + " [" + std::string(cells, '#') + std::string(kBarCells - cells, '.') + "] " + percent;
  const double elapsed = wall_time() - started_;
  if (done > 0 && elapsed > kFirstEstimate) line += "  " + duration(elapsed * (1 - done) / done) + " left";
  // A line that wraps could not be redrawn.
  line.resize(std::min<std::size_t>(line.size(), std::max(terminal_columns() - 1, 1)));
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
  bar_shown_ = true;
}

void Progress::clear_bar() {
  if (!bar_shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  bar_shown_ = false;
}

double wall_time() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_time() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace turbid
