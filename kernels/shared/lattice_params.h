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
#define TURBID_PACKED(x, y, z) (8 * (2 * (4 * (z) + ((y) >> 1)) + (((x) + (y) + (z)) & 1)) + 4 * ((y) & 1) + ((x) >> 1))

// One number per colour channel (scalars of conjugate gradients).
typedef struct {
  float value[3];
  float padding;
} ChannelScalars;
TURBID_ASSERT_SIZE(ChannelScalars, 16);

#endif
