// SPDX-License-Identifier: Apache-2.0
// Blocks of voxels as the solvers see them.
//
// A field is stored [channel][block][voxel], x fastest within a block of 8^3, with one more block of zeros at the end of each
// channel that stands for every missing neighbour.
#ifndef TURBID_SHARED_LATTICE_PARAMS_H
#define TURBID_SHARED_LATTICE_PARAMS_H
#include "dialect.h"

#define TURBID_BLOCK_VOXELS 512

// Place of voxel (x, y, z) of a block of 8^3 in the steady solver's order (kernels/lib/packed_block.h): by colours.
#define TURBID_PACKED(x, y, z) \
  (16 * (2 * (2 * (z) + ((y) >> 2)) + (((x) + (y) + (z)) & 1)) + 4 * ((y) & 3) + ((x) >> 1))
// Floats that a block hands to the next coarser level (kernels/lib/block_smoother.h).
#define TURBID_HANDED 160
// Floats that a step of conjugate gradients leaves: r.z before it, p.A p, sum of A p, nothing.
#define TURBID_STEP 4

#endif
