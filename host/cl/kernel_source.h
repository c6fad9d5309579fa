// SPDX-License-Identifier: Apache-2.0
// Kernel files with their headers put in place: drivers disagree on -I paths (PoCL takes no spaces in them, for one).
#pragma once
#include <string>

namespace turbid::cl {

/// Folder of the kernel files: TURBID_KERNEL_DIR, else beside the installed binary, else the source tree.
std::string kernel_directory();

/// Text of kernels/<file> with every `#include "..."` replaced by that file, looked up in the including file's folder and
/// then in the kernel folder; #line directives keep build errors pointing at the real files.
/// Throws DeviceError naming a file that is missing.
std::string kernel_source(const std::string& file);

}  // namespace turbid::cl
