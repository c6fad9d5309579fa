// SPDX-License-Identifier: Apache-2.0
// Active voxels of a region near one that is not its own: where power goes that arises outside the region's voxels.
#pragma once
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

/// Index [block][voxel] of the active voxel there, whatever its region; -1: there is none.
std::int64_t active_voxel(const DiffusionMedium&, glm::ivec3 voxel);

struct NearVoxel {
  std::size_t at;     ///< [block][voxel]
  float weight;       ///< of all that were found the sum is 1
  glm::ivec3 offset;  ///< of the voxel asked for from this one [voxels]
};
/// Puts into `found`, whose room is used again, the voxels of the region around `voxel`, those next to it or, if there are
/// none, within two or three voxels; by inverse square distance.
void find_nearest_voxels(const DiffusionMedium&, glm::ivec3 voxel, int region, std::vector<NearVoxel>& found);

}  // namespace turbid
