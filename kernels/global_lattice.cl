// SPDX-License-Identifier: Apache-2.0
// The lattice of lattice.cl as one whole, streamed in place (Bailey et al. 2009): single steps with one copy of the populations.
//
// Rows along x of neighbouring blocks are joined to runs; one work-item does one row. A local step reads the arrivals of a voxel
// from its own slots and leaves what departs in the opposite slots; a crossing step reads arrivals from where the neighbours left
// them and puts what departs where the neighbours read next. Each place is read and written by one voxel, so nothing depends on
// the order. Towards a missing block a crossing step stays at the voxel's own slot and multiplies by the wall's R, both ways
// (boundary: f_in = R f_out, numerics section 3). What meets at other boundaries and at index jumps is mixed by `exchange`.
//
// Slots are [channel][population][places]; a row has eight places before its first voxel and eight after its last (those before
// the next row). Slot 2 axis ("down") holds arrivals of population 2 axis and, after a local step, departures of 2 axis + 1; slot
// 2 axis + 1 ("up") the reverse.
#include "shared/lattice_params.h"

#if !defined(TURBID_COLLISION)
#error "TURBID_COLLISION (0 paper, 1 exponential, 2 trapezoid, 3 trt) must be defined"
#endif

static float sum8(float8 v) {
  const float4 half_sum = v.lo + v.hi;
  return (half_sum.x + half_sum.y) + (half_sum.z + half_sum.w);
}

// phi' = (1 - p0) phi + q0 and the moments' relaxation (lattice.cl); two-relaxation-time: p2 = 4 / (s + 2) = 2 - p1.
static void collide(float8* f, float8 p0, float8 p1, float8 q0, float8* before, float8* after) {
  const float8 phi = ((f[0] + f[1]) + (f[2] + f[3])) + (f[4] + f[5]);
  const float8 phi_new = (phi - p0 * phi) + q0;
  const float8 keep_odd = 0.5f - 0.5f * p1;
#if TURBID_COLLISION == 3
  const float8 keep_even = -keep_odd;
#else
  const float8 keep_even = keep_odd;
#endif
  const float8 base = phi_new * (1.0f / 6.0f) - keep_even * (phi * (1.0f / 3.0f));
  for (int axis = 0; axis < 3; ++axis) {
    const float8 even = base + keep_even * (f[2 * axis] + f[2 * axis + 1]);
    const float8 odd = keep_odd * (f[2 * axis] - f[2 * axis + 1]);
    f[2 * axis] = even + odd;
    f[2 * axis + 1] = even - odd;
  }
  *before = phi;
  *after = phi_new;
}

static float8 fluence_of(float8 p0, float8 p1, float8 q0, float8 before, float8 after) {
#if TURBID_COLLISION == 0
  return before;
#elif TURBID_COLLISION == 1
  const float8 s = -log1p(-p1);  // p1 = 1 - e^-s
  return s > 0.0f ? before * p1 / s : before;
#elif TURBID_COLLISION == 2
  return 0.5f * (before + after);
#else
  // psi = m - (s_a' m - q*) s / 4 (numerics section 1).
  const float8 s = p1 / (1.0f - 0.5f * p1), absorbed = p0 / (1.0f - 0.5f * p0);
  const float8 mean = 0.5f * (before + after), q_star = q0 * (1.0f + 0.5f * absorbed);
  return mean - 0.25f * s * (absorbed * mean - q_star);
#endif
}

// What the kernels below are given. rows[row]: place of the first voxel, first block, blocks, row within the run (y + 8 z).
// ends[row]: places of the voxels beyond its ends, < 0: a wall, whose R is end_walls[channel][row]. near[block][-y, +y, -z, +z]:
// place of the first row beyond the face and distance to the next one, or (-1 - wall, 0); walls[channel][wall][row][x]: R.
// even[channel][block]: p0 and p1 of all the block's voxels, or p0 < 0 where collision[channel][p0, p1][place] differs between
// them. lit[channel][block]: whether anything in source[channel][place] is not zero.
#define MEDIUM_ARGUMENTS                                                                                                      \
  const global float *collision, const global float2 *even, const global float *source, const global int *lit,                \
      const global int4 *rows, const global int2 *ends, const global float2 *end_walls, const global int2 *near,              \
      const global float *walls, int row_count, int block_count, int wall_count, int places, int channels
