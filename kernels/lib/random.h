// SPDX-License-Identifier: Apache-2.0
// Random numbers from counters: Philox4x32-10 (Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3",
// SC11). Four numbers are a pure function of (counter, key), so a photon's path depends on the seed and on its own number, and
// on nothing that ran beside it. Own text because Random123's headers do not pass our inlining of includes; the tests hold it
// to Random123's published known answers.
#ifndef TURBID_LIB_RANDOM_H
#define TURBID_LIB_RANDOM_H

static uint4 philox4x32(uint4 counter, uint2 key) {
#pragma unroll
  for (int round = 0; round < 10; ++round) {
    // 64-bit products: PoCL puts mul_hi together from 16-bit halves.
    const ulong a = (ulong)0xD2511F53u * counter.x, b = (ulong)0xCD9E8D57u * counter.z;
    counter = (uint4)((uint)(b >> 32) ^ counter.y ^ key.x, (uint)b, (uint)(a >> 32) ^ counter.w ^ key.y, (uint)a);
    key += (uint2)(0x9E3779B9u, 0xBB67AE85u);
  }
  return counter;
}

// One stream of numbers: four at a time.
typedef struct {
  uint4 counter;  // photon's number (x, y), draw (z), stream (w)
  uint2 key;      // seed
} Random;

static uint4 draw(Random* random) {
  const uint4 result = philox4x32(random->counter, random->key);
  ++random->counter.z;
  return result;
}

// Uniform in (0, 1), never 0 nor 1: 23 bits and a half.
static float uniform(uint bits) { return ((float)(bits >> 9) + 0.5f) * 0x1p-23f; }

// Exponential of mean 1, from 0 to 22.9.
static float exponential(uint bits) { return -log(fmin((float)bits * 0x1p-32f + 0x1p-33f, 1.0f)); }

#endif
