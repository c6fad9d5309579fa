// SPDX-License-Identifier: Apache-2.0
// Light through the media on the ground: from rays that hit texels to a smooth irradiance.
#pragma once
#include <vector>

#include "host/transport/solver.h"

namespace turbid {

/// Averages each texel over the smallest square around it that at least a few rays have hit: focused light stays sharp,
/// spread light loses the pattern of the ray grid. `rays`: hits per texel.
void smooth_ground_light(GroundLight* ground, const std::vector<int>& rays);

}  // namespace turbid
