// SPDX-License-Identifier: Apache-2.0
// The lattice's steady state solved directly: conjugate gradients on the finite-volume diffusion that the two-relaxation-time
// lattice relaxes to, preconditioned by one multigrid V-cycle whose smoother is the block iteration with frozen interfaces.
//
//     (A x)_i = sum over faces T_ij (x_i - x_j) + d_i x_i        (design notes, numerics sections 1, 3 and 5)
//
// x = fluence / eta^2, T the conductance between voxels i and j, d absorption plus boundary losses. A x is evaluated by
// differences as written: the form diagonal * x - sum loses three digits of the energy balance in single precision.
//
// One work-item per block and channel; rows of eight voxels along x are float8 (PoCL does not vectorise inner loops across
// work-items). T[axis] belongs to the face between a voxel and its upper neighbour along that axis.
#include "shared/lattice_params.h"

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

static float8 row_of(const global float* field, int block, int row) {
  return vload8(0, field + (size_t)block * TURBID_BLOCK_VOXELS + 8 * row);
}
static float lane_of(const global float* field, int block, int voxel) {
  return field[(size_t)block * TURBID_BLOCK_VOXELS + voxel];
}
static float8 shift_up(float8 v, float first) { return (float8)(first, v.s0123, v.s456); }
static float8 shift_down(float8 v, float last) { return (float8)(v.s1234, v.s567, last); }

// Conductances of a row's six faces.
typedef struct {
  float8 xm, xp, ym, yp, zm, zp;
} Faces;

static Faces row_faces(const Operator* a, int y, int z) {
  const int row = y + 8 * z;
  Faces f;
  f.xp = row_of(a->t[0], a->block, row);
  f.xm = shift_up(f.xp, lane_of(a->t[0], a->neighbours[0], 8 * row + 7));
  f.yp = row_of(a->t[1], a->block, row);
  f.ym = y > 0 ? row_of(a->t[1], a->block, row - 1) : row_of(a->t[1], a->neighbours[2], 7 + 8 * z);
  f.zp = row_of(a->t[2], a->block, row);
  f.zm = z > 0 ? row_of(a->t[2], a->block, row - 8) : row_of(a->t[2], a->neighbours[4], y + 56);
  return f;
}

// sum over faces T (x_i - x_j) + d x_i for one row; x is read from global memory, interfaces included.
static float8 apply_row(const Operator* a, const global float* x, int y, int z) {
  const int row = y + 8 * z;
  const Faces f = row_faces(a, y, z);
  const float8 here = row_of(x, a->block, row);
  const float8 xm = shift_up(here, lane_of(x, a->neighbours[0], 8 * row + 7));
  const float8 xp = shift_down(here, lane_of(x, a->neighbours[1], 8 * row));
  const float8 ym = y > 0 ? row_of(x, a->block, row - 1) : row_of(x, a->neighbours[2], 7 + 8 * z);
  const float8 yp = y < 7 ? row_of(x, a->block, row + 1) : row_of(x, a->neighbours[3], 8 * z);
  const float8 zm = z > 0 ? row_of(x, a->block, row - 8) : row_of(x, a->neighbours[4], y + 56);
  const float8 zp = z < 7 ? row_of(x, a->block, row + 8) : row_of(x, a->neighbours[5], y);
  return f.xm * (here - xm) + f.xp * (here - xp) + f.ym * (here - ym) + f.yp * (here - yp) + f.zm * (here - zm) +
         f.zp * (here - zp) + row_of(a->loss, a->block, row) * here;
}

static float sum8(float8 v) {
  const float4 half_sum = v.lo + v.hi;
  return (half_sum.x + half_sum.y) + (half_sum.z + half_sum.w);
}

// Red-black Gauss-Seidel inside each block; voxels of other blocks keep the value they had in x_in (the interface buffer of
// Bernabei et al. III-C). The reverse order of colours after the coarse correction keeps the V-cycle symmetric.
// from_zero = 1: x_in counts as zero.
kernel void smooth(const global float* conductance, const global float* loss, const global int* neighbours,
                   const global float* b, const global float* x_in, global float* x_out, int blocks, int channels,
                   int sweeps, int reverse, int from_zero) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  const global float* old = x_in + offset;
  float8 x[64];
  float8 halo[64];  // right-hand side plus what the frozen interfaces add
  float8 inverse[64];
  for (int row = 0; row < 64; ++row) {
    const int y = row & 7, z = row >> 3;
    const Faces f = row_faces(&a, y, z);
    const float8 diagonal = f.xm + f.xp + f.ym + f.yp + f.zm + f.zp + row_of(a.loss, block, row);
    inverse[row] = diagonal > 0.0f ? 1.0f / diagonal : (float8)(0.0f);
    float8 rhs = row_of(b + offset, block, row);
    if (from_zero) {
      x[row] = (float8)(0.0f);
    } else {
      x[row] = row_of(old, block, row);
      rhs.s0 += f.xm.s0 * lane_of(old, a.neighbours[0], 8 * row + 7);
      rhs.s7 += f.xp.s7 * lane_of(old, a.neighbours[1], 8 * row);
      if (y == 0) rhs += f.ym * row_of(old, a.neighbours[2], 7 + 8 * z);
      if (y == 7) rhs += f.yp * row_of(old, a.neighbours[3], 8 * z);
      if (z == 0) rhs += f.zm * row_of(old, a.neighbours[4], y + 56);
      if (z == 7) rhs += f.zp * row_of(old, a.neighbours[5], y);
    }
    halo[row] = rhs;
  }
  const int8 even = (int8)(-1, 0, -1, 0, -1, 0, -1, 0);
  for (int half_sweep = 0; half_sweep < 2 * sweeps; ++half_sweep) {
    const int colour = (half_sweep & 1) ^ reverse;
    for (int row = 0; row < 64; ++row) {
      const int y = row & 7, z = row >> 3;
      const float8 txp = row_of(a.t[0], block, row);
      float8 sum = halo[row];
      sum += shift_up(txp, 0.0f) * shift_up(x[row], 0.0f);
      sum += txp * shift_down(x[row], 0.0f);
      if (y > 0) sum += row_of(a.t[1], block, row - 1) * x[row - 1];
      if (y < 7) sum += row_of(a.t[1], block, row) * x[row + 1];
      if (z > 0) sum += row_of(a.t[2], block, row - 8) * x[row - 8];
      if (z < 7) sum += row_of(a.t[2], block, row) * x[row + 8];
      const int8 chosen = ((y + z + colour) & 1) ? ~even : even;
      x[row] = select(x[row], sum * inverse[row], chosen);
    }
  }
  global float* out = x_out + offset + (size_t)block * TURBID_BLOCK_VOXELS;
  for (int row = 0; row < 64; ++row) vstore8(x[row], row, out);
}

