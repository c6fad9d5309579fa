// SPDX-License-Identifier: Apache-2.0
// fork, exec, and two pipes.
#include "tests/support/run.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/paths.h"

namespace turbid::test {
namespace {

namespace fs = std::filesystem;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

bool has_line(const std::string& text, const std::string& start) {
  return text.starts_with(start) || text.find("\n" + start) != std::string::npos;
}

[[noreturn]] void become(const fs::path& folder, const std::vector<std::string>& command, const RunSettings& settings,
                         int out, int err) {
  // Another process group: a Ctrl-C at the test runner's terminal is not ours to count.
  setpgid(0, 0);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (settings.largest_file > 0) {
    const rlimit limit{settings.largest_file, settings.largest_file};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  for (const char* name : {"TURBID_DEVICE", "TURBID_KERNEL_DIR"}) unsetenv(name);
  for (const auto& [name, value] : settings.environment) setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  if (chdir(folder.c_str()) == 0) execvp(arguments[0], arguments.data());
  _exit(127);
}

/// Reads what there is; false at the end.
bool drain(int from, std::string& into) {
  char buffer[4096];
  const ssize_t count = read(from, buffer, sizeof buffer);
  if (count > 0) into.append(buffer, static_cast<std::size_t>(count));
  return count > 0;
}

}  // namespace

std::vector<std::string> Outcome::error_lines() const {
  std::vector<std::string> lines;
  std::istringstream stream(err);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

Workplace::Workplace() {
  std::string pattern = (fs::temp_directory_path() / "turbid-cli-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no folder for temporary files");
  folder_ = pattern;
}

Workplace::~Workplace() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Workplace::write(const std::string& name, const std::string& text) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::vector<std::string> Workplace::content() const {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
    names.push_back(entry.path().lexically_relative(folder_).string() + (entry.is_directory() ? "/" : ""));
  std::sort(names.begin(), names.end());
  return names;
}

Outcome Workplace::run(const std::vector<std::string>& command, const RunSettings& settings) const {
  int out[2], err[2];
  if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) become(folder_, command, settings, out[1], err[1]);
  close(out[1]);
  close(err[1]);
  Outcome outcome;
  double interrupted = 0;
  pollfd ends[2] = {{out[0], POLLIN, 0}, {err[0], POLLIN, 0}};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    poll(ends, 2, -1);
    if (ends[0].revents != 0 && !drain(out[0], outcome.out)) ends[0].fd = -1;
    if (ends[1].revents != 0 && !drain(err[0], outcome.err)) ends[1].fd = -1;
    bool interrupt = !settings.interrupt_at.empty() && has_line(outcome.err, settings.interrupt_at);
    if (const std::size_t end = outcome.out.find('\n'); interrupted == 0 && settings.visit && end != std::string::npos) {
      try {
        settings.visit(outcome.out.substr(0, end));
      } catch (const std::exception& error) {
        kill(child, SIGKILL);
        while (drain(err[0], outcome.err)) continue;
        waitpid(child, nullptr, 0);
        throw std::runtime_error(std::string(error.what()) + "; the program said: " + outcome.err);
      }
      interrupt = true;
    }
    if (interrupted == 0 && interrupt) {
      interrupted = now();
      kill(child, SIGINT);
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (interrupted > 0) outcome.seconds_after_interrupt = now() - interrupted;
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  close(out[0]);
  close(err[0]);
  return outcome;
}

Outcome Workplace::turbid(std::vector<std::string> arguments, const RunSettings& settings) const {
  arguments.insert(arguments.begin(), turbid_binary());
  return run(arguments, settings);
}

}  // namespace turbid::test
