// SPDX-License-Identifier: Apache-2.0
// The diffusion operator as the smoother takes it: conductances and 1 / diagonal rounded to 16 bits (a float's upper
// half, off by at most .2 %), which halves what has to be read of them. The preconditioner stays symmetric, as both
// voxels at a face take the same conductance, and positive, as the sweeps' 1 / diagonal is positive; conjugate
// gradients around it take the exact operator.
//
// A word holds a voxel of colour 0 (upper half) and the one of colour 1 in the same lane of the same rows (lower half):
// vectors v and v ^ 1 of lib/packed_block.h.
#ifndef TURBID_LIB_ROUNDED_OPERATOR_H
#define TURBID_LIB_ROUNDED_OPERATOR_H
#include "lib/packed_block.h"

// Words of a block.
#define PAIRS (TURBID_BLOCK_VOXELS / 2)

typedef struct {
  const global uint* t[3];      // conductances of this block
  const global uint* below[3];  // of the blocks to the west, south and bottom
  const global uint* inverse;   // 1 / diagonal, 0 where nothing is
  const global int* neighbours;
  size_t own;  // offset of this block within a field
} Rounded;

// rounded: [channel][three axes, 1 / diagonal][block, zeros][word].
BLOCK_INLINE Rounded rounded_operator(const global uint* rounded, const global int* neighbours, int blocks, int block,
                                      int channel) {
  Rounded a;
  const size_t stride = (size_t)(blocks + 1) * PAIRS;
  const global uint* all = rounded + 4 * channel * stride;
  a.neighbours = neighbours + 6 * block;
  a.own = (size_t)block * TURBID_BLOCK_VOXELS;
  for (int axis = 0; axis < 3; ++axis) {
    a.t[axis] = all + axis * stride + (size_t)block * PAIRS;
    a.below[axis] = all + axis * stride + (size_t)a.neighbours[2 * axis] * PAIRS;
  }
  a.inverse = all + 3 * stride + (size_t)block * PAIRS;
  return a;
}

// Vector v; which half is known where loops are unrolled.
BLOCK_INLINE float16 widened(int v, const global uint* words) {
  const uint16 both = ((const global uint16*)words)[v >> 1];
  return as_float16(v & 1 ? both << 16 : both & 0xffff0000u);
}

// Conductances of the faces downwards of a vector at plane 2 zz + dz, those of the block's own faces included.
BLOCK_INLINE float16 rounded_below_x(const Rounded* a, int v, int odd) {
  return x_below(widened(v ^ 1, a->t[0]), widened(v ^ 1, a->below[0]), odd);
}
BLOCK_INLINE float16 rounded_below_z(const Rounded* a, int v, int zz, int dz) {
  return widened(v ^ 1, dz || zz ? a->t[2] - 2 * 16 : a->below[2] + 14 * 16);
}

#endif