#define MEDIUM                                                                                                          \
  collision, even, source, lit, rows, ends, end_walls, near, walls, row_count, block_count, wall_count, places, channels

// Where a row's arrivals over one side are read and its departures written; 0 or the wall's R.
typedef struct {
  global float* slot;
  const global float* wall;
} Side;

// `own`: the voxels' slot if there is a wall, `other`: the neighbours' slot; inner: place of the row beyond within the block.
static Side side_of(global float* own, global float* other, const global float* walls, int2 near, int at, int inner, int is_inner,
                    int along) {
  Side side = {other + inner, 0};
  if (is_inner) return side;
  if (near.x >= 0) {
    side.slot = other + near.x + along * near.y;
  } else {
    side.slot = own + at;
    side.wall = walls + (size_t)(-1 - near.x) * 64 + 8 * along;
  }
  return side;
}

static void step_row(global float* slots, MEDIUM_ARGUMENTS, global float* fluence, global float* sums, const int crossing,
                     const int measure) {
  const int row_index = get_global_id(0), channel = get_global_id(1);
  if (row_index >= row_count || channel >= channels) return;
  const int4 row = rows[row_index];
  const int2 end = ends[row_index];
  const float2 end_wall = end_walls[(size_t)channel * row_count + row_index];
  const int y = row.w & 7, z = row.w >> 3, length = 8 * row.z + 8;
  global float* s0 = slots + (size_t)channel * 6 * places;
  global float* s1 = s0 + places;
  global float* s2 = s1 + places;
  global float* s3 = s2 + places;
  global float* s4 = s3 + places;
  global float* s5 = s4 + places;
  const global float* c0 = collision + (size_t)channel * 2 * places;
  const global float* c1 = c0 + places;
  const global float* q = source + (size_t)channel * places;
  const global float* wall = walls + (size_t)channel * wall_count * 64;
  float8 change = (float8)(0.0f), total = change, lost = change, arrived = change;
  float escaped[6] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  for (int k = 0; k < row.z; ++k) {
    const int at = row.x + 8 * k, block = row.y + k;
    Side side[4];
    if (crossing || measure) {
      const global int2* beyond = near + 4 * block;
      side[0] = side_of(s2, s3, wall, beyond[0], at, at - length, y > 0, z);
      side[1] = side_of(s3, s2, wall, beyond[1], at, at + length, y < 7, z);
      side[2] = side_of(s4, s5, wall, beyond[2], at, at - 8 * length, z > 0, y);
      side[3] = side_of(s5, s4, wall, beyond[3], at, at + 8 * length, z < 7, y);
    }
    float8 f[6];
    if (crossing) {
      f[0] = vload8(0, s1 + at - 1);
      f[1] = vload8(0, s0 + at + 1);
      if (k == 0) f[0].s0 = end.x < 0 ? end_wall.x * s0[at] : s1[end.x];
      if (k == row.z - 1) f[1].s7 = end.y < 0 ? end_wall.y * s1[at + 7] : s0[end.y];
      for (int i = 0; i < 4; ++i) {
        f[2 + i] = vload8(0, side[i].slot);
        if (side[i].wall) f[2 + i] *= vload8(0, side[i].wall);
      }
    } else {
      f[0] = vload8(0, s0 + at);
      f[1] = vload8(0, s1 + at);
      f[2] = vload8(0, s2 + at);
      f[3] = vload8(0, s3 + at);
      f[4] = vload8(0, s4 + at);
      f[5] = vload8(0, s5 + at);
    }
    const float2 same = even[(size_t)channel * block_count + block];
    float8 p0 = (float8)(same.x), p1 = (float8)(same.y), q0 = (float8)(0.0f);
    if (same.x < 0.0f) {
      p0 = vload8(0, c0 + at);
      p1 = vload8(0, c1 + at);
    }
    if (lit[(size_t)channel * block_count + block]) q0 = vload8(0, q + at);
    if (measure) arrived += ((f[0] + f[1]) + (f[2] + f[3])) + (f[4] + f[5]);
    float8 before, after;
    collide(f, p0, p1, q0, &before, &after);
    if (measure) {
      global float* psi = fluence + (size_t)channel * places + at;
      const float8 value = fluence_of(p0, p1, q0, before, after);
      change += fabs(value - vload8(0, psi));
      total += value;
      lost += before - after;
      vstore8(value, 0, psi);
      if (k == 0 && end.x < 0) escaped[0] = (1.0f - end_wall.x) * f[1].s0;
      if (k == row.z - 1 && end.y < 0) escaped[1] = (1.0f - end_wall.y) * f[0].s7;
      for (int i = 0; i < 4; ++i) {
        if (side[i].wall) escaped[2 + i] += sum8((1.0f - vload8(0, side[i].wall)) * f[2 + (i ^ 1)]);
      }
    }
    if (crossing) {
      vstore8(f[1], 0, s1 + at - 1);
      vstore8(f[0], 0, s0 + at + 1);
      if (k == 0) {
        if (end.x < 0) s0[at] = end_wall.x * f[1].s0;
        else s1[end.x] = f[1].s0;
      }
      if (k == row.z - 1) {
        if (end.y < 0) s1[at + 7] = end_wall.y * f[0].s7;
        else s0[end.y] = f[0].s7;
      }
      for (int i = 0; i < 4; ++i) {
        float8 out = f[2 + (i ^ 1)];
        if (side[i].wall) out *= vload8(0, side[i].wall);
        vstore8(out, 0, side[i].slot);
      }
    } else {
      vstore8(f[1], 0, s0 + at);
      vstore8(f[0], 0, s1 + at);
      vstore8(f[3], 0, s2 + at);
      vstore8(f[2], 0, s3 + at);
      vstore8(f[5], 0, s4 + at);
      vstore8(f[4], 0, s5 + at);
    }
  }
  if (measure) {
    global float* out = sums + 10 * ((size_t)channel * row_count + row_index);
    vstore4((float4)(sum8(change), sum8(total), sum8(lost), sum8(arrived)), 0, out);
    for (int i = 0; i < 6; ++i) out[4 + i] = escaped[i];
  }
}

