// SPDX-License-Identifier: Apache-2.0
// Where single rays go (kernels/path.cl), for comparison with exact optics.
#pragma once
#include <functional>
#include <vector>

#include "host/transport/device_medium.h"

namespace turbid::study {

/// A domain filled with a graded index, eta^2 given at every node (positions in voxels), also beyond the domain's
/// faces, so that central differences are undisturbed there. One region, one channel, nothing scatters.
DeviceMedium graded_domain(cl::Session&, glm::ivec3 voxels, const std::function<double(glm::dvec3)>& eta_squared);

/// One ray, positions in voxels, |v| = eta.
struct PathRay {
  glm::vec3 x{0}, v{0};
  int region = 0;
  float length = 0;  ///< arc length done so far [voxels]
  int surfaces = 0;  ///< surfaces met so far
  int face = -1;     ///< domain face that stopped it
};

/// Traces rays as the march does (kernels/lib/trace.h), always along the refracted branch (the reflected one where
/// reflection is total), until they stand on a face of the domain, or have done `steps` steps or as long an arc as so many
/// of `step` [voxels] make.
std::vector<PathRay> trace(cl::Session&, const DeviceMedium&, const std::vector<PathRay>&, float step, int steps);

}  // namespace turbid::study
