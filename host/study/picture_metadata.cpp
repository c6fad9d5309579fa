// SPDX-License-Identifier: Apache-2.0
// See picture_metadata.h.
#include "host/study/picture_metadata.h"

namespace turbid {

ImageMetadata picture_metadata(const SceneOnGrid& in, const cl::DeviceInfo& device, const SolverReport& solver,
                               const std::vector<StageTime>& times) {
  ImageMetadata metadata;
  metadata.text = {{"turbid:version", TURBID_VERSION},   {"turbid:scene", in.scene.name},
                   {"turbid:scene_hash", in.scene.hash}, {"turbid:unit", in.scene.unit},
                   {"turbid:device", device.label()},    {"turbid:driver", device.driver},
                   {"turbid:solver", solver.solver}};
  metadata.numbers = {{"turbid:voxel_size", in.scene.medium.frame.voxel_size},
                      {"turbid:error_estimate", static_cast<float>(solver.error_estimate)},
                      {"turbid:energy_imbalance", static_cast<float>(solver.energy.imbalance())}};
  for (const StageTime& stage : times)
    metadata.numbers["turbid:seconds:" + stage.name] += static_cast<float>(stage.seconds);
  return metadata;
}

}  // namespace turbid
