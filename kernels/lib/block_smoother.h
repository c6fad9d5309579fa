// SPDX-License-Identifier: Apache-2.0
// Red-black sweeps on one block with frozen interfaces, and the transfer between levels (piecewise constant).
//
// What a block hands to the next coarser level (`Handed`, TURBID_HANDED floats): the residual left inside it, summed
// over 2^3 voxels, [z][y][x] of 4^3; then for each of its six faces what its values send across, T x summed over 2^2
// faces, 4^2 each: that is what the residual of the neighbour lacks, whose sweeps took the interface for zero. So
// nothing has to be read twice.
#ifndef TURBID_LIB_BLOCK_SMOOTHER_H
#define TURBID_LIB_BLOCK_SMOOTHER_H
#include "lib/rounded_operator.h"

// sum of T x_j over the neighbours of a vector within its block; x has margins of zeros.
BLOCK_INLINE float16 pull(const Rounded* a, const float16* x, int zz, int dz, int k, int c) {
  const int v = PLACE(2 * zz + dz, k, c), o = v ^ 1, odd = (c ^ dz) & 1;
  const float16 none = (float16)(0.0f), other = x[MARGIN + o], t_other = widened(o, a->t[0]),
                t_other_y = widened(o, a->t[1]);
  float16 sum = x_below(t_other, none, odd) * x_below(other, none, odd);
  sum += widened(v, a->t[0]) * x_above(other, none, odd);
  sum += y_below(t_other_y, k ? widened(o - 2, a->t[1]) : none) * y_below(other, k ? x[MARGIN + o - 2] : none);
  sum += widened(v, a->t[1]) * y_above(other, k ? none : x[MARGIN + o + 2]);
  sum += rounded_below_z(a, v, zz, dz) * x[MARGIN + o - 4];
  sum += widened(v, a->t[2]) * x[MARGIN + o + 4];
  return sum;
}

BLOCK_INLINE void clear_margins(float16* x) {
  for (int i = 0; i < MARGIN; ++i) x[i] = x[MARGIN + VECTORS + i] = (float16)(0.0f);
}

// x = smoothed from zero, red first. Returns in `left` the residual of the red voxels within the block; the black ones
// have none.
BLOCK_INLINE void smooth_from_zero(const Rounded* a, const global float* b, float16* x, float16* left, int sweeps) {
  clear_margins(x);
  for (int i = 0; i < 16; ++i) {
    x[MARGIN + 2 * i] = VECTOR(2 * i, b) * widened(2 * i, a->inverse);
    left[i] = (float16)(0.0f);
  }
  for (int sweep = 0;; ++sweep) {
    FOR_PAIRS FOR_HALVES {
      const int v = PLACE(2 * zz + dz, k, 1);
      x[MARGIN + v] = (VECTOR(v, b) + pull(a, x, zz, dz, k, 1)) * widened(v, a->inverse);
    }
    if (sweep + 1 >= sweeps) break;
    FOR_PAIRS FOR_HALVES {
      const int v = PLACE(2 * zz + dz, k, 0);
      const float16 sum = pull(a, x, zz, dz, k, 0);
      left[v >> 1] = sum;
      x[MARGIN + v] = (VECTOR(v, b) + sum) * widened(v, a->inverse);
    }
  }
  // b + pull at the last red sweep was the diagonal's share; what the black voxels have sent since is left.
  FOR_PAIRS FOR_HALVES {
    const int i = PLACE(2 * zz + dz, k, 0) >> 1;
    left[i] = pull(a, x, zz, dz, k, 0) - left[i];
  }
}

