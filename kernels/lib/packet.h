// SPDX-License-Identifier: Apache-2.0
// A packet of rays: one step of all of them at once, wherever nothing can happen to them on it. It does what `advance` does
// there; the rays that may meet a face, a surface or the ground are left as they are, for `advance` to take one by one.
#ifndef TURBID_LIB_PACKET_H
#define TURBID_LIB_PACKET_H
#include "lib/attenuation.h"
#include "lib/lanes.h"
#include "lib/trace.h"

typedef struct {
  LANE_ARRAY float x[3][LANES], v[3][LANES];
  LANE_ARRAY float grace[LANES];
  LANE_ARRAY float dtau[LANES];      // of a whole step
  LANE_ARRAY float room[LANES];      // arc length on which the ray meets no surface within the block `room_block`
  LANE_ARRAY int room_block[LANES];
  LANE_ARRAY int region[LANES];      // < 0: there is no ray
  // Of the region:
  LANE_ARRAY int exact[LANES];       // mask: where its index is constant, one long segment is exact
  LANE_ARRAY int participates[LANES];  // mask: it attenuates or scatters
  LANE_ARRAY int tile_row[LANES];  // where the region's blocks begin in `region_tiles`
  LANE_ARRAY float sigma_s[TURBID_CHANNELS][LANES], sigma_a[TURBID_CHANNELS][LANES];
} Packet;

// What the rays of a packet did in a step. `..._at`: first node of a tile; where there is none, `no_...` is masked and the first
// tile of all stands in.
typedef struct {
  LANE_ARRAY int block[LANES], node[LANES];  // the cell of the point half way
  LANE_ARRAY float fraction[3][LANES];       // in it
  LANE_ARRAY float rows[4][LANES];           // trilinear weights of its four rows of corners along x
  Ints coefficients_at, no_coefficients, source_at, no_source;
  Floats length, eta_squared;                // arc length done; index squared half way
} Strides;

static void clear_lane(Packet* p, int lane) {
  p->region[lane] = -1;
  p->exact[lane] = p->participates[lane] = 0;
  p->room_block[lane] = -1;
  p->tile_row[lane] = 0;
  for (int axis = 0; axis < 3; ++axis) p->x[axis][lane] = p->v[axis][lane] = 1.0f;
  p->grace[lane] = p->room[lane] = p->dtau[lane] = 0.0f;
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) p->sigma_s[channel][lane] = p->sigma_a[channel][lane] = 0.0f;
}

// A ray that meets no surface within `room` in its block goes on in a lane of the packet.
static void put_ray(Packet* p, int lane, const Medium* medium, const Ray* ray, float step_size, float room) {
  const global RegionParams* region = medium->regions + ray->region;
  p->x[0][lane] = ray->x.x, p->x[1][lane] = ray->x.y, p->x[2][lane] = ray->x.z;
  p->v[0][lane] = ray->v.x, p->v[1][lane] = ray->v.y, p->v[2][lane] = ray->v.z;
  p->grace[lane] = ray->grace;
  p->room[lane] = room;
  p->room_block[lane] = locate(ray->x).block;
  p->dtau[lane] = step_size * (region->index_set >= 0 ? region->tau_per_arc : rsqrt(dot(ray->v, ray->v)));
  if (p->region[lane] == ray->region) return;
  p->region[lane] = ray->region;
  p->exact[lane] = -(region->source_set < 0 && region->coefficient_set < 0);
  p->participates[lane] = -(region->source_set >= 0 || region->attenuates);
  p->tile_row[lane] = ray->region * BLOCKS;
  const Colour sigma_s = colour_load4(region->sigma_s), sigma_a = colour_load4(region->sigma_a);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    p->sigma_s[channel][lane] = colour_channel(sigma_s, channel);
    p->sigma_a[channel][lane] = colour_channel(sigma_a, channel);
  }
}

static Ray take_ray(const Packet* p, int lane) {
  Ray ray;
  ray.x = (float3)(p->x[0][lane], p->x[1][lane], p->x[2][lane]);
  ray.v = (float3)(p->v[0][lane], p->v[1][lane], p->v[2][lane]);
  ray.region = p->region[lane];
  ray.grace = p->grace[lane];
  return ray;
}

static float room_around(const Packet* p, int lane, float3 x) {
  return locate(x).block == p->room_block[lane] ? p->room[lane] : 0.0f;
}

static ALWAYS_INLINE Cell cell_of(const Strides* strides, int lane) {
  Cell cell;
  cell.block = strides->block[lane];
  cell.node = strides->node[lane];
  cell.fraction = (float3)(strides->fraction[0][lane], strides->fraction[1][lane], strides->fraction[2][lane]);
  return cell;
}