kernel void step_local(global float* slots, MEDIUM_ARGUMENTS) { step_row(slots, MEDIUM, 0, 0, 0, 0); }
kernel void step_crossing(global float* slots, MEDIUM_ARGUMENTS) { step_row(slots, MEDIUM, 0, 0, 1, 0); }

// The same, and the fluence is written and sums[channel][row][10] = summed |its change|, its sum, sum of phi - phi', sum of
// arrivals, power that escapes through the walls towards -x, +x, -y, +y, -z, +z.
kernel void measure_local(global float* slots, MEDIUM_ARGUMENTS, global float* fluence, global float* sums) {
  step_row(slots, MEDIUM, fluence, sums, 0, 1);
}
kernel void measure_crossing(global float* slots, MEDIUM_ARGUMENTS, global float* fluence, global float* sums) {
  step_row(slots, MEDIUM, fluence, sums, 1, 1);
}

// Faces inside the blocks where arrivals are not simply what the neighbour sent: faces[face] = places of the voxel x below and y
// above it, axis. links[channel][face] = (own, other) of y, then of x: arrivals at y = own_y (from y) + other_y (from x).
// lost[channel][face]: power that went in and did not come out.
kernel void exchange(global float* slots, const global int4* faces, const global float4* links, global float* lost,
                     int face_count, int places, int channels, int crossed, int measure) {
  const int face = get_global_id(0), channel = get_global_id(1);
  if (face >= face_count || channel >= channels) return;
  const int4 place = faces[face];
  global float* down = slots + ((size_t)channel * 6 + 2 * place.z) * places + place.y;
  global float* up = slots + ((size_t)channel * 6 + 2 * place.z + 1) * places + place.x;
  const float from_x = crossed ? *down : *up, from_y = crossed ? *up : *down;
  const float4 k = links[(size_t)channel * face_count + face];
  const float at_y = k.x * from_y + k.y * from_x, at_x = k.z * from_x + k.w * from_y;
  *down = crossed ? at_y : at_x;
  *up = crossed ? at_x : at_y;
  if (measure) lost[(size_t)channel * face_count + face] = from_x + from_y - at_x - at_y;
}
