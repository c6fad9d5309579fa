// SPDX-License-Identifier: Apache-2.0
// Blockwise lattice-Boltzmann diffusion (Bernabei et al. III-C, Eq. 4-5, corrected and with other collisions, lib/collision.h):
// blocks of edge^3 voxels iterate alone while what their neighbours last sent waits in interface buffers.
//
// One work-item per block and channel, sixteen voxels (two or four rows along x) to a vector. Inside a block populations stream in
// place (Bailey et al. 2009), which halves what the cache must hold: a crossing step reads a voxel's arrivals from where its
// neighbours left them and puts its departures where they read next, a local step reads and leaves them in the voxel's own slots.
// Each place is read and written by one voxel. Slots are [6][voxel]: slot 2 axis ("down") holds arrivals of population 2 axis,
// or departures of 2 axis + 1 after a local step; slot 2 axis + 1 ("up") the reverse. Crossing steps come first, and alternate.
#include "shared/lattice_params.h"

#if !defined(TURBID_EDGE) || !defined(TURBID_HALF)
#error "TURBID_EDGE (4 or 8) and TURBID_HALF (1: populations are stored in half precision) must be defined"
#endif

typedef float16 Lanes;
#include "lib/collision.h"

#define EDGE TURBID_EDGE
#define ROWS (EDGE * EDGE)
#define VOXELS (EDGE * EDGE * EDGE)
#define VECTORS (VOXELS / 16)
#define PER_PLANE (VECTORS / EDGE)

#if EDGE == 8
typedef float8 Row;
#define NOT_FIRST (int16)(0, -1, -1, -1, -1, -1, -1, -1, 0, -1, -1, -1, -1, -1, -1, -1)
#define NOT_LAST (int16)(-1, -1, -1, -1, -1, -1, -1, 0, -1, -1, -1, -1, -1, -1, -1, 0)
static Row first_row(Lanes v) { return v.lo; }
static Row last_row(Lanes v) { return v.hi; }
#else
typedef float4 Row;
#define NOT_FIRST (int16)(0, -1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1)
#define NOT_LAST (int16)(-1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0, -1, -1, -1, 0)
static Row first_row(Lanes v) { return v.s0123; }
static Row last_row(Lanes v) { return v.scdef; }
#endif

// Populations are kept as Stored. In half precision a block's are taken to private memory and put back after the last inner step; what
// rounding takes from a voxel's departures waits in the voxel (`rest`, in half precision itself) and is shared out among them when
// they are taken next: without it an absorption below 2^-11 per sweep would do nothing.
#if TURBID_HALF
typedef half Stored;
#define SPACE private
#else
typedef float Stored;
#define SPACE global
#endif

// Rows and vectors of rows of a block's arrays, which are aligned to them. PoCL writes vstore16 in parts, too.
#define ROW(row, at) (((global Row*)(at))[row])
#define ROW_OF(row, at) (((const global Row*)(at))[row])
#define LANES(v, at) (((global Lanes*)(at))[v])
#define LANES_OF(v, at) (((const global Lanes*)(at))[v])
// The same of populations.
#define SLOT_ROW(row, at) (((SPACE Row*)(at))[row])
#define SLOT_LANES(v, at) (((SPACE Lanes*)(at))[v])

// Rows moved one voxel up or down along x; zeros follow. By one permutation and a mask: PoCL stores vectors that are put together
// from parts in parts, and whole loads then wait for them.
static Lanes shift_up(Lanes v) { return as_float16(as_int16(v.sf0123456789abcde) & NOT_FIRST); }
static Lanes shift_down(Lanes v) { return as_float16(as_int16(v.s123456789abcdef0) & NOT_LAST); }

static float sum16(Lanes v) {
  const float8 half_sum = v.lo + v.hi;
  const float4 quarter = half_sum.lo + half_sum.hi;
  return (quarter.x + quarter.y) + (quarter.z + quarter.w);
}

// Something at each face of a block, -x, +x, -y, ...: across x in the end lanes of whole vectors.
typedef struct {
  Lanes x[2][VECTORS];
  Row y[2][EDGE];
  Lanes z[2][PER_PLANE];
} Faces;

