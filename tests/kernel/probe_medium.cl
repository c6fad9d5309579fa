// SPDX-License-Identifier: Apache-2.0
// Test kernels: one call of each function of kernels/lib per work-item, results in plain arrays.
#include "lib/deposit.h"
#include "lib/trace.h"

// in[8 i]: direction, normal, eta_from, eta_to; out[7 i]: reflectance, reflected, refracted.
kernel void probe_interface(const global float* in, global float* out, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const global float* at = in + 8 * i;
  const Interface surface = meet_interface(vload3(0, at), vload3(1, at), at[6], at[7]);
  out[7 * i] = surface.reflectance;
  vstore3(surface.reflected, 0, out + 7 * i + 1);
  vstore3(surface.refracted, 0, out + 7 * i + 4);
}

// out[17 i]: block, node, fraction, region, (grad u, u), (grad d, d) of `body`, sigma_s and sigma_a of the first channel, room.
kernel void probe_point(MEDIUM_ARGUMENTS, const global float* points, global float* out, int body, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  const Cell cell = locate(vload3(i, points));
  global float* at = out + 17 * i;
  float room;
  const int region = region_with_room(&medium, cell, &room);
  at[16] = room;
  at[0] = cell.block;
  at[1] = cell.node;
  vstore3(cell.fraction, 0, at + 2);
  at[5] = region;
  vstore4(index_at(&medium, region, cell), 0, at + 6);
  vstore4(body > 0 ? surface_at(&medium, body, cell) : (float4)(0.0f), 0, at + 10);
  const Extinction sigma = extinction_at(&medium, region, cell);
  at[14] = colour_channel(sigma.sigma_s, 0);
  at[15] = colour_channel(sigma.sigma_a, 0);
}

// Trilinear value of four-wide nodes, one tile per block of the domain: out[4 i].
kernel void probe_interpolate(const global float* tiles, const global float* points, global float* out, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const Cell cell = locate(vload3(i, points));
  vstore4(interpolate4(tiles, cell.block, cell), i, out);
}

// One step: in[8 i]: position, velocity, region, grace; out[16 i]: event, length, middle, next region, surface, beyond, face,
// new position, eta where it stands... see trace.h.
kernel void probe_step(MEDIUM_ARGUMENTS, const global float* in, float step_size, global float* out, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  Ray ray;
  ray.x = vload3(0, in + 8 * i);
  ray.v = vload3(1, in + 8 * i);
  ray.region = (int)in[8 * i + 6];
  ray.grace = in[8 * i + 7];
  const Step step = advance(&medium, &ray, step_size, 0.0f);
  global float* at = out + 16 * i;
  at[0] = step.event;
  at[1] = step.length;
  vstore3(step.middle, 0, at + 2);
  at[5] = step.next_region;
  at[6] = step.surface;
  vstore3(step.beyond, 0, at + 7);
  at[10] = step.face;
  vstore3(ray.x, 0, at + 11);
  at[14] = ray.region;
  at[15] = ray.grace;
}

// in[4 i]: position, power. One tile per block of the domain.
kernel void probe_splat(const global float* in, global long* sums, float fixed_per_watt, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const Cell cell = locate(vload3(0, in + 4 * i));
  splat(sums, cell.block, cell, (Colour)(in[4 * i + 3]), fixed_per_watt);
}
