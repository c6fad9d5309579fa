// SPDX-License-Identifier: Apache-2.0
// The lattice's steady state solved directly: conjugate gradients on the finite-volume diffusion that the two-relaxation-time
// lattice relaxes to, preconditioned by one multigrid V-cycle whose smoother is the block iteration with frozen interfaces.
//
//     (A x)_i = sum over faces T_ij (x_i - x_j) + d_i x_i        (design notes, numerics sections 1, 3 and 5)
//
// x = fluence / eta^2, T the conductance between voxels i and j, d absorption plus boundary losses. A x is evaluated by
// differences as written: the form diagonal * x - sum loses three digits of the energy balance in single precision.
//
// One work-item per block and channel; voxels of one colour are vectors of eight (TURBID_PACKED in lattice_params.h; PoCL does
// not vectorise inner loops across work-items). T[axis] belongs to the face between a voxel and its upper neighbour.
#include "shared/lattice_params.h"
#include "lib/packed_block.h"

// out = A x; sums[channel][block] = x . A x over the block.
kernel void apply(const global float* conductance, const global float* loss, const global int* neighbours,
                  const global float* x, global float* out, global float* sums, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  const Around from = around(x + offset, a.neighbours, block);
  global float* result = out + offset + (size_t)block * TURBID_BLOCK_VOXELS;
  float8 sum = (float8)(0.0f);
  for (int v = 0; v < 64; ++v) {
    const float8 value = apply_vector(&a, &from, v);
    PUT_EIGHT(v, result) = value;
    sum += value * EIGHT(v, from.here);
  }
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// r = b - A x, where b and r may be the same; sums[channel][block] = sum of r.
kernel void true_residual(const global float* conductance, const global float* loss, const global int* neighbours,
                          const global float* b, const global float* x, global float* r, global float* sums, int blocks,
                          int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  const Around from = around(x + offset, a.neighbours, block);
  const size_t own = offset + (size_t)block * TURBID_BLOCK_VOXELS;
  float8 sum = (float8)(0.0f);
  for (int v = 0; v < 64; ++v) {
    const float8 value = EIGHT(v, b + own) - apply_vector(&a, &from, v);
    PUT_EIGHT(v, r + own) = value;
    sum += value;
  }
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// First half of the V-cycle on one level: x = smoothed from zero.
kernel void smooth_down(const global float* conductance, const global float* loss, const global int* neighbours,
                        const global float* b, global float* x, int blocks, int channels, int sweeps) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  const size_t own = offset + (size_t)block * TURBID_BLOCK_VOXELS;
  smooth_from_zero(&a, b + own, x + own, sweeps);
}

// Second half: y = x plus the coarse correction, smoothed; sums[channel][block] = b . y.
kernel void smooth_up(const global float* conductance, const global float* loss, const global int* neighbours,
                      const global float* b, const global float* x, const global float* coarse, const global int* parent,
                      const global int* octant, global float* y, global float* sums, int blocks, int coarse_blocks,
                      int channels, int sweeps) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS;
  const Operator a = block_operator(conductance, loss, neighbours, blocks, block, channel);
  const size_t own = offset + (size_t)block * TURBID_BLOCK_VOXELS;
  const global float* above = coarse + (size_t)channel * (coarse_blocks + 1) * TURBID_BLOCK_VOXELS;
  sums[(size_t)channel * blocks + block] =
      smooth_corrected(&a, b + own, x + offset, above, parent, octant, y + own, sweeps);
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
  restrict_block(&a, b + offset + (size_t)block * TURBID_BLOCK_VOXELS, x + offset,
                 coarse_b + ((size_t)channel * (coarse_blocks + 1) + parent[block]) * TURBID_BLOCK_VOXELS, octant[block]);
}

// The V-cycle's lower end, levels of one block each, in one work-item per channel: launches would take longer than the work.
// Arrays are [level][channel][block and the block of zeros][voxel], octants [level][block and the block of zeros]; y of the first
// level is the result.
kernel void coarse_cycle(const global float* conductance, const global float* loss, const global int* nothing_around,
                         const global int* parent, const global int* octant, global float* b, global float* x,
                         global float* y, int levels, int channels, int sweeps) {
  const int channel = get_global_id(0);
  if (channel >= channels) return;
  const size_t block = 2 * TURBID_BLOCK_VOXELS, level_size = block * channels;
  for (int level = 0; level < levels; ++level) {
    const size_t at = level * level_size + channel * block;
    const Operator a = block_operator(conductance + 3 * level * level_size, loss + level * level_size, nothing_around, 1, 0,
                                      channel);
    const int last = level + 1 == levels;
    smooth_from_zero(&a, b + at, last ? y + at : x + at, sweeps);
    if (!last) restrict_block(&a, b + at, x + at, b + at + level_size, octant[2 * level]);
  }
  for (int level = levels - 2; level >= 0; --level) {
    const size_t at = level * level_size + channel * block;
    const Operator a = block_operator(conductance + 3 * level * level_size, loss + level * level_size, nothing_around, 1, 0,
                                      channel);
    smooth_corrected(&a, b + at, x + at, y + at + level_size, parent, octant + 2 * level, y + at,
                     sweeps);
  }
}

// x += alpha p, r -= alpha A p; sums[channel][block] = sum of r.
kernel void advance_solution(const global float* p, const global float* ap, global float* x, global float* r,
                             global float* sums, ChannelScalars alpha, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  const float step = alpha.value[channel];
  float8 sum = (float8)(0.0f);
  for (int v = 0; v < 64; ++v) {
    PUT_EIGHT(v, x + offset) = EIGHT(v, x + offset) + step * EIGHT(v, p + offset);
    const float8 residual = EIGHT(v, r + offset) - step * EIGHT(v, ap + offset);
    PUT_EIGHT(v, r + offset) = residual;
    sum += residual;
  }
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// sums[channel][block] = u . v over the block.
kernel void dot_product(const global float* u, const global float* v, global float* sums, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  float8 sum = (float8)(0.0f);
  for (int i = 0; i < 64; ++i) sum += EIGHT(i, u + offset) * EIGHT(i, v + offset);
  sums[(size_t)channel * blocks + block] = sum8(sum);
}

// p = z + beta p.
kernel void next_direction(const global float* z, global float* p, ChannelScalars beta, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  for (int v = 0; v < 64; ++v) {
    PUT_EIGHT(v, p + offset) = EIGHT(v, z + offset) + beta.value[channel] * EIGHT(v, p + offset);
  }
}

// x *= factor.
kernel void scale(global float* x, ChannelScalars factor, int blocks, int channels) {
  const int block = get_global_id(0), channel = get_global_id(1);
  if (block >= blocks || channel >= channels) return;
  const size_t offset = ((size_t)channel * (blocks + 1) + block) * TURBID_BLOCK_VOXELS;
  for (int v = 0; v < 64; ++v) PUT_EIGHT(v, x + offset) = factor.value[channel] * EIGHT(v, x + offset);
}
