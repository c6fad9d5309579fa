// SPDX-License-Identifier: Apache-2.0
// Test kernels: random numbers and scattering directions of kernels/lib.
#include "lib/phase.h"
#include "lib/random.h"

// in[6 i]: counter, key; out[4 i]: the four numbers.
kernel void probe_philox(const global uint* in, global uint* out, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const uint2 key = (uint2)(in[6 * i + 4], in[6 * i + 5]);
  vstore4(philox4x32((uint4)(in[6 * i], in[6 * i + 1], in[6 * i + 2], in[6 * i + 3]), key), i, out);
}

// out[2 i]: a uniform and an exponential number from the bits given.
kernel void probe_distributions(const global uint* in, global float* out, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  out[2 * i] = uniform(in[i]);
  out[2 * i + 1] = exponential(in[i]);
}

// out[i]: phase function at cosine 1 - 2 (i + 1/2) / count.
kernel void probe_phase(float g, global float* out, int count) {
  const int i = get_global_id(0);
  if (i < count) out[i] = henyey_greenstein(g, 1.0f - 2.0f * ((float)i + 0.5f) / (float)count);
}

// out[3 i]: direction after scattering from `axis`.
kernel void probe_scatter(float g, float x, float y, float z, uint seed, global float* out, int count) {
  const int i = get_global_id(0);
  if (i >= count) return;
  Random random = {(uint4)(i, 0, 0, 0), (uint2)(seed, 0)};
  const uint4 bits = draw(&random);
  vstore3(turned((float3)(x, y, z), sample_henyey_greenstein(g, uniform(bits.x)), uniform(bits.y)), i, out);
}
