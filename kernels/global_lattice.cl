// SPDX-License-Identifier: Apache-2.0
// The lattice of lattice.cl as one whole, streamed in place (Bailey et al. 2009): single steps with one copy of the populations.
//
// Rows along x of neighbouring blocks are joined to runs; one work-item does one row, and rows follow one another in memory. A
// local step reads the arrivals of a voxel from its own slots and leaves what departs in the opposite slots; a crossing step reads
// arrivals from where the neighbours left them and puts what departs where the neighbours read next. Each place is read and
// written by one voxel, so nothing depends on the order. Towards a missing block a crossing step stays at the voxel's own slot and
// multiplies by the wall's R, both ways (boundary: f_in = R f_out, numerics section 3). What meets at other boundaries and at
// index jumps is mixed by `exchange`.
//
// Slots are [channel][population][places]; a row has eight places before its first voxel and eight after its last (those before
// the next row). Slot 2 axis ("down") holds arrivals of population 2 axis and, after a local step, departures of 2 axis + 1; slot
// 2 axis + 1 ("up") the reverse.
#include "shared/lattice_params.h"

#if !defined(TURBID_HALF)
#error "TURBID_HALF (1: populations are stored in half precision) must be defined"
#endif

typedef float8 Lanes;
#include "lib/collision.h"

// Eight aligned places: PoCL writes vstore8 in parts.
#define EIGHT(at) (*(const global float8*)(at))
#define PUT_EIGHT(at) (*(global float8*)(at))

// Populations are kept as Stored. In half precision what rounding takes from a voxel's departures waits in the voxel (`rest`, in half
// precision itself) and joins its next arrivals in equal parts: without it an absorption below 2^-11 per step would do nothing.
#if TURBID_HALF
typedef half Stored;
static float8 get8(const global half* at) { return vload_half8(0, at); }
static float get(const global half* at) { return vload_half(0, at); }
// Stores and returns what is lost thereby.
static float8 put8(float8 value, global half* at) {
  vstore_half8(value, 0, at);
  return value - vload_half8(0, at);
}
static float put(float value, global half* at) {
  vstore_half(value, 0, at);
  return value - vload_half(0, at);
}
#define GET_EIGHT get8
#define PUT_EIGHT_AT put8
#else
typedef float Stored;
static float8 get8(const global float* at) { return vload8(0, at); }
static float get(const global float* at) { return *at; }
static float8 put8(float8 value, global float* at) {
  vstore8(value, 0, at);
  return (float8)(0.0f);
}
static float put(float value, global float* at) {
  *at = value;
  return 0.0f;
}
#define GET_EIGHT(at) EIGHT(at)
static float8 put_aligned(float8 value, global float* at) {
  PUT_EIGHT(at) = value;
  return (float8)(0.0f);
}
#define PUT_EIGHT_AT put_aligned
#endif

static float sum8(float8 v) {
  const float4 half_sum = v.lo + v.hi;
  return (half_sum.x + half_sum.y) + (half_sum.z + half_sum.w);
}

// What the kernels below are given. rows[row]: place of the first voxel, first block, blocks, row within the run (y + 8 z).
// ends[row]: places of the voxels beyond its ends, < 0: a wall, whose R is end_walls[channel][row]; distance to the next row in
// y, in z. near[block][-y, +y, -z, +z]:
// place of the first row beyond the face and distance to the next one, or (-1 - wall, 0); walls[channel][wall][row][x]: R.
// even[channel][block]: p0 and p1 of all the block's voxels, or p0 < 0 where collision[channel][p0, p1][place] differs between
// them. lit[channel][block]: whether anything in source[channel][place] is not zero.
#define MEDIUM_ARGUMENTS                                                                                                      \
  const global float *collision, const global float2 *even, const global float *source, const global int *lit,                \
      const global int4 *rows, const global int4 *ends, const global float2 *end_walls, const global int2 *near,              \
      const global float *walls, int row_count, int block_count, int wall_count, int places, int channels
#define MEDIUM                                                                                                          \
  collision, even, source, lit, rows, ends, end_walls, near, walls, row_count, block_count, wall_count, places, channels

// Where a row's arrivals over one side are read and its departures written; 0 or the wall's R.
typedef struct {
  global Stored* slot;
  const global float* wall;
} Side;

// What lies beyond a block: `own` is the voxels' slot if there is a wall, `other` the neighbours' slot.
static Side side_of(global Stored* own, global Stored* other, const global float* walls, int2 near, int at, int along) {
  Side side;
  side.slot = near.x >= 0 ? other + near.x + along * near.y : own + at;
  side.wall = near.x >= 0 ? 0 : walls + (size_t)(-1 - near.x) * 64 + 8 * along;
  return side;
}

