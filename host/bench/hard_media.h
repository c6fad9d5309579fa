// SPDX-License-Identifier: Apache-2.0
// Media on which the solvers' iterations are counted (numerics section 5): even, contrast of 100, voids, a refracting sphere.
#pragma once
#include <string>
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

enum class HardMedium { homogeneous, checker, random, layers, duct, voids, sphere };

/// Name for tables.
std::string name_of(HardMedium);

/// n^3 voxels of edge 1, all faces open to vacuum; n a multiple of 8, >= 16.
/// checker, layers: cells and slabs of n/8 voxels of s and 100 s; random: s times 10^[-1, 1] for each voxel by itself; duct: an
/// empty channel n/4 wide through the middle; voids: one cell of (n/16)^3 voxels in ten is empty; sphere: of index 1.5 and
/// radius 0.45 n. Empty voxels hold 1e-4 s, floored as the solvers floor it at one mean free path per domain.
/// s: transport coefficient per voxel, > 0; albedo in [0, 1).
DiffusionMedium hard_medium(HardMedium, int n, double s, double albedo, int channels = 1);

/// Source [W]: [channel][block][voxel]. Power falls by exp(-s depth) from the face x = 0 on, as a marched beam leaves it.
std::vector<float> beam_source(const DiffusionMedium&);
/// One voxel at (3/8, 1/2, 5/8) of the domain.
std::vector<float> point_source(const DiffusionMedium&);

}  // namespace turbid
