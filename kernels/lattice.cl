// SPDX-License-Identifier: Apache-2.0
// Blockwise lattice-Boltzmann diffusion (Bernabei et al. III-C, Eq. 4-5, corrected and with other collisions): blocks of
// edge^3 voxels iterate alone while what their neighbours last sent waits in interface buffers.
//
// Populations f_i travel along i = +x, -x, +y, -y, +z, -z. With phi = sum f, S_k = f_k+ + f_k-, A_k = f_k+ - f_k-:
//     phi' = (1 - p0) phi + q0;   S_k' = phi'/3 + (1 - p2) (S_k - phi/3);   A_k' = (1 - p1) A_k
// (numerics section 1: absorption is a sink and the source is separate, unlike in the printed matrix, whose columns sum to 1.)
// What is stored is the state after collision; a step pulls it from the neighbours and collides.
//
// One work-item per block and channel; rows of `edge` voxels along x are vectors.
#include "shared/lattice_params.h"

#if !defined(TURBID_EDGE) || !defined(TURBID_COLLISION)
#error "TURBID_EDGE (4 or 8) and TURBID_COLLISION (0 paper, 1 exponential, 2 trapezoid, 3 trt) must be defined"
#endif

#define EDGE TURBID_EDGE
#define ROWS (EDGE * EDGE)
#define VOXELS (EDGE * EDGE * EDGE)
#if EDGE == 8
typedef float8 Row;
#define LOAD_ROW(row, at) vload8(row, at)
#define STORE_ROW(value, row, at) vstore8(value, row, at)
static Row shift_up(Row v, float first) { return (Row)(first, v.s0123, v.s456); }
static Row shift_down(Row v, float last) { return (Row)(v.s1234, v.s567, last); }
static float row_sum(Row v) { return ((v.s0 + v.s4) + (v.s1 + v.s5)) + ((v.s2 + v.s6) + (v.s3 + v.s7)); }
#else
typedef float4 Row;
#define LOAD_ROW(row, at) vload4(row, at)
#define STORE_ROW(value, row, at) vstore4(value, row, at)
static Row shift_up(Row v, float first) { return (Row)(first, v.s012); }
static Row shift_down(Row v, float last) { return (Row)(v.s123, last); }
static float row_sum(Row v) { return (v.s0 + v.s2) + (v.s1 + v.s3); }
#endif

typedef struct {
  Row f[6];
} Populations;

// A block's constant data for one channel.
typedef struct {
  const global float* collision;  // [p0 | p1 | p2 | weight][voxel]
  const global float* source;     // q0 [voxel]
  const global float* links;      // [own 0..5 | other 0..5][voxel], or 0 where every face is open to an equal neighbour
  const global float* incoming[6];  // interface buffers of the neighbours, [ROWS] each
} Block;

static Block block_data(const global float* collision, const global float* source, const global int* link_block,
                        const global float* links, const global float* interfaces, const global int* neighbours,
                        int blocks, int link_blocks, int block, int channel) {
  Block data;
  const size_t index = (size_t)channel * blocks + block;
  data.collision = collision + index * 4 * VOXELS;
  data.source = source + index * VOXELS;
  const int link = link_block[block];
  data.links = link >= 0 ? links + ((size_t)channel * link_blocks + link) * 12 * VOXELS : 0;
  for (int i = 0; i < 6; ++i) {
    // Directions are numbered +x, -x, ... and faces -x, +x, ...: population +x (0) arrives over the face -x (0).
    const int from = neighbours[6 * block + i];
    data.incoming[i] = interfaces + (((size_t)channel * (blocks + 1) + from) * 6 + i) * ROWS;
  }
  return data;
}

// Arrivals of one row before collision.
static Populations pull(const Block* block, const Row (*state)[ROWS], int y, int z) {
  const int row = y + EDGE * z;
  Populations in;
  in.f[0] = shift_up(state[0][row], block->incoming[0][row]);
  in.f[1] = shift_down(state[1][row], block->incoming[1][row]);
  in.f[2] = y > 0 ? state[2][row - 1] : LOAD_ROW(z, block->incoming[2]);
  in.f[3] = y < EDGE - 1 ? state[3][row + 1] : LOAD_ROW(z, block->incoming[3]);
  in.f[4] = z > 0 ? state[4][row - EDGE] : LOAD_ROW(y, block->incoming[4]);
  in.f[5] = z < EDGE - 1 ? state[5][row + EDGE] : LOAD_ROW(y, block->incoming[5]);
  if (block->links) {
    // Boundary: f_in = R f_out (numerics section 3). Index jump: part of each side is reflected.
    for (int i = 0; i < 6; ++i) {
      in.f[i] = LOAD_ROW(row, block->links + i * VOXELS) * state[i ^ 1][row] +
                LOAD_ROW(row, block->links + (6 + i) * VOXELS) * in.f[i];
    }
  }
  return in;
}

