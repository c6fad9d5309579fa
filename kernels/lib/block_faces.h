// SPDX-License-Identifier: Apache-2.0
// What enters and leaves a block of the lattice (lattice.cl): interfaces, and populations kept in half precision.
#ifndef TURBID_LIB_BLOCK_FACES_H
#define TURBID_LIB_BLOCK_FACES_H

// Row ends across x, [row], as end lanes of vectors.
static Lanes row_ends(const global float* values, int v, int upper) {
#if EDGE == 8
  const float a = values[2 * v], b = values[2 * v + 1], o = 0.0f;
  return upper ? (Lanes)(o, o, o, o, o, o, o, a, o, o, o, o, o, o, o, b) : (Lanes)(a, o, o, o, o, o, o, o, b, o, o, o, o, o, o, o);
#else
  const float4 e = vload4(v, values);
  const float o = 0.0f;
  return upper ? (Lanes)(o, o, o, e.x, o, o, o, e.y, o, o, o, e.z, o, o, o, e.w)
               : (Lanes)(e.x, o, o, o, e.y, o, o, o, e.z, o, o, o, e.w, o, o, o);
#endif
}

static void load_faces(Faces* to, const global float* from[6]) {
  for (int side = 0; side < 2; ++side) {
    for (int v = 0; v < VECTORS; ++v) to->x[side][v] = row_ends(from[side], v, side);
    for (int z = 0; z < EDGE; ++z) to->y[side][z] = ROW_OF(z, from[2 + side]);
    for (int j = 0; j < PER_PLANE; ++j) to->z[side][j] = LANES_OF(j, from[4 + side]);
  }
}

// After a local step the next crossing one finds arrivals over the faces in `in`; a local step finds them in the slots.
static void add_arrivals(SPACE float* slots, const Faces* in) {
  for (int side = 0; side < 2; ++side) {
    SPACE float* slot = slots + side * VOXELS;
    for (int v = 0; v < VECTORS; ++v) SLOT_LANES(v, slot) = SLOT_LANES(v, slot) + in->x[side][v];
    slot = slots + (2 + side) * VOXELS + side * (EDGE - 1) * EDGE;
    for (int z = 0; z < EDGE; ++z) SLOT_ROW(EDGE * z, slot) = SLOT_ROW(EDGE * z, slot) + in->y[side][z];
    slot = slots + (4 + side) * VOXELS + side * (EDGE - 1) * ROWS;
    for (int j = 0; j < PER_PLANE; ++j) SLOT_LANES(j, slot) = SLOT_LANES(j, slot) + in->z[side][j];
  }
}

// 1 where what departs to a slot's side stays in the block, else 0: the neighbour has that from the interface, not from the slot.
static Lanes stays(int v, int slot) {
  const Lanes all = (Lanes)(1.0f);
  const Row no = (Row)(0.0f), yes = (Row)(1.0f);
  const int z = v / PER_PLANE, j = v % PER_PLANE;
  if (slot < 2) return as_float16(as_int16(all) & (slot == 0 ? NOT_FIRST : NOT_LAST));
  if (slot == 4) return z > 0 ? all : (Lanes)(0.0f);
  if (slot == 5) return z < EDGE - 1 ? all : (Lanes)(0.0f);
#if EDGE == 8
  if (slot == 2) return j == 0 ? (Lanes)(no, yes) : all;
  return j == PER_PLANE - 1 ? (Lanes)(yes, no) : all;
#else
  return slot == 2 ? (Lanes)(no, yes, yes, yes) : (Lanes)(yes, yes, yes, no);
#endif
}

#if TURBID_HALF
// A block's populations with what waits in its voxels, shared out among those that stay in the block: after a local step all but
// the departures over its faces, after a crossing one all.
static void take(float* slots, const global half* stored, const global half* rest, int after_local) {
  for (int v = 0; v < VECTORS; ++v) {
    Lanes count = (Lanes)(6.0f);
    if (after_local) {
      count = (Lanes)(0.0f);
      for (int i = 0; i < 6; ++i) count += stays(v, i);
    }
    const Lanes share = vload_half16(v, rest) / count;
    for (int i = 0; i < 6; ++i) {
      const Lanes more = after_local ? share * stays(v, i) : share;
      SLOT_LANES(v, slots + i * VOXELS) = vload_half16(v, stored + i * VOXELS) + more;
    }
  }
}

// Puts them back; returns what is lost for good.
static Lanes put_back(float* slots, global half* stored, global half* rest, int after_local) {
  Lanes lost = (Lanes)(0.0f);
  for (int v = 0; v < VECTORS; ++v) {
    Lanes waits = (Lanes)(0.0f);
    for (int i = 0; i < 6; ++i) {
      const Lanes f = SLOT_LANES(v, slots + i * VOXELS);
      vstore_half16(f, v, stored + i * VOXELS);
      const Lanes rounded = f - vload_half16(v, stored + i * VOXELS);
      waits += after_local ? rounded * stays(v, i) : rounded;
    }
    vstore_half16(waits, v, rest);
    lost += waits - vload_half16(v, rest);
  }
  return lost;
}
#endif

// What a block sends its neighbours: the mean over the inner steps of what left through each face. With the last step's instead
// (as in the paper) the exchange can amplify: two-relaxation-time modes of thin voxels alternate in sign from step to step and a
// frozen interface resonates with them. The mean can't: a step conserves or loses energy, sum_t |out_t|^2 + |x_m|^2 <= m |in|^2 +
// |x_0|^2, and |mean out|^2 <= sum_t |out_t|^2 / m, so |x|^2 + m |interfaces|^2 never grows. The steady state is the same.
static void send(const Faces* sent, global float* faces, float mean) {
  for (int v = 0; v < VECTORS; ++v) {
    const Lanes up = mean * sent->x[1][v], down = mean * sent->x[0][v];
#if EDGE == 8
    vstore2((float2)(up.s7, up.sf), v, faces);
    vstore2((float2)(down.s0, down.s8), v, faces + ROWS);
#else
    vstore4((float4)(up.s3, up.s7, up.sb, up.sf), v, faces);
    vstore4((float4)(down.s0, down.s4, down.s8, down.sc), v, faces + ROWS);
#endif
  }
  for (int z = 0; z < EDGE; ++z) {
    ROW(z, faces + 2 * ROWS) = mean * sent->y[1][z];
    ROW(z, faces + 3 * ROWS) = mean * sent->y[0][z];
  }
  for (int j = 0; j < PER_PLANE; ++j) {
    LANES(j, faces + 4 * ROWS) = mean * sent->z[1][j];
    LANES(j, faces + 5 * ROWS) = mean * sent->z[0][j];
  }
}

#endif
