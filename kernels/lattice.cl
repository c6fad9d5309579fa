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

#include "lib/block_steps.h"
#include "lib/block_faces.h"

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
