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
  LANE_ARRAY int index_row[LANES], coefficient_row[LANES], source_row[LANES];  // in the tile map; < 0: none
  LANE_ARRAY float sigma_s[TURBID_CHANNELS][LANES], sigma_a[TURBID_CHANNELS][LANES];
} Packet;

// What the rays of a packet did in a step.
typedef struct {
  LANE_ARRAY int block[LANES], node[LANES];  // the cell of the point half way
  LANE_ARRAY float fraction[3][LANES];       // in it
  Floats length, eta_squared;     // arc length done; index squared half way
} Strides;

static void clear_lane(Packet* p, int lane) {
  p->region[lane] = -1;
  p->exact[lane] = p->participates[lane] = 0;
  p->index_row[lane] = p->coefficient_row[lane] = p->source_row[lane] = p->room_block[lane] = -1;
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
  p->index_row[lane] = region->index_set * BLOCKS;
  p->coefficient_row[lane] = region->coefficient_set * BLOCKS;
  p->source_row[lane] = region->source_set * BLOCKS;
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

static ALWAYS_INLINE int tile_in(const Medium* medium, int row, int block) {
  return row >= 0 ? medium->tile_map[row + block] : -1;
}

// Force on a ray half way through its step.
static ALWAYS_INLINE float4 force_on(const Medium* medium, const Packet* p, const Strides* strides, int lane) {
  const int tile = tile_in(medium, p->index_row[lane], strides->block[lane]);
  return tile >= 0 ? interpolate4(medium->index_tiles, tile, cell_of(strides, lane)) : (float4)(0.0f);
}

// Which of the rays in a mask are where a set has no tile.
static Ints without_tile(const Medium* medium, const int* row, const Strides* strides, Ints mask) {
  LANE_ARRAY int none[LANES];
  for (int i = 0; i < LANES; ++i) none[i] = tile_in(medium, row[i], strides->block[i]) >> 31;
  return mask & LOAD(none);
}

// One step of the rays in `wanted`; the mask of those that did it. `ground`: none is to pass this height in the ambient.
static ALWAYS_INLINE Ints glide(const Medium* medium, Packet* p, Ints wanted, float step_size, bool has_ground, float ground,
                                Strides* strides) {
  const Points x = load_points(p->x[0]), v_before = load_points(p->v[0]);
  const Floats dtau = LOAD(p->dtau);
  const Points middle = along(x, 0.5f * dtau, v_before);
  const Cells cells = locate_all(middle);
  STORE(cells.block, strides->block);
  STORE(cells.node, strides->node);
  store_points(cells.fraction, strides->fraction[0]);
  Ints going = wanted;
  Points v = v_before;
#if TURBID_GRADED
  Quads force[QUADS];
#define FORCE(lane) force_on(medium, p, strides, lane)
  COLLECT4(force, FORCE);
#undef FORCE
  v = along(v, dtau, (Points){COMPONENT0(force), COMPONENT1(force), COMPONENT2(force)});
  const Points mean = {0.5f * (v_before.x + v.x), 0.5f * (v_before.y + v.y), 0.5f * (v_before.z + v.z)};
  strides->eta_squared = squared_length(mean);
  strides->length = dtau * sqrt(strides->eta_squared);
  if (any_of(going & LOAD(p->exact))) going &= ~without_tile(medium, p->index_row, strides, LOAD(p->exact));
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
  LANE_ARRAY int blocks[LANES], foreign = 0;
  STORE(block, blocks);
  for (int i = 0; i < LANES; ++i) foreign |= medium->block_region[blocks[i]] ^ p->region[i];
  if (foreign) {
    LANE_ARRAY int owner[LANES];
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

// (1 - exp(-x)) / x for all lanes.
static ALWAYS_INLINE Floats mean_transmittances(Floats depth) {
  Floats mean = MEAN_TRANSMITTANCE_SERIES(depth);
  const Ints deep = MASK(depth > 0.5f);
  if (any_of(deep)) mean = deep ? -expm1(-depth) / greatest(depth, (Floats)(0.5f)) : mean;
  return mean;
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

// A colour of each lane, which f(lane) gives.
#if TURBID_CHANNELS == 3
#define COLLECT_COLOURS(colours, f)                                                          \
  {                                                                                          \
    Quads quads[QUADS];                                                                      \
    COLLECT4(quads, f);                                                                      \
    colours = (Colours){{COMPONENT0(quads), COMPONENT1(quads), COMPONENT2(quads)}};         \
  }
#else
#define COLLECT_COLOURS(colours, f) COLLECT(colours.channel[0], f)
#endif

typedef struct {
  Colours sigma_s, sigma_a;  // [1/voxel]
} Extinctions;

// Half way through the rays' steps.
static ALWAYS_INLINE Extinctions extinctions_at(const Medium* medium, const Packet* p, const Strides* strides) {
#if TURBID_HETEROGENEOUS
  Extinction each[LANES];
  for (int i = 0; i < LANES; ++i) {
    const int tile = tile_in(medium, p->coefficient_row[i], strides->block[i]);
    each[i] = extinction_in(medium, max(p->region[i], 0), tile, cell_of(strides, i));
  }
  Extinctions result;
#define SIGMA_S(lane) each[lane].sigma_s
#define SIGMA_A(lane) each[lane].sigma_a
  COLLECT_COLOURS(result.sigma_s, SIGMA_S);
  COLLECT_COLOURS(result.sigma_a, SIGMA_A);
#undef SIGMA_S
#undef SIGMA_A
  return result;
#else
  return (Extinctions){load_colours(p->sigma_s[0]), load_colours(p->sigma_a[0])};
#endif
}

#endif
