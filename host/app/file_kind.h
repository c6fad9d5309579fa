// SPDX-License-Identifier: Apache-2.0
// What a file given on the command line is, by its first bytes, else by its name.
#pragma once
#include <string>

namespace turbid::app {

enum class FileKind { picture, vdb };

/// Throws InputError if there is no such file, or it is neither an EXR or PNG picture nor an OpenVDB file.
FileKind kind_of(const std::string& file);

}  // namespace turbid::app
