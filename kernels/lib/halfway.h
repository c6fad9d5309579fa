// SPDX-License-Identifier: Apache-2.0
// What the medium is half way through the rays' steps: force, coefficients and source, interpolated trilinearly in the tiles of a
// cell each. All of a ray's numbers are taken at once: they have their weights in common, and while one waits for memory, so do
// the others.
#ifndef TURBID_LIB_HALFWAY_H
#define TURBID_LIB_HALFWAY_H
#include "lib/attenuation.h"
#include "lib/lanes.h"

// What the rays of a packet did in a step.
typedef struct {
  LANE_ARRAY int block[LANES], node[LANES];  // the cell of the point half way
  LANE_ARRAY float fraction[3][LANES];       // in it
  LANE_ARRAY float rows[4][LANES];           // trilinear weights of its four rows of corners along x
  Ints coefficients_at, no_coefficients, source_at, no_source;  // see Packet
  Floats length, eta_squared;                // arc length done, 0 where no step was done; index squared half way
  // Interpolated, four lanes together.
  Quads force[LANE_QUADS];  // gradient of eta^2 / 2, and that itself
#if TURBID_CHANNELS == 3
  Quads scattering[LANE_QUADS], absorption[LANE_QUADS], source[LANE_QUADS];
#else
  Pairs coefficients[LANE_QUADS];
  Singles source[LANE_QUADS];
#endif
} Strides;

static ALWAYS_INLINE void set_cells(Strides* strides, Cells cells) {
  const Points f = cells.fraction;
  const Floats far = f.y * f.z;
  STORE(1.0f - f.y - f.z + far, strides->rows[0]);
  STORE(f.y - far, strides->rows[1]);
  STORE(f.z - far, strides->rows[2]);
  STORE(far, strides->rows[3]);
  STORE(cells.block, strides->block);
  STORE(cells.node, strides->node);
  store_points(f, strides->fraction[0]);
}

static ALWAYS_INLINE Cell cell_of(const Strides* strides, int lane) {
  Cell cell;
  cell.block = strides->block[lane];
  cell.node = strides->node[lane];
  cell.fraction = (float3)(strides->fraction[0][lane], strides->fraction[1][lane], strides->fraction[2][lane]);
  return cell;
}

// Reads the tiles; `index_at`: as in Packet, `source_tiles`: 0 where no source is wanted.
static ALWAYS_INLINE void interpolate_all(const Medium* medium, Ints index_at, const global float* source_tiles, Strides* strides) {
  const Ints node = LOAD(strides->node);
  LANE_ARRAY int index_node[LANES], coefficient_node[LANES], source_node[LANES];
  STORE(index_at + node, index_node);
  STORE(strides->coefficients_at + node, coefficient_node);
  STORE(strides->source_at + node, source_node);
#define ROWS(lane) &strides->rows[0][lane], LANES, strides->fraction[0][lane]
#define FORCE(lane) weigh4(medium->index_tiles + 4 * LANE(index_node, lane), ROWS(lane))
#define COEFFICIENTS(lane) \
  coefficients_of(medium->coefficient_tiles + COEFFICIENT_WIDTH * LANE(coefficient_node, lane), ROWS(lane))
#define SOURCE(lane) weigh_colour(source_tiles + SOURCE_WIDTH * LANE(source_node, lane), ROWS(lane))
  UNROLL
  for (int k = 0; k < LANE_QUADS; ++k) {
#if TURBID_GRADED
    strides->force[k] = FOUR(Quads, FORCE, k);
#endif
#if TURBID_HETEROGENEOUS && TURBID_CHANNELS == 3
    // Eight numbers a node, as if they were two nodes of four: scattering, absorption.
    float8 each[LANES / LANE_QUADS];
    UNROLL
    for (int i = 0; i < LANES / LANE_QUADS; ++i) each[i] = COEFFICIENTS(LANES / LANE_QUADS * k + i);
#define LOW(lane) each[lane - LANES / LANE_QUADS * k].lo
#define HIGH(lane) each[lane - LANES / LANE_QUADS * k].hi
    strides->scattering[k] = FOUR(Quads, LOW, k);
    strides->absorption[k] = FOUR(Quads, HIGH, k);
#undef LOW
#undef HIGH
#elif TURBID_HETEROGENEOUS
    strides->coefficients[k] = FOUR(Pairs, COEFFICIENTS, k);
#endif
#if TURBID_SCATTERING && TURBID_CHANNELS == 3
    if (source_tiles) strides->source[k] = FOUR(Quads, SOURCE, k);
#elif TURBID_SCATTERING
    if (source_tiles) strides->source[k] = FOUR(Singles, SOURCE, k);
#endif
  }
#undef ROWS
#undef FORCE
#undef COEFFICIENTS
#undef SOURCE
}

