// SPDX-License-Identifier: Apache-2.0
// The lattice's steady state solved directly: conjugate gradients on the finite-volume diffusion that the
// two-relaxation-time lattice relaxes to, preconditioned by one multigrid V-cycle whose smoother is the block iteration
// with frozen interfaces.
//
//     (A x)_i = sum over faces T_ij (x_i - x_j) + d_i x_i        (design notes, numerics sections 1, 3 and 5)
//
// x = fluence / eta^2, T the conductance between voxels i and j, d absorption plus boundary losses. A x is evaluated by
// differences as written: the form diagonal * x - sum loses three digits of the energy balance in single precision.
//
// One channel after another, as a channel's fields fit into caches that those of three don't; operators and solution
// hold all channels, the other fields one. One work-item per block; the voxels of one colour are vectors of sixteen
// (TURBID_PACKED in lattice_params.h; PoCL does not vectorise inner loops across work-items). An iteration reads and
// writes each field as seldom as the sums over all blocks allow: `next_step` before the sum p . A p, `descend` ...
// `ascend` after it.
#include "lib/block_smoother.h"

// This work-item's block, its place in a field of one channel, and the place of this channel's first block in those of
// all.
#define BLOCK_AND_PLACE                                   \
  if (get_global_id(0) >= blocks) return;                 \
  const int block = (int)get_global_id(0);                \
  const size_t own = (size_t)block * TURBID_BLOCK_VOXELS; \
  const size_t all = (size_t)channel * (blocks + 1) * TURBID_BLOCK_VOXELS

// Step sizes from what `settle` wrote: alpha = r.z / p.A p of a step, beta = r.z / that of the step before.
static float alpha_of(const global float* steps, int step) {
  const float rz = steps[TURBID_STEP * step], pap = steps[TURBID_STEP * step + 1];
  return pap > 0.0f ? rz / pap : 0.0f;
}
static float beta_of(const global float* steps, int step) {
  const float rz = steps[TURBID_STEP * step], before = steps[TURBID_STEP * (step - 1)];
  return before > 0.0f ? rz / before : 0.0f;
}

// Adds up `parts` sums over all blocks, `padded` (blocks, and zeros to a multiple of 16) apart, in one order always and
// with what rounding takes off each sum carried over to the next (Kahan).
kernel void settle(const global float* sums, global float* steps, int at, int parts, int padded) {
  if (get_global_id(0) > 0) return;
  for (int part = 0; part < parts; ++part) {
    float16 sum = (float16)(0.0f), over = (float16)(0.0f);
    for (int i = 0; i < padded / 16; ++i) {
      const float16 more = VECTOR(part * (padded / 16) + i, sums) - over, next = sum + more;
      over = (next - sum) - more;
      sum = next;
    }
    steps[at + part] = sum16(sum);
  }
}

// values[block][voxel], x fastest, into packed order.
kernel void pack(const global float* values, global float* field, int blocks) {
  const int channel = 0;
  BLOCK_AND_PLACE;
  FOR_PAIRS FOR_HALVES {
    const int row = 4 * (2 * zz + dz) + 2 * k;
    const float16 first = VECTOR(row, values + own), second = VECTOR(row + 1, values + own);
    UNROLL for (int c = 0; c < 2; ++c) PUT_VECTOR(PLACE(2 * zz + dz, k, c), field + all + own) =
        packed(first, second, (c ^ dz) & 1);
  }
}

// The other way, of one channel, times total / lost[channel] unless `total` is 0.
kernel void unpack(const global float* field, global float* values, const global float* lost, float total, int channel,
                   int blocks) {
  BLOCK_AND_PLACE;
  const float factor = total > 0.0f && lost[channel] > 0.0f ? total / lost[channel] : 1.0f;
  float16 x[VECTORS];
  for (int v = 0; v < VECTORS; ++v) x[v] = VECTOR(v, field + all + own);
  put_natural(x, factor, values + own);
}