// Coarse right-hand side: b - A x, summed over the eight children of each coarse voxel (piecewise constant transfer).
// parent[block] is the coarse block, octant[block] which eighth of it this block fills.
kernel void restrict_residual(const global float* conductance, const global float* loss, const global int* neighbours,
                              const global float* b, const global float* x, const global int* parent,
                              const global int* octant, global float* coarse_b, int blocks, int coarse_blocks,
                              int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  global float* out = coarse_b + ((size_t)channel * (coarse_blocks + 1) + parent[block]) * TURBID_BLOCK_VOXELS;
  const int o = octant[block];
  const int corner = 4 * (o & 1) + 8 * 4 * ((o >> 1) & 1) + 64 * 4 * (o >> 2);
  for (int z = 0; z < 8; z += 2) {
    for (int y = 0; y < 8; y += 2) {
      float8 sum = (float8)(0.0f);
      for (int child = 0; child < 4; ++child) {
        const int yy = y + (child & 1), zz = z + (child >> 1);
        sum += row_of(b + offset, block, yy + 8 * zz) - apply_row(&a, x + offset, yy, zz);
      }
      vstore4(sum.even + sum.odd, 0, out + corner + 8 * (y / 2) + 64 * (z / 2));
    }
  }
}

// x += the coarse correction of each voxel's parent.
kernel void prolong(const global float* coarse_x, const global int* parent, const global int* octant, global float* x,
                    int blocks, int coarse_blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const global float* coarse =
      coarse_x + ((size_t)channel * (coarse_blocks + 1) + parent[block]) * TURBID_BLOCK_VOXELS;
  global float* fine = x + ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  const int o = octant[block];
  const int corner = 4 * (o & 1) + 8 * 4 * ((o >> 1) & 1) + 64 * 4 * (o >> 2);
  for (int row = 0; row < 64; ++row) {
    const int y = row & 7, z = row >> 3;
    const float4 c = vload4(0, coarse + corner + 8 * (y / 2) + 64 * (z / 2));
    vstore8(vload8(row, fine) + c.xxyyzzww, row, fine);
  }
}

// out = A x; sums[channel][block] = x . A x over the block.
kernel void apply(const global float* conductance, const global float* loss, const global int* neighbours,
                  const global float* x, global float* out, global float* sums, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  global float* result = out + offset + (size_t)block * TURBID_BLOCK_VOXELS;
  float8 sum = (float8)(0.0f);
  for (int row = 0; row < 64; ++row) {
    const float8 value = apply_row(&a, x + offset, row & 7, row >> 3);
    vstore8(value, row, result);
    sum += value * row_of(x + offset, block, row);
  }
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// x += alpha p, r -= alpha A p; sums[channel][block] = sum of r.
kernel void advance_solution(const global float* p, const global float* ap, global float* x, global float* r,
                             global float* sums, ChannelScalars alpha, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  const float step = alpha.value[channel];
  float8 sum = (float8)(0.0f);
  for (int row = 0; row < 64; ++row) {
    vstore8(vload8(row, x + offset) + step * vload8(row, p + offset), row, x + offset);
    const float8 residual = vload8(row, r + offset) - step * vload8(row, ap + offset);
    vstore8(residual, row, r + offset);
    sum += residual;
  }
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// r = b - A x; sums[channel][block] = sum of r. Starts the iteration, and replaces the recursive residual by the true one.
kernel void true_residual(const global float* conductance, const global float* loss, const global int* neighbours,
                          const global float* b, const global float* x, global float* r, global float* sums, int blocks,
                          int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  global float* result = r + offset + (size_t)block * TURBID_BLOCK_VOXELS;
  float8 sum = (float8)(0.0f);
  for (int row = 0; row < 64; ++row) {
    const float8 value = row_of(b + offset, block, row) - apply_row(&a, x + offset, row & 7, row >> 3);
    vstore8(value, row, result);
    sum += value;
  }
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// sums[channel][block] = u . v over the block.
kernel void dot_product(const global float* u, const global float* v, global float* sums, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  float8 sum = (float8)(0.0f);
  for (int row = 0; row < 64; ++row) sum += vload8(row, u + offset) * vload8(row, v + offset);
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// p = z + beta p.
kernel void next_direction(const global float* z, global float* p, ChannelScalars beta, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  for (int row = 0; row < 64; ++row) {
    vstore8(vload8(row, z + offset) + beta.value[channel] * vload8(row, p + offset), row, p + offset);
  }
}