// Trilinear value of four-wide nodes at a lane's point, `node` of the tiles being its cell's lowest corner.
#define VALUE_AT(tiles, node, strides, lane) \
  weigh4((tiles) + 4 * (node), &(strides)->rows[0][lane], LANES, (strides)->fraction[0][lane])

// One step of the rays in `wanted`; the mask of those that did it. `ground`: none is to pass this height in the ambient.
// region_tiles[region][block]: tiles of index, coefficients and source (< 0: none), and the one region of the block.
static ALWAYS_INLINE Ints glide(const Medium* medium, const global int4* region_tiles, Packet* p, Ints wanted, float step_size,
                                bool has_ground, float ground, Strides* strides) {
  const Points x = load_points(p->x[0]), v_before = load_points(p->v[0]);
  const Floats dtau = LOAD(p->dtau);
  const Points middle = along(x, 0.5f * dtau, v_before);
  const Cells cells = locate_all(middle);
  LANE_ARRAY int entry[LANES];
  STORE(LOAD(p->tile_row) + cells.block, entry);
  const Points f = cells.fraction;
  const Floats far = f.y * f.z;
  STORE(1.0f - f.y - f.z + far, strides->rows[0]);
  STORE(f.y - far, strides->rows[1]);
  STORE(f.z - far, strides->rows[2]);
  STORE(far, strides->rows[3]);
  STORE(cells.block, strides->block);
  STORE(cells.node, strides->node);
  store_points(f, strides->fraction[0]);
  QuadInts tiles[LANE_QUADS];
#define TILES(lane) region_tiles[entry[lane]]
  COLLECT(tiles, TILES);
#undef TILES
  const Ints coefficient_tile = COMPONENT1(Ints, tiles), source_tile = COMPONENT2(Ints, tiles);
  strides->no_coefficients = coefficient_tile >> 31;
  strides->no_source = source_tile >> 31;
  strides->coefficients_at = TURBID_TILE_NODES * not_negative(coefficient_tile);
  strides->source_at = TURBID_TILE_NODES * not_negative(source_tile);
  Ints going = wanted;
  Points v = v_before;
#if TURBID_GRADED
  const Ints index_tile = COMPONENT0(Ints, tiles), no_index = index_tile >> 31;
  LANE_ARRAY int node[LANES];
  STORE(TURBID_TILE_NODES * not_negative(index_tile) + cells.node, node);
  Quads force[LANE_QUADS];
#define FORCE(lane) VALUE_AT(medium->index_tiles, node[lane], strides, lane)
  COLLECT(force, FORCE);
#undef FORCE
  v = along(v, no_index ? (Floats)(0.0f) : dtau * INDEX_UNIT,
            (Points){COMPONENT0(Floats, force), COMPONENT1(Floats, force), COMPONENT2(Floats, force)});
  const Points mean = {0.5f * (v_before.x + v.x), 0.5f * (v_before.y + v.y), 0.5f * (v_before.z + v.z)};
  strides->eta_squared = squared_length(mean);
  strides->length = dtau * sqrt(strides->eta_squared);
  going &= ~(LOAD(p->exact) & no_index);
#else
  strides->eta_squared = squared_length(v);
  strides->length = (Floats)(step_size);
  going &= ~LOAD(p->exact);
#endif
  const Points to = along(middle, 0.5f * dtau, v);
  going &= MASK(to.x >= 0.0f) & MASK(to.y >= 0.0f) & MASK(to.z >= 0.0f) & MASK(to.x <= (float)TURBID_VOXELS_X) &
           MASK(to.y <= (float)TURBID_VOXELS_Y) & MASK(to.z <= (float)TURBID_VOXELS_Z);
  if (has_ground) {
    const Ints passes = MASK(least(x.y, to.y) <= ground) & MASK(greatest(x.y, to.y) >= ground);
    going &= ~(passes & MASK(LOAD(p->region) == 0));
  }
  const Floats room = LOAD(p->room) - strides->length;
  STORE(going ? room : LOAD(p->room), p->room);
#if TURBID_BODIES > 0
  // Whose is the point that the step leads to?
  const Ints block = locate_all(to).block, region = LOAD(p->region);
  if (any_of(going & (MASK(block != cells.block) | MASK(COMPONENT3(Ints, tiles) != region)))) {
    LANE_ARRAY int blocks[LANES], owner[LANES];
    STORE(block, blocks);
    for (int i = 0; i < LANES; ++i) owner[i] = medium->block_region[blocks[i]];
    const Ints known = MASK(LOAD(owner) == region) | (MASK(block == LOAD(p->room_block)) & MASK(room >= 0.0f));
    const Ints asking = going & ~known;
    LANE_ARRAY int go[LANES], ask[LANES];
    LANE_ARRAY float end[3][LANES];
    STORE(going, go);
    STORE(asking, ask);
    store_points(to, end[0]);
    for (int i = 0; any_of(asking) && i < LANES; ++i) {
      if (!ask[i]) continue;
      const int there = region_with_room(medium, locate((float3)(end[0][i], end[1][i], end[2][i])), &p->room[i]);
      p->room_block[i] = blocks[i];
      // A ray that gets clear of the surface it started on keeps its region, see `advance`.
      if (there != p->region[i]) {
        p->room[i] = 0.0f;
        go[i] = -(p->grace[i] > 0.0f);
      }
    }
    going = LOAD(go);
  }
#endif
  store_points(choose(going, to, x), p->x[0]);
  store_points(choose(going, v, v_before), p->v[0]);
  STORE(LOAD(p->grace) - (going ? strides->length : (Floats)(0.0f)), p->grace);
  return going;
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

// (1 - exp(-x)) / x for all lanes.
static ALWAYS_INLINE Colours mean_transmittances(Colours depth) {
  Colours mean;
  Ints deep = (Ints)(0);
  UNROLL
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    mean.channel[channel] = MEAN_TRANSMITTANCE_SERIES(depth.channel[channel]);
    deep |= MASK(depth.channel[channel] > 0.5f);
  }
  if (!any_of(deep)) return mean;
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    const Floats x = depth.channel[channel];
    mean.channel[channel] = MASK(x > 0.5f) ? -expm1(-x) / greatest(x, (Floats)(0.5f)) : mean.channel[channel];
  }
  return mean;
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

