// SPDX-License-Identifier: Apache-2.0
// How fast the march and the view are beside hand-written C++ of the same rays in the same medium.
#pragma once
#include <vector>

#include "host/bench/goal.h"
#include "host/cl/session.h"

namespace turbid {

/// Marches 65 536 light rays, with and without deposits, and gathers 65 536 camera rays through a domain of `voxels`^3 with
/// a graded index, by march.cl and view.cl as every scene runs them and by reference_march.cpp in turn, `repeats` times
/// each; medians. `voxels`: a multiple of 8.
std::vector<Goal> measure_rays(cl::Session&, int voxels = 128, int repeats = 5);

}  // namespace turbid