static Populations collide(const Block* block, Populations in, int row, Row* phi_before, Row* phi_after) {
  const Row p0 = LOAD_ROW(row, block->collision);
  const Row p1 = LOAD_ROW(row, block->collision + VOXELS);
  const Row p2 = LOAD_ROW(row, block->collision + 2 * VOXELS);
  const Row q0 = LOAD_ROW(row, block->source);
  const Row phi = ((in.f[0] + in.f[1]) + (in.f[2] + in.f[3])) + (in.f[4] + in.f[5]);
  const Row phi_new = (1.0f - p0) * phi + q0;
  Populations out;
  for (int axis = 0; axis < 3; ++axis) {
    const Row even = phi_new * (1.0f / 3.0f) + (1.0f - p2) * (in.f[2 * axis] + in.f[2 * axis + 1] - phi * (1.0f / 3.0f));
    const Row odd = (1.0f - p1) * (in.f[2 * axis] - in.f[2 * axis + 1]);
    out.f[2 * axis] = 0.5f * (even + odd);
    out.f[2 * axis + 1] = 0.5f * (even - odd);
  }
  *phi_before = phi;
  *phi_after = phi_new;
  return out;
}

// Fluence of a row (numerics section 1, last paragraph of the table).
static Row fluence_of(const Block* block, int row, Row phi_before, Row phi_after) {
  const Row weight = LOAD_ROW(row, block->collision + 3 * VOXELS);
#if TURBID_COLLISION <= 1
  return weight * phi_before;
#elif TURBID_COLLISION == 2
  return weight * 0.5f * (phi_before + phi_after);
#else
  // psi = m - (s_a' m - q*) s / 4, m the mean of before and after; weight = 1 - s_a' s / 4.
  const Row p0 = LOAD_ROW(row, block->collision), p1 = LOAD_ROW(row, block->collision + VOXELS);
  const Row s = p1 / (1.0f - 0.5f * p1), absorbed = p0 / (1.0f - 0.5f * p0);
  const Row q_star = LOAD_ROW(row, block->source) * (1.0f + 0.5f * absorbed);
  return weight * 0.5f * (phi_before + phi_after) + 0.25f * q_star * s;
#endif
}

// What a block sends its neighbours: the mean over the inner steps of what left through each face. With the last step's instead
// (as in the paper) the exchange can amplify: two-relaxation-time modes of thin voxels alternate in sign from step to step and a
// frozen interface resonates with them. The mean can't: a step conserves or loses energy, sum_t |out_t|^2 + |x_m|^2 <= m |in|^2 +
// |x_0|^2, and |mean out|^2 <= sum_t |out_t|^2 / m, so |x|^2 + m |interfaces|^2 never grows. The steady state is the same.
typedef struct {
  float x[2][ROWS];
  Row y[2][EDGE], z[2][EDGE];
} Sent;

static void add_outgoing(Sent* sent, const Row (*state)[ROWS]) {
  for (int row = 0; row < ROWS; ++row) {
#if EDGE == 8
    sent->x[0][row] += state[0][row].s7;
#else
    sent->x[0][row] += state[0][row].s3;
#endif
    sent->x[1][row] += state[1][row].s0;
  }
  for (int k = 0; k < EDGE; ++k) {
    sent->y[0][k] += state[2][EDGE - 1 + EDGE * k];
    sent->y[1][k] += state[3][EDGE * k];
    sent->z[0][k] += state[4][k + EDGE * (EDGE - 1)];
    sent->z[1][k] += state[5][k];
  }
}

