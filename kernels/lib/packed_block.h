// SPDX-License-Identifier: Apache-2.0
// The diffusion operator, its smoother and the transfer between levels on one block of 8^3 voxels in packed order.
//
// Vector v = 2 (4 z + k) + c holds the voxels of colour c = (x + y + z) mod 2 in rows y = 2k (lanes 0..3) and 2k + 1 (lanes 4..7),
// x = 2 j + parity in lane j. All neighbours of a vector then lie in vectors of the other colour: those over z in the same lanes,
// those over y in the other half, those over x in the same or the next lane. A red-black sweep works on full vectors.
#ifndef TURBID_LIB_PACKED_BLOCK_H
#define TURBID_LIB_PACKED_BLOCK_H

// Vector v of a field: blocks, and so vectors, are aligned. PoCL writes vstore8 in parts.
#define EIGHT(v, field) (((const global float8*)(field))[v])
#define PUT_EIGHT(v, field) (((global float8*)(field))[v])

typedef struct {
  const global float* t[3];  // conductances of this channel, all blocks
  const global float* loss;  // d
  const global int* neighbours;
  int block;
} Operator;

static Operator block_operator(const global float* conductance, const global float* loss, const global int* neighbours,
                               int blocks, int block, int channel) {
  Operator a;
  const size_t stride = (size_t)(blocks + 1) * TURBID_BLOCK_VOXELS;
  for (int axis = 0; axis < 3; ++axis) a.t[axis] = conductance + (3 * channel + axis) * stride;
  a.loss = loss + channel * stride;
  a.neighbours = neighbours + 6 * block;
  a.block = block;
  return a;
}

// A field's values in a block and its six neighbours.
typedef struct {
  const global float* here;
  const global float* next[6];
} Around;

static Around around(const global float* field, const global int* neighbours, int block) {
  Around f;
  f.here = field + (size_t)block * TURBID_BLOCK_VOXELS;
  for (int i = 0; i < 6; ++i) f.next[i] = field + (size_t)neighbours[i] * TURBID_BLOCK_VOXELS;
  return f;
}

// Values one voxel down or up along x of a vector whose lanes 0..3 have x = 2j (first_even) or 2j + 1; `other` is the vector of
// the other colour in the same rows, `halo` what lies beyond the block.
static float8 x_below(float8 other, float halo, int first_even) {
  return first_even ? (float8)(halo, other.s012, other.hi) : (float8)(other.lo, halo, other.s456);
}
static float8 x_above(float8 other, float halo, int first_even) {
  return first_even ? (float8)(other.lo, other.s567, halo) : (float8)(other.s123, halo, other.hi);
}
// Lanes that x_below and x_above take from the neighbouring block's vector of the other colour.
static int lane_below(int first_even) { return first_even ? 3 : 7; }
static int lane_above(int first_even) { return first_even ? 4 : 0; }

static float sum8(float8 v) {
  const float4 half_sum = v.lo + v.hi;
  return (half_sum.x + half_sum.y) + (half_sum.z + half_sum.w);
}

// Conductances of a vector's faces downwards, interfaces included; those upwards are its own t[axis].
typedef struct {
  float8 x, y, z;
} FacesBelow;

static FacesBelow faces_below(const Operator* a, int v) {
  const int k = (v >> 1) & 3, z = v >> 3, first_even = !((v ^ z) & 1), o = v ^ 1;
  const size_t own = (size_t)a->block * TURBID_BLOCK_VOXELS;
  FacesBelow f;
  f.x = x_below(EIGHT(o, a->t[0] + own),
                a->t[0][(size_t)a->neighbours[0] * TURBID_BLOCK_VOXELS + 8 * o + lane_below(first_even)], first_even);
  const global float* below = k > 0 ? a->t[1] + own + 8 * (o - 2)
                                    : a->t[1] + (size_t)a->neighbours[2] * TURBID_BLOCK_VOXELS + 8 * (o + 6);
  f.y = (float8)(vload4(1, below), vload4(0, a->t[1] + own + 8 * o));
  f.z = z > 0 ? EIGHT(o - 8, a->t[2] + own) : EIGHT(o + 56, a->t[2] + (size_t)a->neighbours[4] * TURBID_BLOCK_VOXELS);
  return f;
}

