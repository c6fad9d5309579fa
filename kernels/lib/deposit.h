// SPDX-License-Identifier: Apache-2.0
// Power is added up in 64-bit fixed point: integer sums do not depend on the order in which work-items arrive, so the same
// scene gives the same bits whatever the thread timing.
#ifndef TURBID_LIB_DEPOSIT_H
#define TURBID_LIB_DEPOSIT_H
#include "lib/medium.h"

#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable

static void add_count(global long* sum, long count) {
  if (count != 0) atom_add((volatile global long*)sum, count);
}

static void add_fixed(global long* sum, float value) { atom_add((volatile global long*)sum, (long)value); }

// Adds a colour in watts to CHANNELS consecutive sums.
static void add_power(global long* sums, Colour power, float fixed_per_watt) {
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    const float value = colour_channel(power, channel) * fixed_per_watt;
    if (value != 0.0f) add_fixed(sums + channel, value);
  }
}

// Where on a step of this optical depth the light is lost on average, as a share of its length: 1/t - 1/(e^t - 1). One half for
// thin steps; the centroid is what diffusion sees of a voxel's source.
static float centre_of_loss(float depth) { return 1.0f / depth - 1.0f / expm1(depth); }

// Optical depth up to which a step's middle will do: it is off by depth / 12 of the step, a hundredth of a voxel.
#define THICK_STEP 0.25f

// Spreads power trilinearly over the eight nodes of the cell: sums[tile][node][channel].
static void splat(global long* sums, int tile, Cell cell, Colour power, float fixed_per_watt) {
  const float3 f = cell.fraction;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1, dy = (corner >> 1) & 1, dz = corner >> 2;
    const float weight = (dx ? f.x : 1.0f - f.x) * (dy ? f.y : 1.0f - f.y) * (dz ? f.z : 1.0f - f.z);
    const size_t node =
        (size_t)tile * TURBID_TILE_NODES + cell.node + dx + TURBID_TILE_EDGE * (dy + TURBID_TILE_EDGE * dz);
    add_power(sums + TURBID_CHANNELS * node, weight * power, fixed_per_watt);
  }
}

// Sums of a work-item's own need no atomics: four 64-bit integers per node in three colours, one in grey, so that the two
// x-neighbours of a row are one vector. Being integers, they add up to the same whichever work-item traced which ray.
#if TURBID_CHANNELS == 3
#define OWN_WIDTH 4
// Node by node: rays side by side follow each other into the same nodes, and a load waits for an earlier store to memory unless
// they are of the same bytes.
static ALWAYS_INLINE void add_row(global long* at, Colour left, Colour right) {
  vstore4(vload4(0, at) + convert_long4(left), 0, at);
  vstore4(vload4(1, at) + convert_long4(right), 1, at);
}
#else
#define OWN_WIDTH 1
static ALWAYS_INLINE void add_row(global long* at, long2 units) { vstore2(vload2(0, at) + units, 0, at); }
#endif

// Asks for the nodes around a cell, whose lowest corner is `node`, to be in the cache when light is added to them.
static ALWAYS_INLINE void expect_own(const global long* sums, int node) {
  _Pragma("unroll")
  for (int row = 0; row < 4; ++row) {
    const global long* at =
        sums + OWN_WIDTH * ((size_t)node + TURBID_TILE_EDGE * ((row & 1) + TURBID_TILE_EDGE * (row >> 1)));
    __builtin_prefetch((const void*)(ulong)at, 1);
    __builtin_prefetch((const void*)(ulong)(at + 2 * OWN_WIDTH - 1), 1);
  }
}

#if TURBID_CHANNELS == 3
static ALWAYS_INLINE void splat_own(global long* sums, int tile, Cell cell, Colour power, float fixed_per_watt) {
  global long* at = sums + OWN_WIDTH * ((size_t)tile * TURBID_TILE_NODES + cell.node);
  const float3 f = cell.fraction;
  const Colour units = power * fixed_per_watt;
  const Colour far = f.z * units, near = units - far;
  const Colour near_up = f.y * near, far_up = f.y * far, near_down = near - near_up, far_down = far - far_up;
  add_row(at, near_down - f.x * near_down, f.x * near_down);
  add_row(at + OWN_WIDTH * TURBID_TILE_EDGE, near_up - f.x * near_up, f.x * near_up);
  add_row(at + OWN_WIDTH * TURBID_TILE_EDGE * TURBID_TILE_EDGE, far_down - f.x * far_down, f.x * far_down);
  add_row(at + OWN_WIDTH * TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1), far_up - f.x * far_up, f.x * far_up);
}
#else
// Corners in the order of their nodes: x fastest, z slowest.
static ALWAYS_INLINE void splat_own(global long* sums, int tile, Cell cell, Colour power, float fixed_per_watt) {
  const float8 along_x = (float8)(1, 0, 1, 0, 1, 0, 1, 0) + (float8)(-1, 1, -1, 1, -1, 1, -1, 1) * cell.fraction.x;
  const float8 along_y = (float8)(1, 1, 0, 0, 1, 1, 0, 0) + (float8)(-1, -1, 1, 1, -1, -1, 1, 1) * cell.fraction.y;
  const float8 along_z = (float8)(1, 1, 1, 1, 0, 0, 0, 0) + (float8)(-1, -1, -1, -1, 1, 1, 1, 1) * cell.fraction.z;
  const long8 units = convert_long8(along_x * along_y * (along_z * (power * fixed_per_watt)));
  global long* at = sums + (size_t)tile * TURBID_TILE_NODES + cell.node;
  add_row(at, units.s01);
  add_row(at + TURBID_TILE_EDGE, units.s23);
  add_row(at + TURBID_TILE_EDGE * TURBID_TILE_EDGE, units.s45);
  add_row(at + TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1), units.s67);
}
#endif

#endif
