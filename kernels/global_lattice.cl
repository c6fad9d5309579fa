// SPDX-License-Identifier: Apache-2.0
// The lattice of lattice.cl as one whole, streamed in place (Bailey et al. 2009): single steps with one copy of the populations.
//
// Rows along x of neighbouring blocks are joined to runs; one work-item does one row. Population i is kept in slot[i]. A local step
// reads the arrivals of a voxel from its own slots and leaves what departs in the opposite slots; a crossing step reads arrivals
// from where the neighbours left them and puts what departs where the neighbours read next. Each place is read and written by one
// voxel, so nothing depends on the order. `exchange` then mixes what meets at boundaries and index jumps.
//
// Slots are [channel][population][places]; a row has eight places before its first voxel and eight after its last (those before
// the next row); what lies beyond missing blocks has places at the end.
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
  const float8 phi_new = (1.0f - p0) * phi + q0;
#if TURBID_COLLISION == 3
  const float8 keep_even = p1 - 1.0f;
#else
  const float8 keep_even = 1.0f - p1;
#endif
  const float8 keep_odd = 0.5f * (1.0f - p1), base = phi_new * (1.0f / 6.0f), third = phi * (1.0f / 3.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const float8 even = base + 0.5f * keep_even * (f[2 * axis] + f[2 * axis + 1] - third);
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

// One step of every row. rows[row]: place of the first voxel, first block, blocks, row within the run (y + 8 z).
// near[block][-y, +y, -z, +z]: place of the first row beyond the face, distance to the next one. measure = 1: fluence is written and
// sums[channel][row][4] = summed |its change|, its sum, sum of phi - phi', sum of arrivals.
kernel void step_in_place(global float* slots, const global float* collision, const global float* source, const global int4* rows,
                 const global int2* near, global float* fluence, global float* sums, int row_count, int places, int channels,
                 int crossing, int measure) {
  const int row_index = get_global_id(0), channel = get_global_id(1);
  if (row_index >= row_count || channel >= channels) return;
  const int4 row = rows[row_index];
  const int y = row.w & 7, z = row.w >> 3, length = 8 * row.z + 8;
  global float* slot = slots + (size_t)channel * 6 * places;
  const global float* c = collision + (size_t)channel * 2 * places;
  const global float* q = source + (size_t)channel * places;
  global float* psi = fluence + (size_t)channel * places;
  float8 change = (float8)(0.0f), total = change, lost = change, arrived = change;
  for (int block = 0; block < row.z; ++block) {
    const int at = row.x + 8 * block;
    int from[6] = {at, at, at, at, at, at}, to[6] = {at, at, at, at, at, at};
    if (crossing) {
      const global int2* beyond = near + 4 * (row.y + block);
      const int ym = y > 0 ? at - length : beyond[0].x + z * beyond[0].y;
      const int yp = y < 7 ? at + length : beyond[1].x + z * beyond[1].y;
      const int zm = z > 0 ? at - 8 * length : beyond[2].x + y * beyond[2].y;
      const int zp = z < 7 ? at + 8 * length : beyond[3].x + y * beyond[3].y;
      from[0] = to[1] = at - 1;
      from[1] = to[0] = at + 1;
      from[2] = to[3] = ym;
      from[3] = to[2] = yp;
      from[4] = to[5] = zm;
      from[5] = to[4] = zp;
    }
    float8 f[6];
    for (int i = 0; i < 6; ++i) f[i] = vload8(0, slot + (size_t)(crossing ? i ^ 1 : i) * places + from[i]);
    const float8 p0 = vload8(0, c + at), p1 = vload8(0, c + places + at), q0 = vload8(0, q + at);
    if (measure) arrived += ((f[0] + f[1]) + (f[2] + f[3])) + (f[4] + f[5]);
    float8 before, after;
    collide(f, p0, p1, q0, &before, &after);
    for (int i = 0; i < 6; ++i) vstore8(f[i], 0, slot + (size_t)(crossing ? i : i ^ 1) * places + to[i]);
    if (measure) {
      const float8 value = fluence_of(p0, p1, q0, before, after);
      change += fabs(value - vload8(0, psi + at));
      total += value;
      lost += before - after;
      vstore8(value, 0, psi + at);
    }
  }
  if (measure) vstore4((float4)(sum8(change), sum8(total), sum8(lost), sum8(arrived)), 0,
                       sums + 4 * ((size_t)channel * row_count + row_index));
}

// Faces where arrivals are not simply what the neighbour sent. A face along an axis has the voxels x below and y above it;
// faces[face] = places p, q where a local step leaves what x and y send (slots 2 axis + 1 and 2 axis) and p', q' where a crossing
// step reads what arrives at y and x; these differ at periodic seams only. links[channel][face] = (own, other) of y, then of x:
// arrivals at y = own_y (from y) + other_y (from x). lost[channel][face]: power that went in and did not come out.
kernel void exchange(global float* slots, const global int4* faces, const global int* axes, const global float4* links,
                     global float* lost, int face_count, int places, int channels, int crossed, int measure) {
  const int face = get_global_id(0), channel = get_global_id(1);
  if (face >= face_count || channel >= channels) return;
  const int4 place = faces[face];
  const int axis = axes[face];
  global float* up = slots + ((size_t)channel * 6 + 2 * axis + 1) * places;  // slot 2 axis + 1: place p
  global float* down = slots + ((size_t)channel * 6 + 2 * axis) * places;    // slot 2 axis: place q
  const float from_x = crossed ? down[place.w] : up[place.x];
  const float from_y = crossed ? up[place.z] : down[place.y];
  const float4 k = links[(size_t)channel * face_count + face];
  const float at_y = k.x * from_y + k.y * from_x, at_x = k.z * from_x + k.w * from_y;
  if (crossed) {
    down[place.w] = up[place.z] = 0.0f;
    down[place.y] = at_y;
    up[place.x] = at_x;
  } else {
    up[place.x] = down[place.y] = 0.0f;
    up[place.z] = at_y;
    down[place.w] = at_x;
  }
  if (measure) lost[(size_t)channel * face_count + face] = from_x + from_y - at_x - at_y;
}
