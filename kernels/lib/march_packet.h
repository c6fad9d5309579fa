// SPDX-License-Identifier: Apache-2.0
// A packet of light rays: what a step takes from all of them at once, and how single paths leave and join it.
#ifndef TURBID_LIB_MARCH_PACKET_H
#define TURBID_LIB_MARCH_PACKET_H
#include "lib/march_path.h"

// What the rays of a packet leave in the medium's nodes on a step. It is added there one step later: the nodes have come into
// the cache by then, and the additions need not wait for what the step computes. A ray that leaves nothing adds nothing to where
// it left something last: that costs less than asking.
typedef struct {
  float power[4 * LANES] __attribute__((aligned(64)));  // [lane][4], or [lane] in grey
  LANE_ARRAY float fraction[3][LANES];                  // in the cell
  LANE_ARRAY int node[LANES];                           // lowest corner of the cell, counted through all tiles
  LANE_ARRAY int count[LANES];                          // of deposits
  bool any;
} Late;

static void clear_late(Late* late) {
  late->any = false;
  for (int i = 0; i < LANES; ++i) {
    late->node[i] = 2 * i;  // apart, so that none waits for another
    late->count[i] = 0;
  }
}

typedef struct {
  Packet rays;
  Late late;
  LANE_ARRAY float power[TURBID_CHANNELS][LANES], absorbed[TURBID_CHANNELS][LANES], deposited[TURBID_CHANNELS][LANES];
  LANE_ARRAY float floor_power[LANES];
  LANE_ARRAY int steps_left[LANES];  // in this launch and of all that a ray may do
} Hot;

// Returns the steps done in the packet.
static int take_path(const Hot* hot, int lane, Path* path) {
  path->ray = take_ray(&hot->rays, lane);
  path->room = room_around(&hot->rays, lane, path->ray.x);
  path->power = lane_colour(hot->power, lane);
  path->absorbed = lane_colour(hot->absorbed, lane);
  path->deposited = lane_colour(hot->deposited, lane);
  const int done = path->steps_in_packet - hot->steps_left[lane];
  path->steps += done;
  path->steps_left -= done;
  return done;
}

static void put_path(Hot* hot, int lane, Path* path, const Medium* medium, const MarchParams* p) {
  if (path->index < 0) {
    clear_lane(&hot->rays, lane);
    hot->steps_left[lane] = 0;
    return;
  }
  put_ray(&hot->rays, lane, medium, &path->ray, p->step, path->room);
  set_lane_colour(path->power, hot->power, lane);
  set_lane_colour(path->absorbed, hot->absorbed, lane);
  set_lane_colour(path->deposited, hot->deposited, lane);
  hot->floor_power[lane] = path->floor_power;
  hot->steps_left[lane] = path->steps_in_packet = min(path->steps_left, p->max_steps - path->steps);
}

#if TURBID_SCATTERING
// Keeps what the rays in `leaves` leave around the points `fraction` into their cells.
static ALWAYS_INLINE void leave_late(Late* late, Ints leaves, Ints node, Points fraction, Colours left, Sinks* sinks) {
  late->any = any_of(leaves);
  STORE(leaves ? node : LOAD(late->node), late->node);
  STORE(LOAD(late->count) - leaves, late->count);  // a mask is -1
  store_points(fraction, late->fraction[0]);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    left.channel[channel] = leaves ? left.channel[channel] : (Floats)(0.0f);
  }
#if TURBID_CHANNELS == 3
  store_triples(left.channel[0], left.channel[1], left.channel[2], late->power);
#else
  STORE(left.channel[0], late->power);
#endif
#if TURBID_OWN_SUMS && TURBID_CHANNELS == 3
  // A grey node is an eighth of a cache line: most of them are in the cache anyway.
  UNROLL
  for (int i = 0; i < LANES; ++i) expect_own(sinks->deposit, late->node[i]);
#endif
}

// Adds what the lanes from ... to - 1 left on their last step. Two halves stand apart in a step, so that each has other work
// beside it that waits for something else.
static ALWAYS_INLINE void add_late(Late* late, Sinks* sinks, const MarchParams* p, int from, int to) {
  if (!late->any) return;
  for (int i = from; i < to; ++i) {
    Cell cell;
    cell.node = late->node[i];
    cell.fraction = (float3)(late->fraction[0][i], late->fraction[1][i], late->fraction[2][i]);
    add_deposit(sinks, p, 0, cell, ((const Colour*)late->power)[i]);
  }
}

