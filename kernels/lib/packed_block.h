// SPDX-License-Identifier: Apache-2.0
// A block of 8^3 voxels in packed order, and the diffusion operator on it.
//
// Vector v = 2 (2 z + k) + c holds the voxels of colour c = (x + y + z) mod 2 in rows y = 4k ... 4k + 3, four lanes
// each, lane j of a row being x = 2 j + parity. All neighbours of a vector then lie in vectors of the other colour:
// those over z in the same lanes, those over y in the next four, those over x in the same or the next lane. `odd` tells
// which: the parity of the first row (and the third; the others have the other one), which is (c + z) mod 2. Loops over
// vectors are unrolled, so that it is known.
#ifndef TURBID_LIB_PACKED_BLOCK_H
#define TURBID_LIB_PACKED_BLOCK_H
#include "shared/lattice_params.h"

#define BLOCK_INLINE static inline __attribute__((always_inline))
#define UNROLL _Pragma("unroll")
#define VECTORS 32
// Vector number of plane z, half k (rows 4k ...), colour c; the other colour's at the same place is PLACE ^ 1.
#define PLACE(z, k, c) (2 * (2 * (z) + (k)) + (c))
// Vector v of a field: blocks, and so vectors, are aligned. PoCL writes vstore16 in parts.
#define VECTOR(v, field) (((const global float16*)(field))[v])
#define PUT_VECTOR(v, field) (((global float16*)(field))[v])
#define ZERO4 ((float4)(0.0f))

// Lanes of two vectors: 0 ... 15 of a, 16 ... 31 of b. Lanes named one by one would be moved one by one.
#ifdef __clang__
#define LANES_OF(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define LANES_OF(a, b, ...) shuffle2(a, b, (uint16)(__VA_ARGS__))
#endif

// Neighbours along x of a vector: `o` is the other colour's vector in the same rows, w and e those of the blocks to the
// west and east.
BLOCK_INLINE float16 x_below(float16 o, float16 w, int odd) {
  return odd ? LANES_OF(o, w, 0, 1, 2, 3, 23, 4, 5, 6, 8, 9, 10, 11, 31, 12, 13, 14)
             : LANES_OF(o, w, 19, 0, 1, 2, 4, 5, 6, 7, 27, 8, 9, 10, 12, 13, 14, 15);
}
BLOCK_INLINE float16 x_above(float16 o, float16 e, int odd) {
  return odd ? LANES_OF(o, e, 1, 2, 3, 16, 4, 5, 6, 7, 9, 10, 11, 24, 12, 13, 14, 15)
             : LANES_OF(o, e, 0, 1, 2, 3, 5, 6, 7, 20, 8, 9, 10, 11, 13, 14, 15, 28);
}
// Neighbours along y: s ends with the row before the other colour's vector, n begins with the row after it.
BLOCK_INLINE float16 y_below(float16 o, float16 s) {
  return LANES_OF(o, s, 28, 29, 30, 31, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11);
}
BLOCK_INLINE float16 y_above(float16 o, float16 n) {
  return LANES_OF(o, n, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19);
}

// Lanes of a vector that lie at the block's west and east faces, one in each row; the others are 0.
BLOCK_INLINE float16 west_east(float16 west, float16 east, int odd) {
  const float16 both = odd ? LANES_OF(west, east, 0, 1, 2, 19, 4, 5, 6, 7, 8, 9, 10, 27, 12, 13, 14, 15)
                           : LANES_OF(west, east, 0, 1, 2, 3, 4, 5, 6, 23, 8, 9, 10, 11, 12, 13, 14, 31);
  const float16 none = (float16)(0.0f);
  return odd ? LANES_OF(both, none, 16, 17, 18, 3, 4, 21, 22, 23, 24, 25, 26, 11, 12, 29, 30, 31)
             : LANES_OF(both, none, 0, 17, 18, 19, 20, 21, 22, 7, 8, 25, 26, 27, 28, 29, 30, 15);
}
// The last row alone.
BLOCK_INLINE float16 last_row(float16 v) {
  const float16 none = (float16)(0.0f);
  return LANES_OF(v, none, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 12, 13, 14, 15);
}

BLOCK_INLINE float sum16(float16 v) {
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
}

// Rows of x in their natural order, two float16 of two rows each, into the vector of rows 4k ... 4k + 3, and back.
BLOCK_INLINE float16 packed(float16 rows01, float16 rows23, int odd) {
  return odd ? LANES_OF(rows01, rows23, 1, 3, 5, 7, 8, 10, 12, 14, 17, 19, 21, 23, 24, 26, 28, 30)
             : LANES_OF(rows01, rows23, 0, 2, 4, 6, 9, 11, 13, 15, 16, 18, 20, 22, 25, 27, 29, 31);
}
BLOCK_INLINE float16 rows01_of(float16 e, float16 o) {  // e: the vector with odd = 0
  return LANES_OF(e, o, 0, 16, 1, 17, 2, 18, 3, 19, 20, 4, 21, 5, 22, 6, 23, 7);
}
BLOCK_INLINE float16 rows23_of(float16 e, float16 o) {
  return LANES_OF(e, o, 8, 24, 9, 25, 10, 26, 11, 27, 28, 12, 29, 13, 30, 14, 31, 15);
}