// sum over faces T (x_i - x_j) + d x_i for one vector.
static float8 apply_vector(const Operator* a, const Around* x, int v) {
  const int k = (v >> 1) & 3, z = v >> 3, first_even = !((v ^ z) & 1), o = v ^ 1;
  const size_t own = (size_t)a->block * TURBID_BLOCK_VOXELS;
  const FacesBelow f = faces_below(a, v);
  const float8 here = EIGHT(v, x->here), other = EIGHT(o, x->here);
  const float8 xm = x_below(other, x->next[0][8 * o + lane_below(first_even)], first_even);
  const float8 xp = x_above(other, x->next[1][8 * o + lane_above(first_even)], first_even);
  const float8 ym = (float8)(vload4(1, k > 0 ? x->here + 8 * (o - 2) : x->next[2] + 8 * (o + 6)), other.lo);
  const float8 yp = (float8)(other.hi, vload4(0, k < 3 ? x->here + 8 * (o + 2) : x->next[3] + 8 * (o - 6)));
  const float8 zm = EIGHT(0, z > 0 ? x->here + 8 * (o - 8) : x->next[4] + 8 * (o + 56));
  const float8 zp = EIGHT(0, z < 7 ? x->here + 8 * (o + 8) : x->next[5] + 8 * (o - 56));
  return f.x * (here - xm) + EIGHT(v, a->t[0] + own) * (here - xp) + f.y * (here - ym) +
         EIGHT(v, a->t[1] + own) * (here - yp) + f.z * (here - zm) + EIGHT(v, a->t[2] + own) * (here - zp) +
         EIGHT(v, a->loss + own) * here;
}

// What red-black sweeps inside one block need. Values and conductances beyond the block count as zero: `rhs` holds what the
// frozen interfaces add (the interface buffer of Bernabei et al. III-C).
typedef struct {
  float8 x[96];  // 8 vectors of zeros before and after the block's planes: x[v + 16]
  float8 below_x[64], below_y[64], below_z[64], rhs[64], inverse[64];
} Relaxed;

static void one_colour(const Operator* a, Relaxed* r, int colour) {
  const size_t own = (size_t)a->block * TURBID_BLOCK_VOXELS;
  const global float* t0 = a->t[0] + own;
  const global float* t1 = a->t[1] + own;
  const global float* t2 = a->t[2] + own;
  for (int z = 0; z < 8; ++z) {
    const int first_even = !((colour ^ z) & 1);
    for (int k = 0; k < 4; ++k) {
      const int v = 8 * z + 2 * k + colour, o = v ^ 1;
      const float8* x = r->x + 16 + o;
      const float8 other = *x;
      float8 sum = r->rhs[v];
      sum += r->below_x[v] * x_below(other, 0.0f, first_even);
      sum += EIGHT(v, t0) * x_above(other, 0.0f, first_even);
      sum += r->below_y[v] * (float8)(k > 0 ? x[-2].hi : (float4)(0.0f), other.lo);
      sum += EIGHT(v, t1) * (float8)(other.hi, k < 3 ? x[2].lo : (float4)(0.0f));
      sum += r->below_z[v] * x[-8];
      sum += EIGHT(v, t2) * x[8];
      r->x[16 + v] = sum * r->inverse[v];
    }
  }
}

// Red, black, red, black, ... or, after the coarse correction, black first: the V-cycle stays symmetric.
static void sweep_block(const Operator* a, Relaxed* r, int sweeps, int reverse) {
  for (int i = 0; i < 8; ++i) r->x[8 + i] = r->x[80 + i] = (float8)(0.0f);
  for (int half_sweep = 0; half_sweep < 2 * sweeps; ++half_sweep) one_colour(a, r, (half_sweep & 1) ^ reverse);
}

static void load_operator(const Operator* a, Relaxed* r) {
  const size_t own = (size_t)a->block * TURBID_BLOCK_VOXELS;
  for (int v = 0; v < 64; ++v) {
    const FacesBelow f = faces_below(a, v);
    const float8 diagonal = f.x + f.y + f.z + EIGHT(v, a->t[0] + own) + EIGHT(v, a->t[1] + own) + EIGHT(v, a->t[2] + own) +
                            EIGHT(v, a->loss + own);
    r->inverse[v] = diagonal > 0.0f ? 1.0f / diagonal : (float8)(0.0f);
    r->below_x[v] = f.x;
    r->below_y[v] = f.y;
    r->below_z[v] = f.z;
  }
}

static void smooth_from_zero(const Operator* a, const global float* b, global float* x, int sweeps) {
  Relaxed r;
  load_operator(a, &r);
  for (int v = 0; v < 64; ++v) {
    r.rhs[v] = EIGHT(v, b);
    r.x[16 + v] = (float8)(0.0f);
  }
  sweep_block(a, &r, sweeps, 0);
  for (int v = 0; v < 64; ++v) PUT_EIGHT(v, x) = r.x[16 + v];
}

