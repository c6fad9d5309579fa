// SPDX-License-Identifier: Apache-2.0
// Where on a regular grid light rays start, and in which order they go.
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/shared/march_params.h"
#include "volumes/frame.h"

namespace turbid {

/// Radical inverse of a counter: offsets of the ray grid for different seeds, in [0, 1).
float radical_inverse(std::uint64_t n, unsigned base);

/// Rays that start in one block of voxels follow each other: they meet the same tiles of the medium and of the deposits.
std::vector<RayState> sorted_by_block(const std::vector<RayState>&, const GridFrame&);

}  // namespace turbid