// A block's constant data for one channel.
typedef struct {
  const global float* collision;  // [p0 | p1][voxel], or 0 where they are the same in all voxels:
  Lanes p0, p1;
  const global float* source;     // q0 [voxel], or 0 where it is dark
  int walled;                     // arrivals at some face are not simply what the neighbour sent
} Block;

// Rows of y-neighbours: slot `up` is read one row below (arrivals of +y), `down` one row above; `side` is what comes over a face.
static Lanes rows_below(SPACE float* slot, int v, Row side) {
#if EDGE == 8
  return (Lanes)(v % PER_PLANE == 0 ? side : SLOT_ROW(2 * v - 1, slot), SLOT_ROW(2 * v, slot));
#else
  return (Lanes)(side, SLOT_ROW(4 * v, slot), SLOT_ROW(4 * v + 1, slot), SLOT_ROW(4 * v + 2, slot));
#endif
}
static Lanes rows_above(SPACE float* slot, int v, Row side) {
#if EDGE == 8
  return (Lanes)(SLOT_ROW(2 * v + 1, slot), v % PER_PLANE == PER_PLANE - 1 ? side : SLOT_ROW(2 * v + 2, slot));
#else
  return (Lanes)(SLOT_ROW(4 * v + 1, slot), SLOT_ROW(4 * v + 2, slot), SLOT_ROW(4 * v + 3, slot), side);
#endif
}
// Puts the rows of f one row lower or higher; the one that leaves the block is dropped.
static void to_rows_below(Lanes f, SPACE float* slot, int v) {
#if EDGE == 8
  if (v % PER_PLANE != 0) SLOT_ROW(2 * v - 1, slot) = f.lo;
  SLOT_ROW(2 * v, slot) = f.hi;
#else
  SLOT_ROW(4 * v, slot) = f.s4567;
  SLOT_ROW(4 * v + 1, slot) = f.s89ab;
  SLOT_ROW(4 * v + 2, slot) = f.scdef;
#endif
}
static void to_rows_above(Lanes f, SPACE float* slot, int v) {
#if EDGE == 8
  SLOT_ROW(2 * v + 1, slot) = f.lo;
  if (v % PER_PLANE != PER_PLANE - 1) SLOT_ROW(2 * v + 2, slot) = f.hi;
#else
  SLOT_ROW(4 * v + 1, slot) = f.s0123;
  SLOT_ROW(4 * v + 2, slot) = f.s4567;
  SLOT_ROW(4 * v + 3, slot) = f.s89ab;
#endif
}

// Summed |change| of the fluence, the fluence, phi - phi', phi'.
typedef struct {
  Lanes change, total, lost, after, after_low;
} Sums;

// Compensated (Kahan): what is under way is summed before and after a step, and half precision's equal values round alike.
static void add_exactly(Lanes* sum, Lanes* low, Lanes value) {
  const Lanes term = value - *low, larger = *sum + term;
  *low = (larger - *sum) - term;
  *sum = larger;
}

