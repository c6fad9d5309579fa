// SPDX-License-Identifier: Apache-2.0
// See file_kind.h.
#include "host/app/file_kind.h"

#include <cstring>
#include <filesystem>
#include <fstream>

#include "host/base/errors.h"

namespace turbid::app {

FileKind kind_of(const std::string& file) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) throw InputError(file + ": no such file");
  if (std::filesystem::is_directory(file, ignored))
    throw InputError(file + ": is a folder, expected an .exr, .png or .vdb file");
  char start[8] = {};
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file + ": cannot be opened");
  stream.read(start, sizeof start);
  const auto begins = [&](const char* magic, std::size_t length) { return std::memcmp(start, magic, length) == 0; };
  const std::string extension = std::filesystem::path(file).extension().string();
  if (begins(" BDV", 4) || extension == ".vdb") return FileKind::vdb;
  if (begins("\x76\x2f\x31\x01", 4) || begins("\x89PNG", 4) || extension == ".exr" || extension == ".png")
    return FileKind::picture;
  throw InputError(file + ": is neither an EXR or PNG picture nor an OpenVDB file");
}

}  // namespace turbid::app