// next_p = z + beta p and s = A next_p, while what the last step found is added: x += alpha p (x = alpha p where
// `fresh`). The first step of a round has none before it. sums[0][block] = next_p . s, sums[1] = sum of s.
kernel void next_step(const global float* conductance, const global float* loss, const global int* neighbours,
                      const global float* z, const global float* p, global float* next_p, global float* s,
                      global float* x, global float* sums, const global float* steps, int step, int first, int fresh,
                      int padded, int channel, int blocks) {
  BLOCK_AND_PLACE;
  const float alpha = step > first ? alpha_of(steps, step - 1) : 0.0f,
              beta = step > first ? beta_of(steps, step) : 0.0f;
  const Operator a = block_operator(conductance, neighbours, blocks, block, channel);
  const Sum field = {z, p, beta};
  float16 here[WITH_MARGINS];
  for (int v = 0; v < VECTORS; ++v) {
    here[MARGIN + v] = VECTOR(v, z + own) + beta * VECTOR(v, p + own);
    PUT_VECTOR(v, next_p + own) = here[MARGIN + v];
  }
  load_margins(here, field, &a);
  if (step > first) {
    for (int v = 0; v < VECTORS; ++v) {
      const float16 gain = alpha * VECTOR(v, p + own);
      PUT_VECTOR(v, x + all + own) = fresh ? gain : VECTOR(v, x + all + own) + gain;
    }
  }
  const Sum beyond[4] = {neighbour(field, &a, 0), neighbour(field, &a, 1), neighbour(field, &a, 2),
                         neighbour(field, &a, 3)};
  float16 product = (float16)(0.0f), sum = (float16)(0.0f);
  FOR_PAIRS FOR_HALVES UNROLL for (int c = 0; c < 2; ++c) {
    const int v = PLACE(2 * zz + dz, k, c);
    const float16 found = apply_vector(&a, loss + all + own, here, beyond, zz, dz, k, c);
    PUT_VECTOR(v, s + own) = found;
    product += found * here[MARGIN + v];
    sum += found;
  }
  sums[block] = sum16(product);
  sums[padded + block] = sum16(sum);
}

// The last step: x += alpha p (x = alpha p where `fresh`); sums[block] = sum of d x, which is that of A x: what is
// exchanged between voxels cancels.
kernel void last_step(const global float* loss, const global float* p, global float* x, global float* sums, float alpha,
                      int fresh, int channel, int blocks) {
  BLOCK_AND_PLACE;
  float16 sum = (float16)(0.0f);
  for (int v = 0; v < VECTORS; ++v) {
    const float16 gain = alpha * VECTOR(v, p + own), found = fresh ? gain : VECTOR(v, x + all + own) + gain;
    PUT_VECTOR(v, x + all + own) = found;
    sum += VECTOR(v, loss + all + own) * found;
  }
  sums[block] = sum16(sum);
}

// r = b - A x, where b and r may be the same; sums[block] = sum of r.
kernel void true_residual(const global float* conductance, const global float* loss, const global int* neighbours,
                          const global float* b, const global float* x, global float* r, global float* sums,
                          int channel, int blocks) {
  BLOCK_AND_PLACE;
  const Operator a = block_operator(conductance, neighbours, blocks, block, channel);
  const Sum field = {x + all, x + all, 0.0f};
  float16 here[WITH_MARGINS];
  for (int v = 0; v < VECTORS; ++v) here[MARGIN + v] = VECTOR(v, x + all + own);
  load_margins(here, field, &a);
  const Sum beyond[4] = {neighbour(field, &a, 0), neighbour(field, &a, 1), neighbour(field, &a, 2),
                         neighbour(field, &a, 3)};
  float16 sum = (float16)(0.0f);
  FOR_PAIRS FOR_HALVES UNROLL for (int c = 0; c < 2; ++c) {
    const int v = PLACE(2 * zz + dz, k, c);
    const float16 found = VECTOR(v, b + own) - apply_vector(&a, loss + all + own, here, beyond, zz, dz, k, c);
    PUT_VECTOR(v, r + own) = found;
    sum += found;
  }
  sums[block] = sum16(sum);
}

// First half of the V-cycle on the finest level: r -= alpha s of the step before, if there is one; x = smoothed from
// zero. s and x may be the same.
kernel void descend(const global uint* rounded, const global int* neighbours, const global float* s, global float* r,
                    global float* x, global float* handed, const global float* steps, int step, int first, int sweeps,
                    int channel, int blocks) {
  BLOCK_AND_PLACE;
  const Rounded a = rounded_operator(rounded, neighbours, blocks, block, channel);
  if (step > first) {
    const float alpha = alpha_of(steps, step - 1);
    for (int v = 0; v < VECTORS; ++v) PUT_VECTOR(v, r + own) = VECTOR(v, r + own) - alpha * VECTOR(v, s + own);
  }
  float16 smooth[WITH_MARGINS], left[VECTORS / 2];
  smooth_from_zero(&a, r + own, smooth, left, sweeps);
  for (int v = 0; v < VECTORS; ++v) PUT_VECTOR(v, x + own) = smooth[MARGIN + v];
  hand_over(&a, smooth, left, handed + (size_t)block * TURBID_HANDED);
}

