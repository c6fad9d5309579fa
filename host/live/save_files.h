// SPDX-License-Identifier: Apache-2.0
// What the live view saves: files NAME-001.toml, .exr, .png, each time under the next number that is free.
#pragma once
#include <string>
#include <vector>

#include "host/study/scene_run.h"

namespace turbid {

/// The effective scene. Returns the file; throws InputError if it can't be written.
std::string save_scene_file(const Scene&, const std::string& folder);

/// EXR and PNG, likewise.
std::vector<std::string> save_picture_files(const SceneOnGrid&, const cl::DeviceInfo&, const SolverReport&,
                                            const std::vector<StageTime>&, const ViewImage&, const std::string& folder);

}  // namespace turbid
