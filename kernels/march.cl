// SPDX-License-Identifier: Apache-2.0
// Marching pass (Bernabei et al. III-B): light rays bend, are attenuated, and leave what is scattered in the voxels.
// In: rays. Out: rays still under way and branches split off at interfaces, deposits on the source tiles, tallies, light on
// the ground. A launch does at most `batch_steps` steps per ray, and one split.
//
// A work-item traces a packet of rays in step, see lib/packet.h.
//
// Attenuation (Beer and Lambert), sigma constant over a step of length ds:
//     P' = P exp(-sigma_t ds);   the loss P - P' is scattered by the share sigma_s / sigma_t and absorbed else.
// (Bernabei's Fig. 4 adds exponentials where it must multiply, and deposits P' where it must deposit the scattered loss.)
#include "lib/march_packet.h"

#if !defined(TURBID_RAYS_PER_CLAIM)
#error "TURBID_RAYS_PER_CLAIM must be defined"
#endif

// One step of any kind.
static void step_with_care(Path* path, const Medium* medium, Sinks* sinks, const MarchParams* p,
                           const global RayState* state) {
  Ray* ray = &path->ray;
  const int region = ray->region;
  const float3 from = ray->x;
  const Step step = advance(medium, ray, p->step, path->room);
  if (p->ground && region == 0 && from.y > p->ground_height && ray->x.y <= p->ground_height) {
    // The ground cuts through the domain: what reaches it counts as escaped downwards.
    tally(sinks, TURBID_TALLY_ESCAPED + 2, path->power, p);
    collect(sinks, p, state->texel, from, normalize(ray->x - from), path->power);
    end_path(path, sinks, p, none());
    return;
  }
  if (medium->regions[region].attenuates) {
    const Cell cell = locate(step.middle);
    const int set = medium->regions[region].source_set;
    const int tile = set >= 0 ? tile_of(medium, set, cell.block) : -1;
    if (!attenuate(path, medium, sinks, p, extinction_at(medium, region, cell), step.length, tile, cell)) return;
  }
  if (step.event == EVENT_FACE) meet_face(path, medium, sinks, p, state->texel, step.face);
  if (step.event == EVENT_SURFACE) meet_surface(path, medium, sinks, p, state, &step);
  if (path->index < 0) return;
  path->room = step.event == EVENT_NONE ? step.room : 0.0f;
}

// What a work-item has claimed of the rays.
typedef struct {
  int next, end;
} Claim;

// Begins the next rays until one has a path to follow, or none is left.
static void begin_next(Path* path, Claim* claim, const Medium* medium, Sinks* sinks, const MarchParams* p,
                       const global RayState* rays, global int* claims) {
  while (path->index < 0) {
    if (claim->next == claim->end) {
      const int next = p->first_ray + atomic_add(claims, TURBID_RAYS_PER_CLAIM);
      claim->end = min(next + TURBID_RAYS_PER_CLAIM, p->end_ray);
      claim->next = min(next, claim->end);
      if (claim->next == claim->end) return;
    }
    begin(path, medium, sinks, p, rays + claim->next, claim->next);
    ++claim->next;
  }
}

// Work-items claim rays first_ray ... end_ray - 1 a few at a time until none is left; `claims` counts from 0 in each launch.
kernel void march(MEDIUM_ARGUMENTS, const global int4* region_tiles, MarchParams p, const global RayState* rays, global RayState* next,
                  global int* next_count, global int* claims, global long* deposit, global long* flux,
                  global long* tallies, global long* ground, global int* ground_rays, global long* transmitted) {
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  Sinks sinks = {next, next_count, deposit + (size_t)p.own_nodes * OWN_WIDTH * get_global_id(0), flux, tallies, ground,
                 transmitted, ground_rays, 0, 0};
  Path paths[LANES];
  Hot hot;
  Claim claim = {0, 0};
  clear_late(&hot.late);
  for (int i = 0; i < LANES; ++i) {
    paths[i].index = -1;
    clear_lane(&hot.rays, i);
    begin_next(paths + i, &claim, &medium, &sinks, &p, rays, claims);
    put_path(&hot, i, paths + i, &medium, &p);
  }
  long done = 0;
  Ints alive = MASK(LOAD(hot.rays.region) >= 0);
  while (any_of(alive)) {
    Strides strides;
    Ints wanted, waiting, apart;
    do {
      wanted = MASK(LOAD(hot.steps_left) > 0);
      STORE(LOAD(hot.steps_left) + wanted, hot.steps_left);  // a mask is -1
      const Ints gone = glide(&medium, region_tiles, &hot.rays, alive, wanted, p.step, p.ground, p.ground_height, 0, &strides);
      apart = (Ints)(0);
      if (any_of(gone & LOAD(hot.rays.participates))) apart = attenuate_all(&hot, region_tiles, &sinks, &p, &strides, gone);
      waiting = (alive & ~gone) | apart;
    } while (!any_of(waiting));
    LANE_ARRAY int steps[LANES], attenuates[LANES];
    LANE_ARRAY float length[LANES];
    STORE(wanted, steps);
    STORE(apart, attenuates);
    STORE(strides.length, length);
    FOR_LANES(i, waiting) {
      Path* path = paths + i;
      done += take_path(&hot, i, path);
      if (attenuates[i]) {
        const Cell cell = cell_of(&strides, i);
        const int set = medium.regions[path->ray.region].source_set;
        attenuate(path, &medium, &sinks, &p, extinction_at(&medium, path->ray.region, cell), length[i],
                  set >= 0 ? tile_of(&medium, set, cell.block) : -1, cell);
      } else if (steps[i]) {
        step_with_care(path, &medium, &sinks, &p, rays + path->index);
      } else if (path->steps >= p.max_steps) {
        end_path(path, &sinks, &p, path->power);
      } else {
        store_ray(&sinks, path, &path->ray, path->room, path->power, rays + path->index);
        end_path(path, &sinks, &p, none());
      }
      begin_next(path, &claim, &medium, &sinks, &p, rays, claims);
      put_path(&hot, i, path, &medium, &p);
    }
    alive = MASK(LOAD(hot.rays.region) >= 0);
  }
#if TURBID_SCATTERING
  add_late(&hot.late, &sinks, &p, 0, LANES);
#endif
  for (int i = 0; i < LANES; ++i) sinks.deposits += hot.late.count[i];
  add_tallies(&sinks, done);
}

// Adds the work-items' own sums up: own[volume][node][OWN_WIDTH] to deposit[node][channel]. One work-item per node.
kernel void sum_deposits(const global long* own, global long* deposit, int volumes, int nodes) {
  const size_t node = get_global_id(0);
  if (node >= nodes) return;
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    long sum = 0;
    for (int volume = 0; volume < volumes; ++volume) sum += own[((size_t)volume * nodes + node) * OWN_WIDTH + channel];
    deposit[TURBID_CHANNELS * node + channel] = sum;
  }
}