// One step. in: arrivals over the faces; wall: share of a voxel's departure that comes back. A crossing step leaves in the
// end voxels' slots what arrives there next: own share, and `keep` (1, or 0 after the last step) of what comes in.
__attribute__((always_inline)) static void step(SPACE float* slots, const Block* block, const Faces* in, const Faces* wall, Faces* sent, float keep,
                 global float* fluence, Sums* sums, const int crossing, int last) {
  SPACE float* down_x = slots;
  SPACE float* up_x = slots + VOXELS;
  SPACE float* down_y = slots + 2 * VOXELS;
  SPACE float* up_y = slots + 3 * VOXELS;
  SPACE float* down_z = slots + 4 * VOXELS;
  SPACE float* up_z = slots + 5 * VOXELS;
  const int walled = block->walled;
  for (int v = 0; v < VECTORS; ++v) {
    const int z = v / PER_PLANE, j = v % PER_PLANE;
    Six f;
    if (crossing) {
      const Lanes below = SLOT_LANES(v, up_x), above = SLOT_LANES(v, down_x);
      f.xp = shift_up(below) + in->x[0][v];
      f.xm = shift_down(above) + in->x[1][v];
      Row ym = in->y[0][z], yp = in->y[1][z];
      Lanes zm = in->z[0][j], zp = in->z[1][j];
      if (walled) {
        f.xp += wall->x[0][v] * above;
        f.xm += wall->x[1][v] * below;
        ym += wall->y[0][z] * SLOT_ROW(EDGE * z, down_y);
        yp += wall->y[1][z] * SLOT_ROW(EDGE * z + EDGE - 1, up_y);
        zm += wall->z[0][j] * SLOT_LANES(v, down_z);
        zp += wall->z[1][j] * SLOT_LANES(v, up_z);
      }
      f.yp = rows_below(up_y, v, ym);
      f.ym = rows_above(down_y, v, yp);
      f.zp = z > 0 ? SLOT_LANES(v - PER_PLANE, up_z) : zm;
      f.zm = z < EDGE - 1 ? SLOT_LANES(v + PER_PLANE, down_z) : zp;
    } else {
      f.xp = SLOT_LANES(v, down_x);
      f.xm = SLOT_LANES(v, up_x);
      f.yp = SLOT_LANES(v, down_y);
      f.ym = SLOT_LANES(v, up_y);
      f.zp = SLOT_LANES(v, down_z);
      f.zm = SLOT_LANES(v, up_z);
    }
    Lanes p0 = block->p0, p1 = block->p1, q0 = (Lanes)(0.0f);
    if (block->collision) {
      p0 = LANES_OF(v, block->collision);
      p1 = LANES_OF(v, block->collision + VOXELS);
    }
    if (block->source) q0 = LANES_OF(v, block->source);
    const Lanes before = sum_of(f), after = (before - p0 * before) + q0;
    f = collide(f, before, after, p1);
    if (last) {
      const Lanes value = fluence_of(p0, p1, q0, before, after);
      sums->change += fabs(value - LANES_OF(v, fluence));
      sums->total += value;
      sums->lost += before - after;
      add_exactly(&sums->after, &sums->after_low, after);
      LANES(v, fluence) = value;
    }
    sent->x[0][v] += f.xm;
    sent->x[1][v] += f.xp;
    if (j == 0) sent->y[0][z] += first_row(f.ym);
    if (j == PER_PLANE - 1) sent->y[1][z] += last_row(f.yp);
    if (z == 0) sent->z[0][j] += f.zm;
    if (z == EDGE - 1) sent->z[1][j] += f.zp;
    if (crossing) {
      Lanes at_xm = shift_up(f.xp) + keep * in->x[0][v], at_xp = shift_down(f.xm) + keep * in->x[1][v];
      Row at_ym = keep * in->y[0][z], at_yp = keep * in->y[1][z];
      Lanes at_zm = keep * in->z[0][j], at_zp = keep * in->z[1][j];
      if (walled) {
        at_xm += wall->x[0][v] * f.xm;
        at_xp += wall->x[1][v] * f.xp;
        at_ym += wall->y[0][z] * first_row(f.ym);
        at_yp += wall->y[1][z] * last_row(f.yp);
        at_zm += wall->z[0][j] * f.zm;
        at_zp += wall->z[1][j] * f.zp;
      }
      SLOT_LANES(v, down_x) = at_xm;
      SLOT_LANES(v, up_x) = at_xp;
      to_rows_below(f.ym, up_y, v);
      to_rows_above(f.yp, down_y, v);
      if (j == 0) SLOT_ROW(EDGE * z, down_y) = at_ym;
      if (j == PER_PLANE - 1) SLOT_ROW(EDGE * z + EDGE - 1, up_y) = at_yp;
      if (z > 0) SLOT_LANES(v - PER_PLANE, up_z) = f.zm;
      else SLOT_LANES(v, down_z) = at_zm;
      if (z < EDGE - 1) SLOT_LANES(v + PER_PLANE, down_z) = f.zp;
      else SLOT_LANES(v, up_z) = at_zp;
    } else {
      SLOT_LANES(v, down_x) = f.xm;
      SLOT_LANES(v, up_x) = f.xp;
      SLOT_LANES(v, down_y) = f.ym;
      SLOT_LANES(v, up_y) = f.yp;
      SLOT_LANES(v, down_z) = f.zm;
      SLOT_LANES(v, up_z) = f.zp;
    }
  }
}

