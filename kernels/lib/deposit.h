// SPDX-License-Identifier: Apache-2.0
// Power is added up in 64-bit fixed point: integer sums do not depend on the order in which work-items arrive, so the same
// scene gives the same bits whatever the thread timing.
#ifndef TURBID_LIB_DEPOSIT_H
#define TURBID_LIB_DEPOSIT_H
#include "lib/medium.h"

#pragma OPENCL EXTENSION cl_khr_int64_base_atomics : enable

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
static float centre_of_loss(float depth) {
  return depth < 0.05f ? 0.5f - depth / 12.0f : 1.0f / depth - 1.0f / expm1(depth);
}

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

#endif
