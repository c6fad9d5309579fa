// SPDX-License-Identifier: Apache-2.0
// How far the fluence of a volume lies from that of another, or from a formula.
#pragma once
#include <functional>
#include <glm/glm.hpp>

#include "host/study/error_measures.h"
#include "volumes/fluence_volume.h"

namespace turbid {

/// Which voxels count, by their centre [scene units]; empty: all.
using VoxelChoice = std::function<bool(glm::vec3 centre)>;

/// Of `got.fluence` in its active blocks against formula(centre), all colours together: rel_l1, rel_l2 and linf are the
/// norms that convergence studies use.
ErrorMeasures volume_errors(const FluenceVolume& got, const std::function<glm::vec3(glm::vec3 centre)>& formula,
                            const VoxelChoice& where = {});

/// Against the fluence of a volume of the same domain with voxels as large, or a whole number of times smaller: those
/// inside a voxel of `got` are averaged. Throws std::invalid_argument if the domains or voxel sizes do not fit.
ErrorMeasures volume_errors(const FluenceVolume& got, const FluenceVolume& reference, const VoxelChoice& where = {});

}  // namespace turbid
