// SPDX-License-Identifier: Apache-2.0
// turbid: reads the command line, runs one command, and turns what it throws into one line and an exit status:
// 0 done, 1 failed its own check, 2 bad input, 3 device or fault of ours, 130 interrupted.
#include <csignal>
#include <cstdio>
#include <new>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/base/errors.h"
#include "host/base/progress.h"

namespace turbid::app {
namespace {

std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n' || c == '\r') c = ' ';
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

int fail(int status, const std::string& sentence) {
  std::fflush(stdout);
  std::fprintf(stderr, "turbid: %s\n", sentence.c_str());
  return status;
}

void require_command(const CLI::App& program, int argc, const char* const* argv) {
  std::string names;
  const std::string first = argc < 2 ? "" : argv[1];
  if (first.starts_with("-")) return;
  for (const CLI::App* command : program.get_subcommands({})) {
    if (command->get_name() == first) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw InputError((first.empty() ? std::string("no command given") : first + ": no such command") + "; there are " +
                   names + ": see turbid --help");
}

/// False if there is nothing more to do (--help and its like).
bool parse(CLI::App& program, int argc, const char* const* argv) {
  try {
    program.parse(argc, argv);
    return true;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {
      program.exit(error);
      return false;
    }
    std::string name;
    for (const CLI::App* command : program.get_subcommands()) name = " " + command->get_name();
    throw InputError(one_line(error.what()) + "; see turbid" + name + " --help");
  }
}

void run(int argc, const char* const* argv) {
  remember_command_line(argc, argv);
  CLI::App program("Turbid computes how light spreads in media that scatter, absorb and refract it.", "turbid");
  program.set_version_flag("--version", "turbid " TURBID_VERSION);
  program.footer(
      "Examples:\n"
      "  turbid render scenes/bunny.toml\n"
      "  turbid check scenes/bunny.toml -D domain.resolution=192\n"
      "  turbid COMMAND --help says more about each.\n\n"
      "Exit status: 0 done, 1 failed its own check, 2 bad input, 3 device, 130 interrupted.");
  program.require_subcommand(1);
  Work work;
  for (const auto add : {add_render, add_solve, add_voxelise, add_view, add_check, add_devices, add_info, add_compare,
                         add_profile, add_verify})
    add(program, work);
  require_command(program, argc, argv);
  if (parse(program, argc, argv)) work();
  if (std::fflush(stdout) != 0 || std::ferror(stdout)) throw InputError("standard output: cannot be written");
}

}  // namespace
}  // namespace turbid::app

int main(int argc, char** argv) {
  using namespace turbid;
  using app::fail, app::one_line;
  // A file that grows over the user's limit (ulimit -f) shall be an error of write(), not the end of the process.
  std::signal(SIGXFSZ, SIG_IGN);
  install_interrupt_handler();
  try {
    app::run(argc, argv);
    return 0;
  } catch (const VerificationError& error) {
    return fail(1, one_line(error.what()));
  } catch (const InputError& error) {
    return fail(2, one_line(error.what()));
  } catch (const DeviceError& error) {
    return fail(3, error.what());  // as it is: it may hold a compiler's log
  } catch (const Interrupted& error) {
    return fail(130, one_line(error.what()) + "; nothing was written");
  } catch (const std::bad_alloc&) {
    return fail(2, "not enough memory; lower the resolution (--resolution), or see what it needs with turbid check");
  } catch (const std::exception& error) {
    return fail(3, one_line(std::string("fault in Turbid, please report it: ") + error.what()));
  }
}
