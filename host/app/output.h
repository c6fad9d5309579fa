// SPDX-License-Identifier: Apache-2.0
// Where results go: names made from -o, and whether they can be written, asked before anything is computed.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace turbid::app {

/// Makes a folder with its parents; when it goes, so do those of them that it made and that are still empty.
class FolderInUse {
 public:
  /// Throws InputError if that can't be.
  explicit FolderInUse(const std::filesystem::path& folder);
  ~FolderInUse();
  FolderInUse(const FolderInUse&) = delete;
  FolderInUse& operator=(const FolderInUse&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  ///< outermost first
};

struct RenderOutput {
  std::string exr, png, report;
  std::filesystem::path folder;
};

/// `wanted`: a folder, or a file that ends in .exr, or empty: out/<scene name>. Throws InputError if the files couldn't
/// be written there; leaves nothing behind.
RenderOutput render_output(const std::string& wanted, const std::string& scene_path);

/// `wanted`: a file that ends in .vdb, or empty: out/<scene name>/<fallback>. Checked likewise.
std::filesystem::path vdb_output(const std::string& wanted, const std::string& scene_path, const std::string& fallback);

}  // namespace turbid::app
