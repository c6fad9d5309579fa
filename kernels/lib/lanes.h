// SPDX-License-Identifier: Apache-2.0
// TURBID_INTERLEAVE rays that go in step, one per lane: 32 on CPUs, where every instruction then serves sixteen of them and two
// such halves fill each other's waiting times; 1 on GPUs, whose work-items are lanes already. What a packet keeps is a plain
// array per number, so that single lanes are easy to reach.
#ifndef TURBID_LIB_LANES_H
#define TURBID_LIB_LANES_H
#include "lib/medium.h"

#if !defined(TURBID_INTERLEAVE)
#error "TURBID_INTERLEAVE (1 or 32: rays that a work-item follows in step) must be defined"
#endif
#define LANES TURBID_INTERLEAVE

#define UNROLL _Pragma("unroll")

// Masks are -1 where true.
#if LANES == 32
typedef float Floats __attribute__((ext_vector_type(32)));
typedef int Ints __attribute__((ext_vector_type(32)));
// Wide accesses: a load that took up several narrower stores would wait for them to reach the cache.
#define LANE_ARRAY __attribute__((aligned(128)))
static ALWAYS_INLINE Floats __attribute__((overloadable)) LOAD(const float* array) { return *(const Floats*)array; }
static ALWAYS_INLINE Ints __attribute__((overloadable)) LOAD(const int* array) { return *(const Ints*)array; }
static ALWAYS_INLINE void __attribute__((overloadable)) STORE(Floats value, float* array) { *(Floats*)array = value; }
static ALWAYS_INLINE void __attribute__((overloadable)) STORE(Ints value, int* array) { *(Ints*)array = value; }
// One lane's number, from memory: taking it out of a vector register costs more.
#define LANE(array, lane) (((volatile const int*)(array))[lane])
#define MASK(condition) (condition)
#define TO_INTS(value) __builtin_convertvector(value, Ints)
#define TO_FLOATS(value) __builtin_convertvector(value, Floats)
#define JOIN(low, high)                                                                                                    \
  __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, \
                          24, 25, 26, 27, 28, 29, 30, 31)
static ALWAYS_INLINE Floats square_root(Floats a) { return JOIN(sqrt(a.lo), sqrt(a.hi)); }
static ALWAYS_INLINE Floats exponential_less_one(Floats a) { return JOIN(expm1(a.lo), expm1(a.hi)); }
static ALWAYS_INLINE bool any_of(Ints mask) {
  const int16 sixteen = mask.lo | mask.hi;
  const int8 eight = sixteen.lo | sixteen.hi;
  const long2 two = as_long2(eight.lo | eight.hi);
  return (two.x | two.y) != 0;
}
// Bit i: lane i is in the mask.
static ALWAYS_INLINE uint lanes_in(Ints mask) {
  const int16 bit = (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
  const int16 sixteen = (mask.lo & bit) | (mask.hi & (bit << 16));
  const int8 eight = sixteen.lo | sixteen.hi;
  const int4 four = eight.lo | eight.hi;
  const int2 two = four.lo | four.hi;
  return (uint)(two.x | two.y);
}
// One, two and four numbers of four lanes each. What f(lane) gives for four lanes is put together in registers: narrow stores
// would keep a wide load waiting.
#define LANE_QUADS 8
typedef float4 Singles;
typedef float8 Pairs;
typedef float16 Quads;
typedef int16 QuadInts;
#define FOUR(Type, f, k) (Type)(f(4 * (k)), f(4 * (k) + 1), f(4 * (k) + 2), f(4 * (k) + 3))
// The first, second ... of the numbers, for all lanes.
#define COMPONENT(Type, q, s) (Type)(q[0].s, q[1].s, q[2].s, q[3].s, q[4].s, q[5].s, q[6].s, q[7].s)
#define ONLY(Type, q) COMPONENT(Type, q, s0123)
#define EVEN(Type, q) COMPONENT(Type, q, s0246)
#define ODD(Type, q) COMPONENT(Type, q, s1357)
#define COMPONENT0(Type, q) COMPONENT(Type, q, s048c)
#define COMPONENT1(Type, q) COMPONENT(Type, q, s159d)
#define COMPONENT2(Type, q) COMPONENT(Type, q, s26ae)
#define COMPONENT3(Type, q) COMPONENT(Type, q, s37bf)
// Three numbers of each lane, one after the other: out[lane][4], the fourth 0.
static ALWAYS_INLINE void store_triples_of_half(float16 a, float16 b, float16 c, float* out) {
#define FIRST_HALVES(p, q) __builtin_shufflevector(p, q, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23)
#define SECOND_HALVES(p, q) __builtin_shufflevector(p, q, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31)
  const float16 none = (float16)(0.0f), low = FIRST_HALVES(a, c), high = SECOND_HALVES(a, c), low_b = FIRST_HALVES(b, none),
                high_b = SECOND_HALVES(b, none);
  *(float16*)out = FIRST_HALVES(low, low_b);
  *(float16*)(out + 16) = SECOND_HALVES(low, low_b);
  *(float16*)(out + 32) = FIRST_HALVES(high, high_b);
  *(float16*)(out + 48) = SECOND_HALVES(high, high_b);
#undef FIRST_HALVES
#undef SECOND_HALVES
}
static ALWAYS_INLINE void store_triples(Floats a, Floats b, Floats c, float* out) {
  store_triples_of_half(a.lo, b.lo, c.lo, out);
  store_triples_of_half(a.hi, b.hi, c.hi, out + 64);
}
#elif LANES == 1
typedef float Floats;
typedef int Ints;
#define LANE_ARRAY
#define LOAD(array) (*(array))
#define STORE(value, array) (*(array) = (value))
#define LANE(array, lane) ((array)[lane])
#define MASK(condition) (-(condition))
#define TO_INTS(value) ((int)(value))
#define TO_FLOATS(value) ((float)(value))
static ALWAYS_INLINE float square_root(float a) { return sqrt(a); }
static ALWAYS_INLINE float exponential_less_one(float a) { return expm1(a); }
static ALWAYS_INLINE bool any_of(Ints mask) { return mask != 0; }
static ALWAYS_INLINE uint lanes_in(Ints mask) { return mask & 1; }
static ALWAYS_INLINE void store_triples(Floats a, Floats b, Floats c, float* out) {
  out[0] = a, out[1] = b, out[2] = c, out[3] = 0.0f;
}
#define LANE_QUADS 1
typedef float Singles;
typedef float2 Pairs;
typedef float4 Quads;
typedef int4 QuadInts;
#define FOUR(Type, f, k) f(0)
#define ONLY(Type, q) q[0]
#define EVEN(Type, q) q[0].x
#define ODD(Type, q) q[0].y
#define COMPONENT0(Type, q) q[0].x
#define COMPONENT1(Type, q) q[0].y
#define COMPONENT2(Type, q) q[0].z
#define COMPONENT3(Type, q) q[0].w
#else
#error "TURBID_INTERLEAVE must be 1 or 32"
#endif

// The lanes of a mask one after the other; `i` counts them.
#define FOR_LANES(i, mask) \
  for (uint rest_ = lanes_in(mask), i = 0; rest_ != 0 && (i = 31 - clz(rest_ & -rest_), true); rest_ &= rest_ - 1)

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
