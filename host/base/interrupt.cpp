// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM: the first asks the running stage to stop, the second ends the process at once.
#include <signal.h>
#include <unistd.h>

#include "host/base/progress.h"

namespace turbid {
namespace {

volatile sig_atomic_t asked_to_stop = 0;

extern "C" void on_stop_signal(int) {
  if (asked_to_stop) ::_exit(130);
  asked_to_stop = 1;
  constexpr char kNote[] = "\nstopping; once more to end at once\n";
  // A handler may only make async-signal-safe calls, and has nobody to tell that this one failed.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, kNote, sizeof kNote - 1);
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action = {};
  action.sa_handler = on_stop_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;  // a file that is being written goes on; stages look at the flag themselves
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupt_requested() {
  return asked_to_stop != 0;
}

}  // namespace turbid
