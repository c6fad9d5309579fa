// SPDX-License-Identifier: Apache-2.0
// Finds kernel files and expands their includes.
#include "host/cl/kernel_source.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "host/base/errors.h"

namespace turbid::cl {
namespace fs = std::filesystem;
namespace {

/// The quoted name if the line is an #include "...", else empty.
std::string included_name(const std::string& line) {
  const std::size_t word = line.find_first_not_of(" \t");
  if (word == std::string::npos || line.compare(word, 8, "#include") != 0) return {};
  const std::size_t open = line.find('"', word), close = line.rfind('"');
  if (open == std::string::npos || close <= open) return {};
  return line.substr(open + 1, close - open - 1);
}

/// Appends a file and what it includes; every file once (all headers are guarded).
void expand(const fs::path& path, const fs::path& root, std::set<fs::path>& seen, std::ostringstream& out) {
  if (!seen.insert(fs::weakly_canonical(path)).second) return;
  std::ifstream stream(path);
  if (!stream) throw DeviceError(path.string() + ": kernel file not found; set TURBID_KERNEL_DIR to the kernels folder");
  int number = 0;
  out << "#line 1 \"" << path.string() << "\"\n";
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::string name = included_name(line);
    if (name.empty()) {
      out << line << '\n';
      continue;
    }
    const fs::path beside = path.parent_path() / name;
    expand(fs::exists(beside) ? beside : root / name, root, seen, out);
    out << "#line " << number + 1 << " \"" << path.string() << "\"\n";
  }
}

}  // namespace

std::string kernel_directory() {
  if (const char* variable = std::getenv("TURBID_KERNEL_DIR")) return variable;
  std::error_code error;
  const fs::path binary = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    const fs::path installed = binary.parent_path().parent_path() / TURBID_INSTALLED_KERNELS;
    if (fs::is_directory(installed, error)) return installed.string();
  }
  return TURBID_SOURCE_KERNELS;
}

std::string kernel_source(const std::string& file) {
  const fs::path root = kernel_directory();
  std::set<fs::path> seen;
  std::ostringstream out;
  expand(root / file, root, seen, out);
  return out.str();
}

}  // namespace turbid::cl
