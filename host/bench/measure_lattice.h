// SPDX-License-Identifier: Apache-2.0
// How fast a step of the global lattice is beside the device's triad, what the steady solve saves over plain steps, and
// how many iterations it needs on hard media.
#pragma once
#include <vector>

#include "host/bench/goal.h"
#include "host/cl/session.h"

namespace turbid {

/// Single steps and blocks on `voxels`^3 (a multiple of 8), plain steps against the solve on `solve_voxels`^3,
/// iterations on the media of hard_media.h at 32^3, `solve_voxels`^3 and, of two, twice that; medians of `repeats`.
std::vector<Goal> measure_lattice(cl::Session&, int voxels = 128, int solve_voxels = 64, int repeats = 7);

}  // namespace turbid