// Faces within a block where arrivals are not simply what the neighbour sent, before a step that is crossing or local:
// face = place of the voxel x below | place of y above it << 9 | axis << 18; share = (own, other) of y, then of x.
static void exchange(SPACE float* slots, const global int* faces, const global float4* shares, int begin, int end, int crossing) {
  for (int i = begin; i < end; ++i) {
    const int face = faces[i], axis = face >> 18;
    SPACE float* down = slots + 2 * axis * VOXELS + ((face >> 9) & 511);
    SPACE float* up = slots + (2 * axis + 1) * VOXELS + (face & 511);
    const float from_x = crossing ? *up : *down, from_y = crossing ? *down : *up;
    const float4 k = shares[i];
    const float at_y = k.x * from_y + k.y * from_x, at_x = k.z * from_x + k.w * from_y;
    *up = crossing ? at_y : at_x;
    *down = crossing ? at_x : at_y;
  }
}

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

// `inner` steps in every block, the first one crossing or, where so many steps have been done, local.
// collision[channel][block][p0, p1][voxel], used where even[channel][block].x < 0: else p0 and p1 of all its voxels.
// source[channel][block][voxel], used where lit[channel][block]. wall_block[block]: its number among those with walls, or -1;
// walls[channel][wall block][own, other][face][row]: shares of a voxel's departure and of what the neighbour sent that arrive.
// first_face[block]: faces[...] and shares[channel][...] up to the next block's belong to it. interfaces[channel][block and a block
// of zeros][population][row]. sums[channel][block][5]: Sums of the last step, and what storing took
// away for good.
kernel void sweep(const global float* collision, const global float2* even, const global float* source, const global int* lit,
                  const global int* wall_block, const global float* walls, const global int* first_face, const global int* faces,
                  const global float4* shares, const global int* neighbours, const global float* interfaces_in,
                  global float* interfaces_out, global Stored* populations, global Stored* rest, global float* fluence,
                  global float* sums, int blocks,
                  int wall_blocks, int channels, int inner, int local_first) {
  const int block_index = get_global_id(0), channel = get_global_id(1);
  if (block_index >= blocks || channel >= channels) return;
  const size_t index = (size_t)channel * blocks + block_index;
  const int wall_index = wall_block[block_index];
  Block block;
  block.collision = even[index].x < 0.0f ? collision + index * 2 * VOXELS : 0;
  block.p0 = (Lanes)(even[index].x);
  block.p1 = (Lanes)(even[index].y);
  block.source = lit[index] ? source + index * VOXELS : 0;
  block.walled = wall_index >= 0;
  Faces in, wall, sent;
  const global float* from[6];
  for (int i = 0; i < 6; ++i) {
    // Directions are numbered +x, -x, ... and faces -x, +x, ...: population +x (0) arrives over the face -x (0).
    const int other = neighbours[6 * block_index + i];
    from[i] = interfaces_in + (((size_t)channel * (blocks + 1) + other) * 6 + i) * ROWS;
  }
  load_faces(&in, from);
  if (block.walled) {
    const global float* own = walls + ((size_t)channel * wall_blocks + wall_index) * 12 * ROWS;
    for (int i = 0; i < 6; ++i) from[i] = own + (6 + i) * ROWS;
    load_faces(&wall, from);
    for (int side = 0; side < 2; ++side) {
      for (int v = 0; v < VECTORS; ++v) in.x[side][v] *= wall.x[side][v];
      for (int z = 0; z < EDGE; ++z) in.y[side][z] *= wall.y[side][z];
      for (int j = 0; j < PER_PLANE; ++j) in.z[side][j] *= wall.z[side][j];
    }
    for (int i = 0; i < 6; ++i) from[i] = own + i * ROWS;
    load_faces(&wall, from);
  }
  for (int side = 0; side < 2; ++side) {
    for (int v = 0; v < VECTORS; ++v) sent.x[side][v] = (Lanes)(0.0f);
    for (int z = 0; z < EDGE; ++z) sent.y[side][z] = (Row)(0.0f);
    for (int j = 0; j < PER_PLANE; ++j) sent.z[side][j] = (Lanes)(0.0f);
  }
#if TURBID_HALF
  Lanes taken[6 * VECTORS];
  float* slots = (float*)taken;
  take(slots, populations + index * 6 * VOXELS, rest + index * VOXELS, !local_first);
#else
  global float* slots = populations + index * 6 * VOXELS;
#endif
  global float* psi = fluence + index * VOXELS;
  const global float4* share = shares + (size_t)channel * first_face[blocks];
  const int begin = first_face[block_index], end = first_face[block_index + 1];
  Sums of_last;
  of_last.change = of_last.total = of_last.lost = of_last.after = of_last.after_low = (Lanes)(0.0f);
  if (local_first) add_arrivals(slots, &in);
  for (int i = 0; i < inner; ++i) {
    const int crossing = (i & 1) == local_first, last = i == inner - 1;
    exchange(slots, faces, share, begin, end, crossing);
    if (crossing) step(slots, &block, &in, &wall, &sent, last ? 0.0f : 1.0f, psi, &of_last, 1, last);
    else step(slots, &block, &in, &wall, &sent, 1.0f, psi, &of_last, 0, last);
  }
  send(&sent, interfaces_out + ((size_t)channel * (blocks + 1) + block_index) * 6 * ROWS, 1.0f / (float)inner);
  vstore4((float4)(sum16(of_last.change), sum16(of_last.total), sum16(of_last.lost), sum16(of_last.after)), 0, sums + 5 * index);
#if TURBID_HALF
  sums[5 * index + 4] = sum16(put_back(slots, populations + index * 6 * VOXELS, rest + index * VOXELS,
                                       (local_first ^ (inner & 1)) == 0));
#else
  sums[5 * index + 4] = 0.0f;
#endif
}