static ALWAYS_INLINE Points forces_of(const Strides* strides) {
  return (Points){COMPONENT0(Floats, strides->force), COMPONENT1(Floats, strides->force), COMPONENT2(Floats, strides->force)};
}

// Three colours, or one, of all lanes.
typedef struct {
  Floats channel[TURBID_CHANNELS];
} Colours;

static ALWAYS_INLINE Colours load_colours(const float* arrays) {
  Colours colours;
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) colours.channel[channel] = LOAD(arrays + LANES * channel);
  return colours;
}
static ALWAYS_INLINE void store_colours(Colours colours, float* arrays) {
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) STORE(colours.channel[channel], arrays + LANES * channel);
}

// One lane's.
static Colour lane_colour(const float (*arrays)[LANES], int lane) {
#if TURBID_CHANNELS == 3
  return (Colour)(arrays[0][lane], arrays[1][lane], arrays[2][lane], 0.0f);
#else
  return arrays[0][lane];
#endif
}

static void set_lane_colour(Colour value, float (*arrays)[LANES], int lane) {
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) arrays[channel][lane] = colour_channel(value, channel);
}

// Meaningless in lanes without a source.
static ALWAYS_INLINE Colours sources_of(const Strides* strides) {
#if TURBID_CHANNELS == 3
  return (Colours){{COMPONENT0(Floats, strides->source), COMPONENT1(Floats, strides->source), COMPONENT2(Floats, strides->source)}};
#else
  return (Colours){{ONLY(Floats, strides->source)}};
#endif
}

typedef struct {
  Colours sigma_s, sigma_a;  // [1/voxel]
} Extinctions;

// `sigma_s`, `sigma_a`: the regions' constants, where they have no tile.
static ALWAYS_INLINE Extinctions extinctions_of(const Strides* strides, const float* sigma_s, const float* sigma_a) {
  Extinctions result = {load_colours(sigma_s), load_colours(sigma_a)};
#if TURBID_HETEROGENEOUS
  const Ints plain = strides->no_coefficients;
#if TURBID_CHANNELS == 3
  result.sigma_s.channel[0] = plain ? result.sigma_s.channel[0] : COMPONENT0(Floats, strides->scattering);
  result.sigma_s.channel[1] = plain ? result.sigma_s.channel[1] : COMPONENT1(Floats, strides->scattering);
  result.sigma_s.channel[2] = plain ? result.sigma_s.channel[2] : COMPONENT2(Floats, strides->scattering);
  result.sigma_a.channel[0] = plain ? result.sigma_a.channel[0] : COMPONENT0(Floats, strides->absorption);
  result.sigma_a.channel[1] = plain ? result.sigma_a.channel[1] : COMPONENT1(Floats, strides->absorption);
  result.sigma_a.channel[2] = plain ? result.sigma_a.channel[2] : COMPONENT2(Floats, strides->absorption);
#else
  result.sigma_s.channel[0] = plain ? result.sigma_s.channel[0] : EVEN(Floats, strides->coefficients);
  result.sigma_a.channel[0] = plain ? result.sigma_a.channel[0] : ODD(Floats, strides->coefficients);
#endif
#endif
  return result;
}

// (1 - exp(-x)) / x for all lanes.
static ALWAYS_INLINE Colours mean_transmittances(Colours depth) {
  Colours mean;
  Floats deepest = (Floats)(0.0f);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    mean.channel[channel] = THIN_MEAN_TRANSMITTANCE(depth.channel[channel]);
    deepest = greatest(deepest, depth.channel[channel]);
  }
  if (!any_of(MASK(deepest > THIN_DEPTH))) return mean;
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    mean.channel[channel] = MEAN_TRANSMITTANCE_SERIES(depth.channel[channel]);
  }
  if (!any_of(MASK(deepest > 0.5f))) return mean;
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    const Floats x = depth.channel[channel];
    mean.channel[channel] = MASK(x > 0.5f) ? -exponential_less_one(-x) / greatest(x, (Floats)(0.5f)) : mean.channel[channel];
  }
  return mean;
}

#endif
