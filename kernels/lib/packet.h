// SPDX-License-Identifier: Apache-2.0
// A packet of rays: one step of all of them at once, wherever nothing can happen to them on it. It does what `advance` does
// there; the rays that may meet a face, a surface or the ground are left as they are, for `advance` to take one by one.
#ifndef TURBID_LIB_PACKET_H
#define TURBID_LIB_PACKET_H
#include "lib/halfway.h"
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
  // Of the region in the block of cells that the ray was in last. `..._at`: first node of a tile; where there is none, `no_...` is
  // masked and the first tile of all stands in.
  LANE_ARRAY int block[LANES];  // < 0: to be looked up
  LANE_ARRAY int index_at[LANES], no_index[LANES], coefficients_at[LANES], no_coefficients[LANES], source_at[LANES],
      no_source[LANES];
  LANE_ARRAY int only_region[LANES];  // the block's one region; < 0: more may meet there
} Packet;

static void clear_lane(Packet* p, int lane) {
  p->region[lane] = -1;
  p->exact[lane] = p->participates[lane] = 0;
  p->room_block[lane] = p->block[lane] = -1;
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
  p->block[lane] = -1;
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

// Looks up what the rays' region has in these blocks.
// region_tiles[region][block]: tiles of index, coefficients and source (< 0: none), and the one region of the block.
static ALWAYS_INLINE void look_up(const global int4* region_tiles, Packet* p, Ints block) {
  LANE_ARRAY int entry[LANES];
  STORE(LOAD(p->tile_row) + block, entry);
  QuadInts tiles[LANE_QUADS];
#define TILES(lane) region_tiles[LANE(entry, lane)]
  UNROLL
  for (int k = 0; k < LANE_QUADS; ++k) tiles[k] = FOUR(QuadInts, TILES, k);
#undef TILES
  const Ints index = COMPONENT0(Ints, tiles), coefficients = COMPONENT1(Ints, tiles), source = COMPONENT2(Ints, tiles);
  STORE(block, p->block);
  STORE(TURBID_TILE_NODES * not_negative(index), p->index_at);
  STORE(TURBID_TILE_NODES * not_negative(coefficients), p->coefficients_at);
  STORE(TURBID_TILE_NODES * not_negative(source), p->source_at);
  STORE(index >> 31, p->no_index);
  STORE(coefficients >> 31, p->no_coefficients);
  STORE(source >> 31, p->no_source);
  STORE(COMPONENT3(Ints, tiles), p->only_region);
}

// One step of the rays in `wanted`, which is some or all of those `alive`; the mask of those that did it. `ground`: none is to
// pass this height in the ambient. `source_tiles`: see interpolate_all.
static ALWAYS_INLINE Ints glide(const Medium* medium, const global int4* region_tiles, Packet* p, Ints alive, Ints wanted,
                                float step_size, bool has_ground, float ground, const global float* source_tiles,
                                Strides* strides) {
  const Points x = load_points(p->x[0]), v_before = load_points(p->v[0]);
  const Floats dtau = LOAD(p->dtau);
  const Points middle = along(x, 0.5f * dtau, v_before);
  const Cells cells = locate_all(middle);
  // A ray stays in a block for sixteen steps: guessing that all do lets the processor go on before it knows.
  if (any_of(wanted & MASK(cells.block != LOAD(p->block)))) look_up(region_tiles, p, cells.block);
  set_cells(strides, cells);
  strides->no_coefficients = LOAD(p->no_coefficients);
  strides->no_source = LOAD(p->no_source);
  strides->coefficients_at = LOAD(p->coefficients_at);
  strides->source_at = LOAD(p->source_at);
  interpolate_all(medium, LOAD(p->index_at), source_tiles, strides);
  Ints going = wanted;
  Points v = v_before;
#if TURBID_GRADED
  const Ints no_index = LOAD(p->no_index);
  v = along(v, no_index ? (Floats)(0.0f) : dtau * INDEX_UNIT, forces_of(strides));
  const Points mean = {0.5f * (v_before.x + v.x), 0.5f * (v_before.y + v.y), 0.5f * (v_before.z + v.z)};
  strides->eta_squared = squared_length(mean);
  strides->length = dtau * square_root(strides->eta_squared);
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
#if TURBID_BODIES > 0
  const Floats room = LOAD(p->room) - strides->length;
  STORE(going ? room : LOAD(p->room), p->room);
  // Whose is the point that the step leads to?
  const Ints block = locate_all(to).block, region = LOAD(p->region);
  if (any_of(going & (MASK(block != cells.block) | MASK(LOAD(p->only_region) != region)))) {
    LANE_ARRAY int blocks[LANES], owner[LANES];
    STORE(block, blocks);
    for (int i = 0; i < LANES; ++i) owner[i] = medium->block_region[blocks[i]];
    const Ints known = MASK(LOAD(owner) == region) | (MASK(block == LOAD(p->room_block)) & MASK(room >= 0.0f));
    const Ints asking = going & ~known;
    LANE_ARRAY int go[LANES];
    LANE_ARRAY float end[3][LANES];
    STORE(going, go);
    store_points(to, end[0]);
    FOR_LANES(i, asking) {
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
  // In lanes without a ray nothing moves.
  if (any_of(alive & ~going)) {
    strides->length = going ? strides->length : (Floats)(0.0f);
    store_points(choose(going, to, x), p->x[0]);
    store_points(choose(going, v, v_before), p->v[0]);
  } else {
    store_points(to, p->x[0]);
    store_points(v, p->v[0]);
  }
#if TURBID_BODIES > 0
  STORE(LOAD(p->grace) - strides->length, p->grace);
#endif
  return going;
}

#endif
