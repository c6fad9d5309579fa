// SPDX-License-Identifier: Apache-2.0
// What a device can do at best: streams of memory, fused multiply-adds, launches. Profiles give each kernel's rates as
// fractions of these. Vectors of sixteen: PoCL does not vectorise inner loops across work-items, and wide vectors cost a
// GPU nothing here.

// a = b + s c (McCalpin's STREAM): 12 bytes per float with no counting of what a cache line's fill adds.
kernel void triad(global float16* a, const global float16* b, const global float16* c, float s) {
  const size_t i = get_global_id(0);
  a[i] = b[i] + s * c[i];
}

// a = b: 8 bytes per float.
kernel void stream_copy(global float16* a, const global float16* b) {
  const size_t i = get_global_id(0);
  a[i] = b[i];
}

// Eight independent chains of 16 lanes: rounds * 8 * 16 * 2 operations per work-item. They converge to 1 and stay finite.
kernel void multiply_add(global float* out, int rounds, float p, float q) {
  float16 x[8];
  for (int k = 0; k < 8; ++k) x[k] = (float16)((float)k + (float)get_global_id(0));
  for (int round = 0; round < rounds; ++round) {
    for (int k = 0; k < 8; ++k) x[k] = fma(x[k], (float16)(p), (float16)(q));
  }
  float16 sum = x[0];
  for (int k = 1; k < 8; ++k) sum += x[k];
  const float8 half_sum = sum.lo + sum.hi;
  const float4 quarter = half_sum.lo + half_sum.hi;
  out[get_global_id(0)] = (quarter.x + quarter.y) + (quarter.z + quarter.w);
}

// The least that a launch can cost.
kernel void nothing(global float* out) {
  if (get_global_id(0) == (size_t)-1) out[0] = 0.0f;
}