// What is under way after a sweep of one local step, per block: sums[channel][block][7] = all departures, and those that escape through boundary
// faces towards -x, +x, -y, +y, -z, +z. open_towards[face]: 0..5, or -1 for faces between two active voxels.
kernel void departures(const global int* wall_block, const global float* walls, const global int* first_face,
                       const global int* faces, const global int* open_towards, const global float4* shares,
                       const global float* interfaces, const global Stored* populations, const global Stored* rest,
                       global float* sums, int blocks, int wall_blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t index = (size_t)channel * blocks + block;
#if TURBID_HALF
  Lanes taken[6 * VECTORS];
  float* slots = (float*)taken;
  take(slots, populations + index * 6 * VOXELS, rest + index * VOXELS, 1);
#else
  const global float* slots = populations + index * 6 * VOXELS;
#endif
  Lanes total = (Lanes)(0.0f), low = total;
  for (int v = 0; v < VECTORS; ++v) {
    for (int i = 0; i < 6; ++i) add_exactly(&total, &low, stays(v, i) * SLOT_LANES(v, slots + i * VOXELS));
  }
  float escaped[6] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  // Over a face the voxel's own share comes from its slot, the neighbour's from the interface.
  const global float* own = wall_block[block] >= 0 ? walls + ((size_t)channel * wall_blocks + wall_block[block]) * 12 * ROWS : 0;
  const global float* sent = interfaces + ((size_t)channel * (blocks + 1) + block) * 6 * ROWS;
  float over_faces = 0.0f;
  for (int i = 0; i < 6 * ROWS; ++i) {
    const int face = i / ROWS, axis = face / 2, row = i % ROWS, layer = face & 1 ? EDGE - 1 : 0;
    const int a = row % EDGE, b = row / EDGE;
    const int place = axis == 0 ? layer + EDGE * row : axis == 1 ? a + EDGE * (layer + EDGE * b) : row + ROWS * layer;
    const float kept = own ? own[i] : 0.0f, leaves = slots[face * VOXELS + place];
    const int open = own && own[6 * ROWS + i] == 0.0f;
    over_faces += open ? leaves : kept * leaves + (1.0f - kept) * sent[(face ^ 1) * ROWS + row];
    if (open) escaped[face] += (1.0f - kept) * leaves;
  }
  for (int i = first_face[block]; i < first_face[block + 1]; ++i) {
    if (open_towards[i] < 0) continue;
    const int face = faces[i], axis = face >> 18, upper = open_towards[i] & 1;
    const float4 k = shares[(size_t)channel * first_face[blocks] + i];
    const float leaves = upper ? (1.0f - k.z) * slots[(2 * axis + 1) * VOXELS + (face & 511)]
                               : (1.0f - k.x) * slots[2 * axis * VOXELS + ((face >> 9) & 511)];
    escaped[open_towards[i]] += leaves;
  }
  sums[7 * index] = sum16(total) + over_faces;
  for (int face = 0; face < 6; ++face) sums[7 * index + 1 + face] = escaped[face];
}
