// SPDX-License-Identifier: Apache-2.0
// Runs `turbid profile` with POCL_MAX_PTHREAD_COUNT set and reads the frame's time from what it prints.
#include "host/app/threads_experiment.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "host/base/errors.h"
#include "host/profile/spread.h"
#include "host/report/bench_report.h"

namespace turbid::app {
namespace {

/// Standard output of this program run with the arguments and one variable more. Throws std::runtime_error if it fails.
std::string output_of(const std::vector<std::string>& arguments, const std::string& variable) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  std::vector<char*> argv, environment;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  for (char** entry = environ; *entry; ++entry) environment.push_back(*entry);
  environment.insert(environment.begin(), const_cast<char*>(variable.c_str()));
  environment.push_back(nullptr);
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, argv.data(), environment.data());
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; !failed && (n = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = -1;
  if (failed || waitpid(child, &status, 0) != child || status != 0)
    throw std::runtime_error("turbid profile failed with " + variable);
  return text;
}

}  // namespace

Experiment measure_threads(const BenchSettings& settings, const cl::DeviceInfo& device) {
  Experiment e{.id = "threads", .title = "Threads",
               .method = "Warm frames of the sphere of milk by processes whose device may use so many threads "
                         "(POCL_MAX_PTHREAD_COUNT); the host's own threads are not limited.",
               .columns = {{"threads"}, {"frame", "ms"}, {"speed-up"}, {"per thread"}},
               .plot_x = 0, .plot_y = {2}};
  if (!device.pocl) {
    e.found = "Only PoCL's number of threads can be set.";
    e.plot_x = -1;
    return e;
  }
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("turbid-threads-" + std::to_string(getpid()));
  double one = 0;
  for (int threads = 1; threads <= device.compute_units; threads = std::min(2 * threads, std::max(threads + 1, device.compute_units))) {
    std::vector<double> samples;
    for (int repeat = 0; repeat < (settings.quick ? 1 : 3); ++repeat) {
      const std::string json = output_of(
          {"turbid", "profile", settings.scene("sphere.toml"), "--json", "-q", "--repeat", "3", "--resolution",
           settings.quick ? "32" : "96", "-D", "camera.samples=1", "-o", folder.string()},
          "POCL_MAX_PTHREAD_COUNT=" + std::to_string(threads));
      samples.push_back(frame_seconds_of_profile(json));
    }
    const double seconds = spread_of(samples).median;
    if (threads == 1) one = seconds;
    e.rows.push_back({static_cast<double>(threads), 1e3 * seconds, one / seconds, one / seconds / threads});
  }
  std::error_code ignored;
  fs::remove_all(folder, ignored);
  const auto& last = e.rows.back();
  char text[120];
  std::snprintf(text, sizeof text, "%.0f threads are %.2f times as fast as one.", last[0], last[2]);
  e.found = text;
  return e;
}

}  // namespace turbid::app
