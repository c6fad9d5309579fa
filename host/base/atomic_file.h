// SPDX-License-Identifier: Apache-2.0
// Files that appear whole or not at all: written under a temporary name beside the target, then renamed.
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace turbid {

/// Makes missing parent folders, writes `size` bytes to a temporary file in the same folder, renames it to `path`.
/// Throws InputError "<path>: cannot be written: <reason>" (disk full, no permission, a folder in the way, ...) and
/// leaves neither the temporary file nor a changed `path` behind.
void write_file_atomically(const std::string& path, const void* bytes, std::size_t size);

/// The same for several files (path and bytes): all are written under temporary names before the first is renamed, so
/// that whatever fails in writing leaves none of them behind.
void write_files_atomically(const std::vector<std::pair<std::string, std::string>>& files);

}  // namespace turbid
