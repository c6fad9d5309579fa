// SPDX-License-Identifier: Apache-2.0
// The three ways a run can fail for a reason that somebody can act on. Thrown low, caught once in main.
#pragma once
#include <stdexcept>
#include <string>

namespace turbid {

/// The user's input is wrong: one sentence that names the file, the key or line, what was found and what was expected.
/// Exit status 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A computed result failed a check that the program makes on itself (the energy balance, say). Exit status 1.
struct VerificationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The OpenCL device, its driver or a kernel build failed. Exit status 3.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The user pressed Ctrl-C; `what()` says what was finished. Exit status 130.
struct Interrupted : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace turbid