// The coarse values of rows 2k and 2k + 1 of plane z: lane j is the parent of x = 2j and 2j + 1. `octant` of the coarse block.
static float4 coarse_row(const global float* coarse, int octant, int k, int z) {
  const int y = 4 * ((octant >> 1) & 1) + k, zz = 4 * (octant >> 2) + (z >> 1);
  const int row = 8 * (8 * zz + 2 * (y >> 1)) + 4 * (y & 1) + 2 * (octant & 1), even = (y + zz) & 1;
  const float2 a = vload2(0, coarse + row + 8 * even), b = vload2(0, coarse + row + 8 * (1 - even));
  return (float4)(a.x, b.x, a.y, b.y);
}

// y = x + coarse correction, smoothed with the neighbours' x + correction frozen. Returns b . y.
static float smooth_corrected(const Operator* a, const global float* b, const global float* x, const global float* coarse,
                              const global int* parent, const global int* octant, global float* y, int sweeps) {
  Relaxed r;
  load_operator(a, &r);
  const Around from = around(x, a->neighbours, a->block);
  const size_t own = (size_t)a->block * TURBID_BLOCK_VOXELS;
  const global float* above = coarse + (size_t)parent[a->block] * TURBID_BLOCK_VOXELS;
  const global float* above_next[6];
  int octant_next[6];
  for (int i = 0; i < 6; ++i) {
    above_next[i] = coarse + (size_t)parent[a->neighbours[i]] * TURBID_BLOCK_VOXELS;
    octant_next[i] = octant[a->neighbours[i]];
  }
  for (int row = 0; row < 32; ++row) {
    const int k = row & 3, z = row >> 2;
    const float4 c = coarse_row(above, octant[a->block], k, z);
    const float west = coarse_row(above_next[0], octant_next[0], k, z).w, east = coarse_row(above_next[1], octant_next[1], k, z).x;
    for (int colour = 0; colour < 2; ++colour) {
      const int v = 2 * row + colour, o = v ^ 1, first_even = !((v ^ z) & 1);
      r.x[16 + v] = EIGHT(v, from.here) + (float8)(c, c);
      float8 rhs = EIGHT(v, b);
      const float xm = from.next[0][8 * o + lane_below(first_even)] + west;
      const float xp = from.next[1][8 * o + lane_above(first_even)] + east;
      if (first_even) {
        rhs.s0 += r.below_x[v].s0 * xm;
        rhs.s7 += a->t[0][own + 8 * v + 7] * xp;
      } else {
        rhs.s4 += r.below_x[v].s4 * xm;
        rhs.s3 += a->t[0][own + 8 * v + 3] * xp;
      }
      if (k == 0) {
        rhs.lo += r.below_y[v].lo * (vload4(1, from.next[2] + 8 * (o + 6)) + coarse_row(above_next[2], octant_next[2], 3, z));
      }
      if (k == 3) {
        rhs.hi += vload4(1, a->t[1] + own + 8 * v) *
                  (vload4(0, from.next[3] + 8 * (o - 6)) + coarse_row(above_next[3], octant_next[3], 0, z));
      }
      if (z == 0) {
        const float4 d = coarse_row(above_next[4], octant_next[4], k, 7);
        rhs += r.below_z[v] * (EIGHT(o + 56, from.next[4]) + (float8)(d, d));
      }
      if (z == 7) {
        const float4 d = coarse_row(above_next[5], octant_next[5], k, 0);
        rhs += EIGHT(v, a->t[2] + own) * (EIGHT(o - 56, from.next[5]) + (float8)(d, d));
      }
      r.rhs[v] = rhs;
    }
  }
  sweep_block(a, &r, sweeps, 1);
  float8 sum = (float8)(0.0f);
  for (int v = 0; v < 64; ++v) {
    PUT_EIGHT(v, y) = r.x[16 + v];
    sum += r.x[16 + v] * EIGHT(v, b);
  }
  return sum8(sum);
}

// b - A x of one block, summed over 2^3 voxels, into its eighth of the coarse block.
static void restrict_block(const Operator* a, const global float* b, const global float* x, global float* coarse, int octant) {
  const Around from = around(x, a->neighbours, a->block);
  for (int z = 0; z < 8; z += 2) {
    for (int k = 0; k < 4; ++k) {
      float8 sum = (float8)(0.0f);
      for (int i = 0; i < 4; ++i) {
        const int v = 8 * (z + (i >> 1)) + 2 * k + (i & 1);
        sum += EIGHT(v, b) - apply_vector(a, &from, v);
      }
      const float4 value = sum.lo + sum.hi;
      const int y = 4 * ((octant >> 1) & 1) + k, zz = 4 * (octant >> 2) + (z >> 1);
      const int row = 8 * (8 * zz + 2 * (y >> 1)) + 4 * (y & 1) + 2 * (octant & 1), even = (y + zz) & 1;
      vstore2(value.even, 0, coarse + row + 8 * even);
      vstore2(value.odd, 0, coarse + row + 8 * (1 - even));
    }
  }
}

#endif
