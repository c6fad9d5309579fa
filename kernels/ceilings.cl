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

// Eight independent chains of 16 lanes: rounds * 8 * 16 * 2 operations per work-item. They converge to q / (1 - p) and stay
// finite. Written out: arrays would live in memory.
kernel void multiply_add(global float* out, int rounds, float p, float q) {
  const float16 vp = (float16)(p), vq = (float16)(q);
  float16 x0 = (float16)((float)get_global_id(0)), x1 = x0 + 1.0f, x2 = x0 + 2.0f, x3 = x0 + 3.0f;
  float16 x4 = x0 + 4.0f, x5 = x0 + 5.0f, x6 = x0 + 6.0f, x7 = x0 + 7.0f;
  for (int round = 0; round < rounds; ++round) {
    x0 = mad(x0, vp, vq);
    x1 = mad(x1, vp, vq);
    x2 = mad(x2, vp, vq);
    x3 = mad(x3, vp, vq);
    x4 = mad(x4, vp, vq);
    x5 = mad(x5, vp, vq);
    x6 = mad(x6, vp, vq);
    x7 = mad(x7, vp, vq);
  }
  const float16 sum = ((x0 + x1) + (x2 + x3)) + ((x4 + x5) + (x6 + x7));
  const float8 half_sum = sum.lo + sum.hi;
  const float4 quarter = half_sum.lo + half_sum.hi;
  out[get_global_id(0)] = (quarter.x + quarter.y) + (quarter.z + quarter.w);
}

// The least that a launch can cost.
kernel void nothing(global float* out) {
  if (get_global_id(0) == (size_t)-1) out[0] = 0.0f;
}