// The operator of one channel as one block sees it:
//     (A x)_i = sum over faces T_ij (x_i - x_j) + d_i x_i.
// T[axis] belongs to the face between a voxel and its upper neighbour.
typedef struct {
  const global float* t[3];      // conductances of this block
  const global float* below[3];  // of the blocks to the west, south and bottom
  const global int* neighbours;
  size_t own;  // offset of this block within a channel
} Operator;

BLOCK_INLINE Operator block_operator(const global float* conductance, const global int* neighbours, int blocks,
                                     int block, int channel) {
  Operator a;
  const size_t stride = (size_t)(blocks + 1) * TURBID_BLOCK_VOXELS;
  a.neighbours = neighbours + 6 * block;
  a.own = (size_t)block * TURBID_BLOCK_VOXELS;
  for (int axis = 0; axis < 3; ++axis) {
    const global float* all = conductance + (3 * channel + axis) * stride;
    a.t[axis] = all + a.own;
    a.below[axis] = all + (size_t)a.neighbours[2 * axis] * TURBID_BLOCK_VOXELS;
  }
  return a;
}

// Every loop over a block goes by pairs of planes 2 zz and 2 zz + 1, in which all parities come around: the loop itself
// must not be unrolled, as compilers would then keep the whole operator in registers that there are not.
#define ROLLED _Pragma("unroll 1")
#define FOR_PAIRS ROLLED for (int zz = 0; zz < 4; ++zz)
#define FOR_HALVES UNROLL for (int dz = 0; dz < 2; ++dz) UNROLL for (int k = 0; k < 2; ++k)
// A block's vectors with a plane (4 vectors) more below and above: vector v is x[MARGIN + v].
#define MARGIN 4
#define WITH_MARGINS (VECTORS + 2 * MARGIN)

// Conductances of the faces downwards of a vector at plane 2 zz + dz, those of the block's own faces included.
BLOCK_INLINE float16 t_below_x(const Operator* a, int v, int odd) {
  return x_below(VECTOR(v ^ 1, a->t[0]), VECTOR(v ^ 1, a->below[0]), odd);
}
BLOCK_INLINE float16 t_below_y(const Operator* a, int v, int k) {
  const int o = v ^ 1;
  return y_below(VECTOR(o, a->t[1]), k ? VECTOR(o - 2, a->t[1]) : VECTOR(o + 2, a->below[1]));
}
BLOCK_INLINE float16 t_below_z(const Operator* a, int v, int zz, int dz) {
  const global float* from = dz || zz ? a->t[2] - 4 * 16 : a->below[2] + 28 * 16;
  return VECTOR(v ^ 1, from);
}

// A field u + beta w.
typedef struct {
  const global float* u;
  const global float* w;
  float beta;
} Sum;
BLOCK_INLINE Sum neighbour(Sum f, const Operator* a, int side) {
  const size_t there = (size_t)a->neighbours[side] * TURBID_BLOCK_VOXELS;
  const Sum moved = {f.u + there, f.w + there, f.beta};
  return moved;
}
BLOCK_INLINE float16 value(Sum f, int v) {
  return VECTOR(v, f.u) + f.beta * VECTOR(v, f.w);
}

// Fills the margins below and above.
BLOCK_INLINE void load_margins(float16* x, Sum field, const Operator* a) {
  const Sum down = neighbour(field, a, 4), up = neighbour(field, a, 5);
  for (int i = 0; i < 4; ++i) {
    x[i] = value(down, 28 + i);
    x[MARGIN + VECTORS + i] = value(up, i);
  }
}

// A block's vectors (without margins) into rows in natural order.
BLOCK_INLINE void put_natural(const float16* x, float factor, global float* to) {
  FOR_PAIRS FOR_HALVES {
    const int even = PLACE(2 * zz + dz, k, dz), row = 4 * (2 * zz + dz) + 2 * k;
    const float16 e = factor * x[even], o = factor * x[even ^ 1];
    PUT_VECTOR(row, to) = rows01_of(e, o);
    PUT_VECTOR(row + 1, to) = rows23_of(e, o);
  }
}

// sum over faces T (x_i - x_j) + d x_i for the vector at PLACE(2 zz + dz, k, c); x with its margins, beyond: the field
// in the blocks to the west, east, south and north.
BLOCK_INLINE float16 apply_vector(const Operator* a, const global float* loss, const float16* x, const Sum* beyond,
                                  int zz, int dz, int k, int c) {
  const int v = PLACE(2 * zz + dz, k, c), o = v ^ 1, odd = (c ^ dz) & 1;
  const float16 here = x[MARGIN + v], other = x[MARGIN + o];
  const float16 xm = x_below(other, value(beyond[0], o), odd), xp = x_above(other, value(beyond[1], o), odd);
  const float16 ym = y_below(other, k ? x[MARGIN + o - 2] : value(beyond[2], o + 2));
  const float16 yp = y_above(other, k ? value(beyond[3], o - 2) : x[MARGIN + o + 2]);
  return t_below_x(a, v, odd) * (here - xm) + VECTOR(v, a->t[0]) * (here - xp) + t_below_y(a, v, k) * (here - ym) +
         VECTOR(v, a->t[1]) * (here - yp) + t_below_z(a, v, zz, dz) * (here - x[MARGIN + o - 4]) +
         VECTOR(v, a->t[2]) * (here - x[MARGIN + o + 4]) + VECTOR(v, loss) * here;
}

#endif
