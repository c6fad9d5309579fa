// SPDX-License-Identifier: Apache-2.0
// What a camera path gathers on a segment of constant source and coefficients (numerics section 7):
//     Tr j (1 - exp(-sigma_t ds)) / (sigma_t eta^2),    j = source / (4 pi)
#ifndef TURBID_LIB_GATHER_H
#define TURBID_LIB_GATHER_H
#include "lib/packet.h"

// Source of radiance 4 pi j at a point of a source tile [W/unit^2 per voxel]; none where there is no tile (tile < 0).
static ALWAYS_INLINE Colour source_in(const global float* source_tiles, int tile, Cell cell) {
#if TURBID_SCATTERING
  if (tile >= 0) {
#if TURBID_CHANNELS == 3
    return interpolate4(source_tiles, tile, cell);
#else
    const global float* at = source_tiles + (size_t)tile * TURBID_TILE_NODES + cell.node;
    const float2 a = load2(at), b = load2(at + TURBID_TILE_EDGE);
    const float2 c = load2(at + TURBID_TILE_EDGE * TURBID_TILE_EDGE);
    const float2 d = load2(at + TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1));
    const float2 row = mix(mix(a, b, cell.fraction.y), mix(c, d, cell.fraction.y), cell.fraction.z);
    return mix(row.x, row.y, cell.fraction.x);
#endif
  }
#endif
  return colour_of(0.0f, 0.0f, 0.0f);
}

// Adds what the segment sends towards the camera to `gathered` and takes what it swallows from `weight`.
static void gather(Colour* gathered, Colour* weight, Extinction sigma, Colour source, float length, float eta_squared) {
  const Colour depth = (sigma.sigma_s + sigma.sigma_a) * length;
  const Colour share = *weight * mean_transmittance(depth);
  *gathered += share * source * (length * 0.25f * M_1_PI_F / eta_squared);
  *weight -= share * depth;
}

// The same for the rays in `gone` of a packet; the mask of those whose weight has fallen below `min_weight`.
static ALWAYS_INLINE Ints gather_all(const Packet* p, const Strides* strides, Ints gone, float min_weight, float* gathered,
                                     float* weight) {
  const Extinctions sigma = extinctions_of(strides, p->sigma_s[0], p->sigma_a[0]);
  const Floats length = strides->length;
  Colours depth, left = load_colours(weight), share;
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    depth.channel[channel] = (sigma.sigma_s.channel[channel] + sigma.sigma_a.channel[channel]) * length;
  }
  const Colours mean = mean_transmittances(depth);
  Floats heaviest = (Floats)(0.0f);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    share.channel[channel] = left.channel[channel] * mean.channel[channel];
    left.channel[channel] -= share.channel[channel] * depth.channel[channel];
    heaviest = greatest(heaviest, left.channel[channel]);
  }
  store_colours(left, weight);
#if TURBID_SCATTERING
  const Floats lit = strides->no_source ? (Floats)(0.0f) : length * (0.25f * M_1_PI_F) / strides->eta_squared;
  const Colours source = sources_of(strides);
  Colours sum = load_colours(gathered);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    sum.channel[channel] += share.channel[channel] * source.channel[channel] * lit;
  }
  store_colours(sum, gathered);
#endif
  return gone & MASK(heaviest < min_weight);
}

#endif
