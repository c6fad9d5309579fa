// SPDX-License-Identifier: Apache-2.0
// One block of the lattice (lattice.cl, whose TURBID_EDGE and TURBID_HALF it uses): its slots, its faces, one step in place.
#ifndef TURBID_LIB_BLOCK_STEPS_H
#define TURBID_LIB_BLOCK_STEPS_H

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

#endif
