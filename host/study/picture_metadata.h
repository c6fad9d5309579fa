// SPDX-License-Identifier: Apache-2.0
// What a picture's file says of how it was made.
#pragma once
#include "host/study/scene_run.h"

namespace turbid {

ImageMetadata picture_metadata(const SceneOnGrid&, const cl::DeviceInfo&, const SolverReport&,
                               const std::vector<StageTime>&);

}  // namespace turbid
