// SPDX-License-Identifier: Apache-2.0
// Names of output files and the trial whether a folder takes them.
#include "host/app/output.h"

#include <algorithm>
#include <cctype>

#include "host/base/atomic_file.h"
#include "host/base/errors.h"

namespace turbid::app {
namespace {

namespace fs = std::filesystem;

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

fs::path default_folder(const std::string& scene_path) {
  return fs::path("out") / fs::path(scene_path).stem();
}

/// Writes and removes a small file: what access rights, read-only and full file systems say only then.
void try_folder(const fs::path& folder) {
  const FolderInUse in_use(folder);
  const fs::path trial = folder / ".turbid-trial";
  try {
    write_file_atomically(trial.string(), "trial\n", 6);
  } catch (const InputError& error) {
    std::string reason = error.what();
    const std::size_t colon = reason.rfind(": ");
    throw InputError("-o: the folder " + folder.string() + " cannot be written to" +
                     (colon == std::string::npos ? "" : reason.substr(colon)));
  }
  std::error_code ignored;
  fs::remove(trial, ignored);
}

void require_no_folder(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored)) throw InputError("-o: " + file.string() + " is a folder, expected a file");
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

FolderInUse::FolderInUse(const fs::path& folder) {
  std::error_code error;
  fs::path so_far;
  for (const fs::path& part : folder) {
    so_far /= part;
    if (fs::is_directory(so_far, error)) continue;
    if (fs::exists(so_far, error))
      throw InputError("-o: " + so_far.string() + " is a file, expected a folder" +
                       (so_far == folder ? " or a name that ends in .exr" : ""));
    if (fs::create_directory(so_far, error))
      made_.push_back(so_far);
    else if (error) {
      const std::string reason = error.message();
      for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, error);
      throw InputError("-o: the folder " + so_far.string() + " cannot be made: " + reason);
    }
  }
}

FolderInUse::~FolderInUse() {
  std::error_code not_empty;
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, not_empty);
}

RenderOutput render_output(const std::string& wanted, const std::string& scene_path) {
  const std::string name = fs::path(scene_path).stem().string();
  const fs::path given = wanted.empty() ? default_folder(scene_path) : fs::path(wanted);
  RenderOutput output;
  std::error_code ignored;
  if (extension_of(given) == ".exr" && !fs::is_directory(given, ignored)) {
    output.folder = folder_of(given);
    output.exr = given.string();
    output.png = fs::path(given).replace_extension(".png").string();
    output.report = fs::path(given).replace_extension(".report.json").string();
  } else {
    static const std::vector<std::string> files{".png", ".jpg", ".jpeg", ".tif", ".tiff",
                                                ".hdr", ".vdb", ".json", ".toml"};
    const std::string extension = extension_of(given);
    if (std::find(files.begin(), files.end(), extension) != files.end() && !fs::is_directory(given, ignored))
      throw InputError("-o " + wanted +
                       ": expected a folder, or a file that ends in .exr (the .png is written beside it)");
    output.folder = given;
    output.exr = (given / (name + ".exr")).string();
    output.png = (given / (name + ".png")).string();
    output.report = (given / "report.json").string();
  }
  try_folder(output.folder);
  for (const std::string& file : {output.exr, output.png, output.report}) require_no_folder(file);
  return output;
}

fs::path vdb_output(const std::string& wanted, const std::string& scene_path, const std::string& fallback) {
  const fs::path file = wanted.empty() ? default_folder(scene_path) / fallback : fs::path(wanted);
  require_no_folder(file);
  if (extension_of(file) != ".vdb") throw InputError("-o " + wanted + ": expected a name that ends in .vdb");
  try_folder(folder_of(file));
  return file;
}

}  // namespace turbid::app