static float8 read_side(Side side) {
  const float8 f = GET_EIGHT(side.slot);
  return side.wall ? f * EIGHT(side.wall) : f;
}

static float8 write_side(Side side, float8 f) { return PUT_EIGHT_AT(side.wall ? f * EIGHT(side.wall) : f, side.slot); }

static float escaped_over(Side side, float8 f) { return side.wall ? sum8((1.0f - EIGHT(side.wall)) * f) : 0.0f; }

static void step_row(global Stored* slots, global Stored* rest, MEDIUM_ARGUMENTS, global float* fluence, global float* sums, const int crossing,
                     const int measure) {
  const int row_index = get_global_id(0), channel = get_global_id(1);
  if (row_index >= row_count || channel >= channels) return;
  const int4 row = rows[row_index], end = ends[row_index];
  const float2 end_wall = end_walls[(size_t)channel * row_count + row_index];
  const int y = row.w & 7, z = row.w >> 3, last = row.z - 1;
  global Stored* down_x = slots + (size_t)channel * 6 * places;
  global Stored* up_x = down_x + places;
  global Stored* down_y = up_x + places;
  global Stored* up_y = down_y + places;
  global Stored* down_z = up_y + places;
  global Stored* up_z = down_z + places;
  const global float* c0 = collision + (size_t)channel * 2 * places;
  const global float* c1 = c0 + places;
  const global float* q = source + (size_t)channel * places;
  const global float* wall = walls + (size_t)channel * wall_count * 64;
  float8 change = (float8)(0.0f), total = change, lost = change, arrived = change, forgotten = change;
  float escaped_xm = 0.0f, escaped_xp = 0.0f, escaped_ym = 0.0f, escaped_yp = 0.0f, escaped_zm = 0.0f, escaped_zp = 0.0f;
  for (int k = 0; k < row.z; ++k) {
    const int at = row.x + 8 * k, block = row.y + k;
    Side ym, yp, zm, zp;
    if (crossing || measure) {
      ym.slot = up_y + at - end.z;
      yp.slot = down_y + at + end.z;
      zm.slot = up_z + at - end.w;
      zp.slot = down_z + at + end.w;
      ym.wall = yp.wall = zm.wall = zp.wall = 0;
      if (y == 0) ym = side_of(down_y, up_y, wall, near[4 * block], at, z);
      if (y == 7) yp = side_of(up_y, down_y, wall, near[4 * block + 1], at, z);
      if (z == 0) zm = side_of(down_z, up_z, wall, near[4 * block + 2], at, y);
      if (z == 7) zp = side_of(up_z, down_z, wall, near[4 * block + 3], at, y);
    }
    Six f;
    if (crossing) {
      f.xp = get8(up_x + at - 1);
      f.xm = get8(down_x + at + 1);
      if (k == 0) f.xp.s0 = end.x < 0 ? end_wall.x * get(down_x + at) : get(up_x + end.x);
      if (k == last) f.xm.s7 = end.y < 0 ? end_wall.y * get(up_x + at + 7) : get(down_x + end.y);
      f.yp = read_side(ym);
      f.ym = read_side(yp);
      f.zp = read_side(zm);
      f.zm = read_side(zp);
    } else {
      f.xp = GET_EIGHT(down_x + at);
      f.xm = GET_EIGHT(up_x + at);
      f.yp = GET_EIGHT(down_y + at);
      f.ym = GET_EIGHT(up_y + at);
      f.zp = GET_EIGHT(down_z + at);
      f.zm = GET_EIGHT(up_z + at);
    }
#if TURBID_HALF
    global Stored* waiting = rest + (size_t)channel * places + at;
    const float8 share = get8(waiting) * (1.0f / 6.0f);
    f.xp += share;
    f.xm += share;
    f.yp += share;
    f.ym += share;
    f.zp += share;
    f.zm += share;
#endif
    const float2 same = even[(size_t)channel * block_count + block];
    float8 p0 = (float8)(same.x), p1 = (float8)(same.y), q0 = (float8)(0.0f);
    if (same.x < 0.0f) {
      p0 = EIGHT(c0 + at);
      p1 = EIGHT(c1 + at);
    }
    if (lit[(size_t)channel * block_count + block]) q0 = EIGHT(q + at);
    const float8 before = sum_of(f), after = (before - p0 * before) + q0;
    f = collide(f, before, after, p1);
    if (measure) {
      global float* psi = fluence + (size_t)channel * places + at;
      const float8 value = fluence_of(p0, p1, q0, before, after);
      change += fabs(value - EIGHT(psi));
      total += value;
      lost += before - after;
      arrived += before;
      PUT_EIGHT(psi) = value;
    }
    float8 rounded;
    if (crossing) {
      float8 below = put8(f.xm, up_x + at - 1), above = put8(f.xp, down_x + at + 1);
      if (k == 0) below.s0 = end.x < 0 ? put(end_wall.x * f.xm.s0, down_x + at) : put(f.xm.s0, up_x + end.x);
      if (k == last) above.s7 = end.y < 0 ? put(end_wall.y * f.xp.s7, up_x + at + 7) : put(f.xp.s7, down_x + end.y);
      rounded = below + above + write_side(ym, f.ym) + write_side(yp, f.yp) + write_side(zm, f.zm) + write_side(zp, f.zp);
    } else {
      Six e;
      e.xm = PUT_EIGHT_AT(f.xm, down_x + at);
      e.xp = PUT_EIGHT_AT(f.xp, up_x + at);
      e.ym = PUT_EIGHT_AT(f.ym, down_y + at);
      e.yp = PUT_EIGHT_AT(f.yp, up_y + at);
      e.zm = PUT_EIGHT_AT(f.zm, down_z + at);
      e.zp = PUT_EIGHT_AT(f.zp, up_z + at);
      rounded = sum_of(e);
      // What has been stored is what meets the walls.
      f.xm -= e.xm;
      f.xp -= e.xp;
      f.ym -= e.ym;
      f.yp -= e.yp;
      f.zm -= e.zm;
      f.zp -= e.zp;
    }
    if (measure) {
      if (k == 0 && end.x < 0) escaped_xm = (1.0f - end_wall.x) * f.xm.s0;
      if (k == last && end.y < 0) escaped_xp = (1.0f - end_wall.y) * f.xp.s7;
      escaped_ym += escaped_over(ym, f.ym);
      escaped_yp += escaped_over(yp, f.yp);
      escaped_zm += escaped_over(zm, f.zm);
      escaped_zp += escaped_over(zp, f.zp);
    }
#if TURBID_HALF
    rounded = put8(rounded, waiting);
    if (measure) forgotten += rounded;
#endif
  }
  if (measure) {
    global float* out = sums + 11 * ((size_t)channel * row_count + row_index);
    vstore4((float4)(sum8(change), sum8(total), sum8(lost), sum8(arrived)), 0, out);
    vstore4((float4)(escaped_xm, escaped_xp, escaped_ym, escaped_yp), 1, out);
    vstore2((float2)(escaped_zm, escaped_zp), 4, out);
    out[10] = sum8(forgotten);
  }
}