// What the sweeps left and what the block sends across its faces, for the coarser level.
BLOCK_INLINE void hand_over(const Rounded* a, const float16* with_margins, const float16* left, global float* handed) {
  const float16* x = with_margins + MARGIN;
  global float* faces = handed + 64;
  FOR_PAIRS {
    float4 south = ZERO4, north = ZERO4;
    UNROLL for (int k = 0; k < 2; ++k) {
      const float16 both = left[PLACE(2 * zz, k, 0) >> 1] + left[PLACE(2 * zz + 1, k, 0) >> 1];
      vstore8((float8)(both.s0123 + both.s4567, both.s89ab + both.scdef), 2 * zz + k, handed);
      float16 sides[2] = {(float16)(0.0f), (float16)(0.0f)};
      UNROLL for (int i = 0; i < 4; ++i) {
        const int dz = i >> 1, c = i & 1, v = PLACE(2 * zz + dz, k, c), odd = (c ^ dz) & 1;
        const float16 t = west_east(rounded_below_x(a, v, odd), widened(v, a->t[0]), odd);
        sides[odd] += t * x[v];
        if (k == 0) south += widened((v ^ 1) + 2, a->below[1]).scdef * x[v].s0123;
        if (k == 1) north += widened(v, a->t[1]).scdef * x[v].scdef;
      }
      vstore2((float2)(sides[0].s0 + sides[1].s4, sides[0].s8 + sides[1].sc), 2 * zz + k, faces);
      vstore2((float2)(sides[0].s7 + sides[1].s3, sides[0].sf + sides[1].sb), 2 * zz + k, faces + 16);
    }
    vstore4(south, zz, faces + 32);
    vstore4(north, zz, faces + 48);
  }
  UNROLL for (int k = 0; k < 2; ++k) {
    const int low = PLACE(0, k, 0), high = PLACE(7, k, 0);
    const float16 down = widened(low + 29, a->below[2]) * x[low] + widened(low + 28, a->below[2]) * x[low + 1];
    const float16 up = widened(high, a->t[2]) * x[high] + widened(high + 1, a->t[2]) * x[high + 1];
    vstore8((float8)(down.s0123 + down.s4567, down.s89ab + down.scdef), k, faces + 64);
    vstore8((float8)(up.s0123 + up.s4567, up.s89ab + up.scdef), k, faces + 80);
  }
}

// Plane zz (0 ... 3) of what a child and its neighbours hand over: rows y = 0 ... 3 of four.
BLOCK_INLINE float16 handed_plane(const global float* own, const global float* const from[6], int zz) {
  const float16 none = (float16)(0.0f), west = VECTOR(0, from[0]), east = VECTOR(0, from[1]);
  const float4 south = vload4(zz, from[2]), north = vload4(zz, from[3]);
  const float16 x_faces = zz == 0   ? LANES_OF(west, east, 0, 0, 0, 16, 1, 1, 1, 17, 2, 2, 2, 18, 3, 3, 3, 19)
                          : zz == 1 ? LANES_OF(west, east, 4, 4, 4, 20, 5, 5, 5, 21, 6, 6, 6, 22, 7, 7, 7, 23)
                          : zz == 2
                              ? LANES_OF(west, east, 8, 8, 8, 24, 9, 9, 9, 25, 10, 10, 10, 26, 11, 11, 11, 27)
                              : LANES_OF(west, east, 12, 12, 12, 28, 13, 13, 13, 29, 14, 14, 14, 30, 15, 15, 15, 31);
  float16 sum = VECTOR(zz, own) + LANES_OF(x_faces, none, 0, 16, 16, 3, 4, 16, 16, 7, 8, 16, 16, 11, 12, 16, 16, 15);
  sum += (float16)(south, ZERO4, ZERO4, north);
  if (zz == 0) sum += VECTOR(0, from[4]);
  if (zz == 3) sum += VECTOR(0, from[5]);
  return sum;
}

// b of a coarse block from what its eight children and their neighbours handed over. `finer` counts the children's
// level's blocks.
static void take_over(const global int* children, const global int* fine_neighbours, const global float* handed,
                      int finer, global float* b) {
  ROLLED for (int pair = 0; pair < 4; ++pair) {  // of children beside each other along x
    const global float* own[2];
    const global float* from[2][6];
    for (int i = 0; i < 2; ++i) {
      const int child = children[2 * pair + i];
      own[i] = handed + (size_t)child * TURBID_HANDED;
      for (int side = 0; side < 6; ++side) {
        const int next = child < finer ? fine_neighbours[6 * child + side] : finer;
        from[i][side] = handed + (size_t)next * TURBID_HANDED + 64 + 16 * (side ^ 1);
      }
    }
    const int first = PLACE(4 * (pair >> 1), pair & 1, 0);
    UNROLL for (int zz = 0; zz < 4; ++zz) {
      const float16 l = handed_plane(own[0], from[0], zz), r = handed_plane(own[1], from[1], zz);
      const float16 even = LANES_OF(l, r, 0, 2, 16, 18, 5, 7, 21, 23, 8, 10, 24, 26, 13, 15, 29, 31);
      const float16 odd = LANES_OF(l, r, 1, 3, 17, 19, 4, 6, 20, 22, 9, 11, 25, 27, 12, 14, 28, 30);
      PUT_VECTOR(first + 4 * zz, b) = zz & 1 ? odd : even;
      PUT_VECTOR(first + 4 * zz + 1, b) = zz & 1 ? even : odd;
    }
  }
}