// `inner` steps in every block. sums[channel][block][2]: summed |change| of the fluence since the last sweep, and its sum.
kernel void sweep(const global float* collision, const global float* source, const global int* link_block,
                  const global float* links, const global int* neighbours, const global float* interfaces_in,
                  global float* interfaces_out, global float* populations, global float* fluence, global float* sums,
                  int blocks, int link_blocks, int channels, int inner) {
  const int block_index = get_global_id(0), channel = get_global_id(1);
  if (block_index >= blocks || channel >= channels) return;
  const Block block = block_data(collision, source, link_block, links, interfaces_in, neighbours, blocks, link_blocks,
                                 block_index, channel);
  const size_t index = (size_t)channel * blocks + block_index;
  global float* stored = populations + index * 6 * VOXELS;
  global float* psi = fluence + index * VOXELS;
  Row even_steps[6][ROWS], odd_steps[6][ROWS];
  for (int i = 0; i < 6; ++i) {
    for (int row = 0; row < ROWS; ++row) even_steps[i][row] = LOAD_ROW(row, stored + i * VOXELS);
  }
  Sent sent;
  for (int row = 0; row < ROWS; ++row) sent.x[0][row] = sent.x[1][row] = 0.0f;
  for (int k = 0; k < EDGE; ++k) sent.y[0][k] = sent.y[1][k] = sent.z[0][k] = sent.z[1][k] = (Row)(0.0f);
  float change = 0.0f, total = 0.0f;
  for (int step = 0; step < inner; ++step) {
    Row(*from)[ROWS] = (step & 1) ? odd_steps : even_steps;
    Row(*to)[ROWS] = (step & 1) ? even_steps : odd_steps;
    const bool last = step == inner - 1;
    for (int row = 0; row < ROWS; ++row) {
      Row before, after;
      const Populations out = collide(&block, pull(&block, (const Row(*)[ROWS])from, row % EDGE, row / EDGE), row, &before, &after);
      for (int i = 0; i < 6; ++i) to[i][row] = out.f[i];
      if (last) {
        const Row value = fluence_of(&block, row, before, after);
        change += row_sum(fabs(value - LOAD_ROW(row, psi)));
        total += row_sum(value);
        STORE_ROW(value, row, psi);
      }
    }
    add_outgoing(&sent, (const Row(*)[ROWS])to);
  }
  Row(*result)[ROWS] = (inner & 1) ? odd_steps : even_steps;
  global float* faces = interfaces_out + ((size_t)channel * (blocks + 1) + block_index) * 6 * ROWS;
  const float mean = 1.0f / (float)inner;
  for (int row = 0; row < ROWS; ++row) {
    for (int i = 0; i < 6; ++i) STORE_ROW(result[i][row], row, stored + i * VOXELS);
    faces[0 * ROWS + row] = mean * sent.x[0][row];
    faces[1 * ROWS + row] = mean * sent.x[1][row];
  }
  for (int k = 0; k < EDGE; ++k) {
    STORE_ROW(mean * sent.y[0][k], k, faces + 2 * ROWS);
    STORE_ROW(mean * sent.y[1][k], k, faces + 3 * ROWS);
    STORE_ROW(mean * sent.z[0][k], k, faces + 4 * ROWS);
    STORE_ROW(mean * sent.z[1][k], k, faces + 5 * ROWS);
  }
  sums[2 * index] = change;
  sums[2 * index + 1] = total;
}

// Energy of one more step, per block: sums[channel][block][8] = absorbed, escaped through boundary faces towards -x, +x, -y,
// +y, -z, +z, and added to what is stored. sum q = absorbed + escaped + added holds in every step (numerics, energy identity);
// the last vanishes in the steady state.
kernel void balance(const global float* collision, const global float* source, const global float* injected,
                    const global int* link_block, const global float* links, const global int* neighbours,
                    const global float* interfaces_in, const global float* populations, global float* sums, int blocks,
                    int link_blocks, int channels) {
  const int block_index = get_global_id(0), channel = get_global_id(1);
  if (block_index >= blocks || channel >= channels) return;
  const Block block = block_data(collision, source, link_block, links, interfaces_in, neighbours, blocks, link_blocks,
                                 block_index, channel);
  const size_t index = (size_t)channel * blocks + block_index;
  const global float* stored = populations + index * 6 * VOXELS;
  Row state[6][ROWS];
  for (int i = 0; i < 6; ++i) {
    for (int row = 0; row < ROWS; ++row) state[i][row] = LOAD_ROW(row, stored + i * VOXELS);
  }
  Row absorbed = (Row)(0.0f), stored_more = (Row)(0.0f);
  float escaped[6] = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  for (int row = 0; row < ROWS; ++row) {
    Row before, after;
    collide(&block, pull(&block, (const Row(*)[ROWS])state, row % EDGE, row / EDGE), row, &before, &after);
    absorbed += before - after + LOAD_ROW(row, injected + index * VOXELS);
    for (int i = 0; i < 6; ++i) after -= state[i][row];
    stored_more += after;
    if (!block.links) continue;
    for (int i = 0; i < 6; ++i) {
      // Population i leaves through the face on its own side; what comes back there is population i ^ 1.
      const Row own = LOAD_ROW(row, block.links + (i ^ 1) * VOXELS);
      const Row other = LOAD_ROW(row, block.links + (6 + (i ^ 1)) * VOXELS);
      const Row leaves = other == 0.0f ? (1.0f - own) * state[i][row] : (Row)(0.0f);
      escaped[i ^ 1] += row_sum(leaves);
    }
  }
  sums[8 * index] = row_sum(absorbed);
  for (int face = 0; face < 6; ++face) sums[8 * index + 1 + face] = escaped[face];
  sums[8 * index + 7] = row_sum(stored_more);
}
