// SPDX-License-Identifier: Apache-2.0
// See save_files.h.
#include "host/live/save_files.h"

#include <cstdio>
#include <filesystem>

#include "host/base/atomic_file.h"
#include "host/base/errors.h"
#include "host/study/picture_metadata.h"

namespace turbid {
namespace {

/// `folder/name-001` with the first number that none of the three files has.
std::string free_stem(const std::string& folder, const std::string& name) {
  std::error_code ignored;
  for (int i = 1; i < 10000; ++i) {
    char number[16];
    std::snprintf(number, sizeof number, "-%03d", i);
    const std::string stem = (std::filesystem::path(folder) / (name + number)).string();
    bool taken = false;
    for (const char* ending : {".toml", ".exr", ".png"})
      taken = taken || std::filesystem::exists(stem + ending, ignored);
    if (!taken) return stem;
  }
  throw InputError(folder + ": holds 9999 files saved by the live view: clear it up");
}

}  // namespace

std::string save_scene_file(const Scene& scene, const std::string& folder) {
  const std::string path = free_stem(folder, scene.name) + ".toml";
  const std::string text =
      "# " + scene.name + " as changed in turbid view, with every default filled in\n" + scene.effective_toml;
  write_file_atomically(path, text.data(), text.size());
  return path;
}

std::vector<std::string> save_picture_files(const SceneOnGrid& in, const cl::DeviceInfo& device,
                                            const SolverReport& solver, const std::vector<StageTime>& times,
                                            const ViewImage& image, const std::string& folder) {
  const std::string stem = free_stem(folder, in.scene.name);
  write_exr(image, picture_metadata(in, device, solver, times), stem + ".exr");
  write_png_preview(image, in.scene.film.exposure ? *in.scene.film.exposure : automatic_exposure(image), stem + ".png");
  return {stem + ".exr", stem + ".png"};
}

}  // namespace turbid