// The coarse values over planes 2 zz and 2 zz + 1 of half k; `coarse` starts at the block's eighth of its parent, in
// natural order.
BLOCK_INLINE float16 prolonged(const global float* coarse, int zz, int k) {
  const float4 a = vload4(0, coarse + 64 * zz + 16 * k), b = vload4(0, coarse + 64 * zz + 16 * k + 8);
  return (float16)(a, a, b, b);
}
BLOCK_INLINE const global float* eighth(const global float* coarse, const global int* parent, const global int* octant,
                                        int block) {
  const int o = octant[block];
  return coarse + (size_t)parent[block] * TURBID_BLOCK_VOXELS + 4 * (o & 1) + 32 * ((o >> 1) & 1) + 256 * (o >> 2);
}

// x = s + coarse correction, smoothed black first (the V-cycle stays symmetric) with the neighbours' s + correction
// frozen. s and coarse: all blocks of this channel.
BLOCK_INLINE void smooth_corrected(const Rounded* a, const global float* b, const global float* s,
                                   const global float* coarse, const global int* parent, const global int* octant,
                                   int block, float16* x, int sweeps) {
  float16 rhs[VECTORS];
  const global float* own = eighth(coarse, parent, octant, block);
  const global float *over[6], *next[6];
  for (int i = 0; i < 6; ++i) {
    over[i] = eighth(coarse, parent, octant, a->neighbours[i]);
    next[i] = s + (size_t)a->neighbours[i] * TURBID_BLOCK_VOXELS;
  }
  clear_margins(x);
  FOR_PAIRS UNROLL for (int k = 0; k < 2; ++k) {
    const float16 here = prolonged(own, zz, k), west = prolonged(over[0], zz, k), east = prolonged(over[1], zz, k);
    const float16 side = k ? prolonged(over[3], zz, 0) : prolonged(over[2], zz, 1);
    UNROLL for (int i = 0; i < 4; ++i) {
      const int dz = i >> 1, c = i & 1, v = PLACE(2 * zz + dz, k, c), o = v ^ 1, odd = (c ^ dz) & 1;
      const float16 none = (float16)(0.0f);
      if (c == 0) x[MARGIN + v] = VECTOR(v, s + a->own) + here;  // black voxels are the first to be replaced
      const float16 t = west_east(rounded_below_x(a, v, odd), widened(v, a->t[0]), odd);
      float16 sum = VECTOR(v, b);
      sum += t * west_east(x_below(none, VECTOR(o, next[0]) + west, odd), x_above(none, VECTOR(o, next[1]) + east, odd),
                           odd);
      if (k == 0) sum += y_below(none, widened(o + 2, a->below[1]) * (VECTOR(o + 2, next[2]) + side));
      if (k == 1) sum += last_row(widened(v, a->t[1])) * y_above(none, VECTOR(o - 2, next[3]) + side);
      rhs[v] = sum;
    }
  }
  UNROLL for (int k = 0; k < 2; ++k) {
    const float16 down = prolonged(over[4], 3, k), up = prolonged(over[5], 0, k);
    UNROLL for (int c = 0; c < 2; ++c) {
      const int low = PLACE(0, k, c), high = PLACE(7, k, c), below = PLACE(7, k, 1 - c), above = PLACE(0, k, 1 - c);
      rhs[low] += widened(below, a->below[2]) * (VECTOR(below, next[4]) + down);
      rhs[high] += widened(high, a->t[2]) * (VECTOR(above, next[5]) + up);
    }
  }
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    FOR_PAIRS FOR_HALVES {
      const int v = PLACE(2 * zz + dz, k, 1);
      x[MARGIN + v] = (rhs[v] + pull(a, x, zz, dz, k, 1)) * widened(v, a->inverse);
    }
    FOR_PAIRS FOR_HALVES {
      const int v = PLACE(2 * zz + dz, k, 0);
      x[MARGIN + v] = (rhs[v] + pull(a, x, zz, dz, k, 0)) * widened(v, a->inverse);
    }
  }
}

#endif