kernel void step_local(global Stored* slots, global Stored* rest, MEDIUM_ARGUMENTS) { step_row(slots, rest, MEDIUM, 0, 0, 0, 0); }
kernel void step_crossing(global Stored* slots, global Stored* rest, MEDIUM_ARGUMENTS) { step_row(slots, rest, MEDIUM, 0, 0, 1, 0); }

// The same, and the fluence is written and sums[channel][row][11] = summed |its change|, its sum, sum of phi - phi', sum of
// arrivals, power that escapes through the walls towards -x, +x, -y, +y, -z, +z, and what storing
// took away for good.
kernel void measure_local(global Stored* slots, global Stored* rest, MEDIUM_ARGUMENTS, global float* fluence, global float* sums) {
  step_row(slots, rest, MEDIUM, fluence, sums, 0, 1);
}
kernel void measure_crossing(global Stored* slots, global Stored* rest, MEDIUM_ARGUMENTS, global float* fluence, global float* sums) {
  step_row(slots, rest, MEDIUM, fluence, sums, 1, 1);
}

// Faces inside the blocks where arrivals are not simply what the neighbour sent: faces[face] = places of the voxel x below and y
// above it, axis. links[channel][face] = (own, other) of y, then of x: arrivals at y = own_y (from y) + other_y (from x).
// lost[0][channel][face]: power that went in and did not come out; lost[1]: what storing took away.
kernel void exchange(global Stored* slots, const global int4* faces, const global float4* links, global float* lost,
                     int face_count, int places, int channels, int crossed, int measure) {
  const int face = get_global_id(0), channel = get_global_id(1);
  if (face >= face_count || channel >= channels) return;
  const int4 place = faces[face];
  global Stored* down = slots + ((size_t)channel * 6 + 2 * place.z) * places + place.y;
  global Stored* up = slots + ((size_t)channel * 6 + 2 * place.z + 1) * places + place.x;
  const float from_x = crossed ? get(down) : get(up), from_y = crossed ? get(up) : get(down);
  const float4 k = links[(size_t)channel * face_count + face];
  const float at_y = k.x * from_y + k.y * from_x, at_x = k.z * from_x + k.w * from_y;
  const float rounded = put(crossed ? at_y : at_x, down) + put(crossed ? at_x : at_y, up);
  if (measure) {
    lost[(size_t)channel * face_count + face] = from_x + from_y - at_x - at_y;
    lost[(size_t)(channels + channel) * face_count + face] = rounded;
  }
}