typedef struct {
  Colours sigma_s, sigma_a;  // [1/voxel]
} Extinctions;

// Half way through the rays' steps.
static ALWAYS_INLINE Extinctions extinctions_at(const Medium* medium, const Packet* p, const Strides* strides) {
  Extinctions result = {load_colours(p->sigma_s[0]), load_colours(p->sigma_a[0])};
#if TURBID_HETEROGENEOUS
  LANE_ARRAY int node[LANES];
  STORE(strides->coefficients_at + LOAD(strides->node), node);
  const Ints plain = strides->no_coefficients;
#if TURBID_CHANNELS == 3
  Quads scattered[LANE_QUADS], absorbed[LANE_QUADS];
  // Eight numbers a node, as if they were two nodes of four: scattering, absorption.
  for (int k = 0; k < LANE_QUADS; ++k) {
    float8 each[LANES / LANE_QUADS];
    UNROLL
    for (int i = 0; i < LANES / LANE_QUADS; ++i) {
      const int lane = LANES / LANE_QUADS * k + i;
      each[i] = coefficients_of(medium->coefficient_tiles + COEFFICIENT_WIDTH * node[lane], &strides->rows[0][lane], LANES,
                                strides->fraction[0][lane]);
    }
#if LANES == 1
    scattered[0] = each[0].lo, absorbed[0] = each[0].hi;
#else
    scattered[k] = (Quads)(each[0].lo, each[1].lo, each[2].lo, each[3].lo);
    absorbed[k] = (Quads)(each[0].hi, each[1].hi, each[2].hi, each[3].hi);
#endif
  }
  result.sigma_s.channel[0] = plain ? result.sigma_s.channel[0] : COMPONENT0(Floats, scattered);
  result.sigma_s.channel[1] = plain ? result.sigma_s.channel[1] : COMPONENT1(Floats, scattered);
  result.sigma_s.channel[2] = plain ? result.sigma_s.channel[2] : COMPONENT2(Floats, scattered);
  result.sigma_a.channel[0] = plain ? result.sigma_a.channel[0] : COMPONENT0(Floats, absorbed);
  result.sigma_a.channel[1] = plain ? result.sigma_a.channel[1] : COMPONENT1(Floats, absorbed);
  result.sigma_a.channel[2] = plain ? result.sigma_a.channel[2] : COMPONENT2(Floats, absorbed);
#else
  LANE_ARRAY float s[LANES], a[LANES];
  for (int i = 0; i < LANES; ++i) {
    const float2 sigma = coefficients_of(medium->coefficient_tiles + COEFFICIENT_WIDTH * node[i], &strides->rows[0][i], LANES,
                                         strides->fraction[0][i]);
    s[i] = sigma.x, a[i] = sigma.y;
  }
  result.sigma_s.channel[0] = plain ? result.sigma_s.channel[0] : LOAD(s);
  result.sigma_a.channel[0] = plain ? result.sigma_a.channel[0] : LOAD(a);
#endif
#endif
  return result;
}

#endif