// The same on a coarser level, whose b is what the finer one handed over.
kernel void descend_coarse(const global uint* rounded, const global int* neighbours, const global int* children,
                           const global int* fine_neighbours, const global float* fine_handed, global float* b,
                           global float* x, global float* handed, int finer, int sweeps, int channel, int blocks) {
  BLOCK_AND_PLACE;
  const Rounded a = rounded_operator(rounded, neighbours, blocks, block, channel);
  take_over(children + 8 * block, fine_neighbours, fine_handed, finer, b + own);
  float16 smooth[WITH_MARGINS], left[VECTORS / 2];
  smooth_from_zero(&a, b + own, smooth, left, sweeps);
  for (int v = 0; v < VECTORS; ++v) PUT_VECTOR(v, x + own) = smooth[MARGIN + v];
  hand_over(&a, smooth, left, handed + (size_t)block * TURBID_HANDED);
}

// Second half: y = x plus the coarse correction, smoothed; sums[block] = b . y.
kernel void ascend(const global uint* rounded, const global int* neighbours, const global float* b,
                   const global float* x, const global float* coarse, const global int* parent,
                   const global int* octant, global float* y, global float* sums, int sweeps, int channel, int blocks) {
  BLOCK_AND_PLACE;
  const Rounded a = rounded_operator(rounded, neighbours, blocks, block, channel);
  float16 smooth[WITH_MARGINS];
  smooth_corrected(&a, b + own, x, coarse, parent, octant, block, smooth, sweeps);
  float16 sum = (float16)(0.0f);
  for (int v = 0; v < VECTORS; ++v) {
    PUT_VECTOR(v, y + own) = smooth[MARGIN + v];
    sum += smooth[MARGIN + v] * VECTOR(v, b + own);
  }
  sums[block] = sum16(sum);
}

// The same on a coarser level, whose y is left in natural order for the finer one.
kernel void ascend_coarse(const global uint* rounded, const global int* neighbours, const global float* b,
                          const global float* x, const global float* coarse, const global int* parent,
                          const global int* octant, global float* y, int sweeps, int channel, int blocks) {
  BLOCK_AND_PLACE;
  const Rounded a = rounded_operator(rounded, neighbours, blocks, block, channel);
  float16 smooth[WITH_MARGINS];
  smooth_corrected(&a, b + own, x, coarse, parent, octant, block, smooth, sweeps);
  put_natural(smooth + MARGIN, 1.0f, y + own);
}

// The V-cycle's lower end, levels of one block each, in one work-item: launches would take longer than the work.
// Operators are [level][channel][block and the block of zeros][voxel], fields [level][block, zeros][voxel], octants and
// `handed` [level][block, zeros]; y of the first level, in natural order, is the result.
kernel void coarse_cycle(const global uint* rounded, const global int* nothing_around, const global int* children,
                         const global int* fine_neighbours, const global float* fine_handed,
                         const global int* only_child, const global int* parent, const global int* octant,
                         global float* b, global float* x, global float* y, global float* handed, int levels, int finer,
                         int sweeps, int channel, int channels) {
  if (get_global_id(0) > 0) return;
  const size_t field = 2 * TURBID_BLOCK_VOXELS, all = 8 * PAIRS * channels;
  take_over(children, fine_neighbours, fine_handed, finer, b);
  for (int level = 0; level < levels; ++level) {
    const size_t at = level * field;
    const Rounded a = rounded_operator(rounded + level * all, nothing_around, 1, 0, channel);
    float16 smooth[WITH_MARGINS], left[VECTORS / 2];
    smooth_from_zero(&a, b + at, smooth, left, sweeps);
    if (level + 1 == levels) {
      put_natural(smooth + MARGIN, 1.0f, y + at);
      break;
    }
    for (int v = 0; v < VECTORS; ++v) PUT_VECTOR(v, x + at) = smooth[MARGIN + v];
    hand_over(&a, smooth, left, handed + 2 * level * TURBID_HANDED);
    take_over(only_child, nothing_around, handed + 2 * level * TURBID_HANDED, 1, b + at + field);
  }
  for (int level = levels - 2; level >= 0; --level) {
    const size_t at = level * field;
    const Rounded a = rounded_operator(rounded + level * all, nothing_around, 1, 0, channel);
    float16 smooth[WITH_MARGINS];
    smooth_corrected(&a, b + at, x + at, y + at + field, parent, octant + 2 * level, 0, smooth, sweeps);
    put_natural(smooth + MARGIN, 1.0f, y + at);
  }
}

// sums[block] = u . w over the block; u holds all channels.
kernel void dot_product(const global float* u, const global float* w, global float* sums, int channel, int blocks) {
  BLOCK_AND_PLACE;
  float16 sum = (float16)(0.0f);
  for (int v = 0; v < VECTORS; ++v) sum += VECTOR(v, u + all + own) * VECTOR(v, w + own);
  sums[block] = sum16(sum);
}

// x *= factor; x holds all channels.
kernel void scale(global float* x, float factor, int channel, int blocks) {
  BLOCK_AND_PLACE;
  for (int v = 0; v < VECTORS; ++v) PUT_VECTOR(v, x + all + own) = factor * VECTOR(v, x + all + own);
}