// Moves the points of thick steps from half way to where the light is lost on average, see `centre_of_loss`, unless the region
// has no tile there.
static ALWAYS_INLINE void move_to_losses(const Hot* hot, const global int4* region_tiles, Strides* strides, Ints thick,
                                         Floats depth, int* tile) {
  const Floats squared = depth * depth;
  const Floats centre = 0.5f - depth * (1.0f / 12.0f - squared * (1.0f / 720.0f - squared * (1.0f / 30240.0f - squared * (1.0f / 1209600.0f))));
  const Points v = load_points(hot->rays.v[0]);
  const Floats back = (centre - 1.0f) * strides->length / square_root(squared_length(v));
  const Cells cells = locate_all(along(load_points(hot->rays.x[0]), back, v));
  LANE_ARRAY int moves[LANES], entry[LANES], block[LANES], node[LANES];
  LANE_ARRAY float fraction[3][LANES];
  STORE(thick, moves);
  STORE(LOAD(hot->rays.tile_row) + cells.block, entry);
  STORE(cells.block, block);
  STORE(cells.node, node);
  store_points(cells.fraction, fraction[0]);
  for (int i = 0; i < LANES; ++i) {
    if (!moves[i]) continue;
    const int there = region_tiles[entry[i]].z;
    if (there < 0) continue;
    tile[i] = TURBID_TILE_NODES * there;
    strides->block[i] = block[i];
    strides->node[i] = node[i];
    for (int axis = 0; axis < 3; ++axis) strides->fraction[axis][i] = fraction[axis][i];
  }
}
#endif

// What the steps of the rays in `gone` take from them, as `attenuate` does; the mask of those left for `attenuate` itself: they
// may end here, or lose nearly all.
static ALWAYS_INLINE Ints attenuate_all(Hot* hot, const global int4* region_tiles, Sinks* sinks, const MarchParams* p,
                                        Strides* strides, Ints gone) {
#if TURBID_SCATTERING
  add_late(&hot->late, sinks, p, 0, LANES / 2);
#endif
  const Extinctions sigma = extinctions_of(strides, hot->rays.sigma_s[0], hot->rays.sigma_a[0]);
  const Colours power = load_colours(hot->power[0]);
  Colours depth, scattered, absorbed;
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    depth.channel[channel] = (sigma.sigma_s.channel[channel] + sigma.sigma_a.channel[channel]) * strides->length;
  }
  const Colours mean = mean_transmittances(depth);
  Floats heaviest = (Floats)(0.0f), deepest = (Floats)(0.0f);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    const Floats share = power.channel[channel] * mean.channel[channel] * strides->length;
    scattered.channel[channel] = sigma.sigma_s.channel[channel] * share;
    absorbed.channel[channel] = sigma.sigma_a.channel[channel] * share;
    heaviest = greatest(heaviest, power.channel[channel] - (scattered.channel[channel] + absorbed.channel[channel]));
    deepest = greatest(deepest, depth.channel[channel]);
  }
  Ints apart = gone & MASK(heaviest < LOAD(hot->floor_power));
#if TURBID_SCATTERING
  apart |= gone & MASK(deepest > 1.0f);  // as far as the series in `move_to_losses` goes
#endif
  const Ints here = gone & ~apart;
  if (any_of(apart)) {
    UNROLL
    for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
      scattered.channel[channel] = apart ? (Floats)(0.0f) : scattered.channel[channel];
      absorbed.channel[channel] = apart ? (Floats)(0.0f) : absorbed.channel[channel];
    }
  }
#if TURBID_SCATTERING
  const Ints absorbs = strides->no_source;  // where no source can be left
  const Ints leaves = here & ~absorbs;
  LANE_ARRAY int tile[LANES];
  STORE(strides->source_at, tile);
  const Ints thick = leaves & MASK(deepest > THICK_STEP);
  if (any_of(thick)) move_to_losses(hot, region_tiles, strides, thick, deepest, tile);
  add_late(&hot->late, sinks, p, LANES / 2, LANES);
  leave_late(&hot->late, leaves, LOAD(tile) + LOAD(strides->node), load_points(strides->fraction[0]), scattered, sinks);
#if TURBID_FIRST_MOMENT
  LANE_ARRAY int deposits[LANES];
  LANE_ARRAY float left[TURBID_CHANNELS][LANES];
  STORE(leaves, deposits);
  store_colours(scattered, left[0]);
  for (int i = 0; i < LANES; ++i) {
    if (!deposits[i]) continue;
    const float3 direction = normalize((float3)(hot->rays.v[0][i], hot->rays.v[1][i], hot->rays.v[2][i]));
    add_moment(sinks, p, tile[i] / TURBID_TILE_NODES, cell_of(strides, i), lane_colour(left, i), direction);
  }
#endif
#else
  const Ints absorbs = (Ints)(-1);
#endif
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    const Floats s = scattered.channel[channel], a = absorbed.channel[channel];
    STORE(power.channel[channel] - (s + a), hot->power[channel]);
    STORE(LOAD(hot->absorbed[channel]) + (a + (absorbs ? s : (Floats)(0.0f))), hot->absorbed[channel]);
    STORE(LOAD(hot->deposited[channel]) + (absorbs ? (Floats)(0.0f) : s), hot->deposited[channel]);
  }
  return apart;
}

#endif
