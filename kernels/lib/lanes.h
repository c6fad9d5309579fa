// SPDX-License-Identifier: Apache-2.0
// TURBID_INTERLEAVE rays that go in step, one per lane: 16 on CPUs, where every instruction then serves all of them; 1 on GPUs,
// whose work-items are lanes already. What a packet keeps is a plain array per number, so that single lanes are easy to reach.
#ifndef TURBID_LIB_LANES_H
#define TURBID_LIB_LANES_H
#include "lib/medium.h"

#if !defined(TURBID_INTERLEAVE)
#error "TURBID_INTERLEAVE (1 or 16: rays that a work-item follows in step) must be defined"
#endif
#define LANES TURBID_INTERLEAVE

#define UNROLL _Pragma("unroll")

// Masks are -1 where true.
#if LANES == 16
typedef float16 Floats;
typedef int16 Ints;
typedef float16 Quads;  // four numbers of four lanes
typedef int16 QuadInts;
// One 64-byte access each: a load that took up several narrower stores would wait for them to reach the cache.
#define LANE_ARRAY __attribute__((aligned(64)))
static ALWAYS_INLINE Floats __attribute__((overloadable)) LOAD(const float* array) { return *(const Floats*)array; }
static ALWAYS_INLINE Ints __attribute__((overloadable)) LOAD(const int* array) { return *(const Ints*)array; }
static ALWAYS_INLINE void __attribute__((overloadable)) STORE(Floats value, float* array) { *(Floats*)array = value; }
static ALWAYS_INLINE void __attribute__((overloadable)) STORE(Ints value, int* array) { *(Ints*)array = value; }
#define MASK(condition) (condition)
#define TO_INTS(value) __builtin_convertvector(value, int16)
#define TO_FLOATS(value) __builtin_convertvector(value, float16)
static ALWAYS_INLINE bool any_of(Ints mask) {
  const int8 eight = mask.lo | mask.hi;
  const long2 two = as_long2(eight.lo | eight.hi);
  return (two.x | two.y) != 0;
}
// Four numbers of each lane, which f(lane) gives, put together in registers: narrow stores would keep a wide load waiting.
#define LANE_QUADS 4
#define COLLECT(q, f) \
  for (int k = 0; k < LANE_QUADS; ++k) q[k] = (__typeof__(q[0]))(f(4 * k), f(4 * k + 1), f(4 * k + 2), f(4 * k + 3))
// The first, second ... of the four numbers, for all lanes.
#define COMPONENT(Type, q, s) (Type)(q[0].s, q[1].s, q[2].s, q[3].s)
#define COMPONENT0(Type, q) COMPONENT(Type, q, s048c)
#define COMPONENT1(Type, q) COMPONENT(Type, q, s159d)
#define COMPONENT2(Type, q) COMPONENT(Type, q, s26ae)
#define COMPONENT3(Type, q) COMPONENT(Type, q, s37bf)
// Three numbers of each lane, one after the other: out[lane][4], the fourth 0.
static ALWAYS_INLINE void store_triples(Floats a, Floats b, Floats c, float* out) {
#define EVEN(p, q) __builtin_shufflevector(p, q, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23)
#define ODD(p, q) __builtin_shufflevector(p, q, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31)
  const Floats none = (Floats)(0.0f), low = EVEN(a, c), high = ODD(a, c), low_b = EVEN(b, none), high_b = ODD(b, none);
  STORE(EVEN(low, low_b), out);
  STORE(ODD(low, low_b), out + 16);
  STORE(EVEN(high, high_b), out + 32);
  STORE(ODD(high, high_b), out + 48);
#undef EVEN
#undef ODD
}
#elif LANES == 1
typedef float Floats;
typedef int Ints;
typedef float4 Quads;
typedef int4 QuadInts;
#define LANE_ARRAY
#define LOAD(array) (*(array))
#define STORE(value, array) (*(array) = (value))
#define MASK(condition) (-(condition))
#define TO_INTS(value) ((int)(value))
#define TO_FLOATS(value) ((float)(value))
static ALWAYS_INLINE bool any_of(Ints mask) { return mask != 0; }
static ALWAYS_INLINE void store_triples(Floats a, Floats b, Floats c, float* out) {
  out[0] = a, out[1] = b, out[2] = c, out[3] = 0.0f;
}
#define LANE_QUADS 1
#define COLLECT(q, f) q[0] = f(0)
#define COMPONENT0(Type, q) q[0].x
#define COMPONENT1(Type, q) q[0].y
#define COMPONENT2(Type, q) q[0].z
#define COMPONENT3(Type, q) q[0].w
#else
#error "TURBID_INTERLEAVE must be 1 or 16"
#endif

// fmin and fmax would spend instructions on what is not a number.
static ALWAYS_INLINE Floats least(Floats a, Floats b) { return a < b ? a : b; }
static ALWAYS_INLINE Floats greatest(Floats a, Floats b) { return a > b ? a : b; }

static ALWAYS_INLINE Ints not_negative(Ints a) { return a > 0 ? a : (Ints)(0); }

typedef struct {
  Floats x, y, z;
} Points;

static ALWAYS_INLINE Points load_points(const float* arrays) {
  return (Points){LOAD(arrays), LOAD(arrays + LANES), LOAD(arrays + 2 * LANES)};
}
static ALWAYS_INLINE void store_points(Points p, float* arrays) {
  STORE(p.x, arrays);
  STORE(p.y, arrays + LANES);
  STORE(p.z, arrays + 2 * LANES);
}
static ALWAYS_INLINE Points along(Points from, Floats factor, Points by) {
  return (Points){from.x + factor * by.x, from.y + factor * by.y, from.z + factor * by.z};
}
static ALWAYS_INLINE Points choose(Ints mask, Points a, Points b) {
  return (Points){mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}
static ALWAYS_INLINE Floats squared_length(Points a) { return a.x * a.x + a.y * a.y + a.z * a.z; }

// The cells between nodes that points lie in, as `locate` finds them.
typedef struct {
  Ints block, node;
  Points fraction;
} Cells;

static ALWAYS_INLINE Ints cells_along(Floats x, int voxels, Floats* fraction) {
  const Floats y = greatest(least(x - 0.5f, (Floats)(voxels - 1)), (Floats)(0.0f)), floor_y = TO_FLOATS(TO_INTS(y));
  const Floats cell = least(floor_y, (Floats)(voxels - 2));
  *fraction = y - cell;
  return TO_INTS(cell);
}

static ALWAYS_INLINE Cells locate_all(Points x) {
  Cells cells;
  const Ints ix = cells_along(x.x, TURBID_VOXELS_X, &cells.fraction.x);
  const Ints iy = cells_along(x.y, TURBID_VOXELS_Y, &cells.fraction.y);
  const Ints iz = cells_along(x.z, TURBID_VOXELS_Z, &cells.fraction.z);
  cells.block = (ix >> 3) + BLOCKS_X * ((iy >> 3) + BLOCKS_Y * (iz >> 3));
  cells.node = (ix & 7) + TURBID_TILE_EDGE * ((iy & 7) + TURBID_TILE_EDGE * (iz & 7));
  return cells;
}

#endif
