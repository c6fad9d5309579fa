// SPDX-License-Identifier: Apache-2.0
// Marching pass (Bernabei et al. III-B): light rays bend, are attenuated, and leave what is scattered in the voxels.
// In: rays. Out: rays still under way and branches split off at interfaces, deposits on the source tiles, tallies, light on
// the ground. A launch does at most `batch_steps` steps per ray, and one split.
//
// A work-item traces TURBID_INTERLEAVE rays in turn, one step each: on CPUs the next ray's step fills the time in which this
// one's waits for memory and arithmetic. On GPUs the hardware does that with work-items, and one ray is best.
//
// Attenuation (Beer and Lambert), sigma constant over a step of length ds:
//     P' = P exp(-sigma_t ds);   the loss P - P' is scattered by the share sigma_s / sigma_t and absorbed else.
// (Bernabei's Fig. 4 adds exponentials where it must multiply, and deposits P' where it must deposit the scattered loss.)
#include "lib/march_path.h"

#if !defined(TURBID_INTERLEAVE) || !defined(TURBID_RAYS_PER_CLAIM)
#error "TURBID_INTERLEAVE and TURBID_RAYS_PER_CLAIM must be defined"
#endif

// One step of any kind.
static void step_with_care(Path* path, const Medium* medium, Sinks* sinks, const MarchParams* p,
                           const global RayState* state) {
  Ray* ray = &path->ray;
  const int region = ray->region;
  const float3 from = ray->x;
  const Step step = advance(medium, ray, p->step, path->place.room);
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
  look_around(medium, ray, p->step, step.event == EVENT_NONE ? step.room : 0.0f, &path->place);
  if (p->ground && ray->region == 0) path->place.room = fmin(path->place.room, fabs(ray->x.y - p->ground_height));
}

// Work-items claim rays first_ray ... end_ray - 1 a few at a time until none is left; `claims` counts from 0 in each launch.
kernel void march(MEDIUM_ARGUMENTS, MarchParams p, const global RayState* rays, global RayState* next,
                  global int* next_count, global int* claims, global long* deposit, global long* flux,
                  global long* tallies, global long* ground, global int* ground_rays, global long* transmitted) {
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  Sinks sinks = {next, next_count, deposit + (size_t)p.own_nodes * OWN_WIDTH * get_global_id(0), flux, tallies, ground,
                 transmitted, ground_rays, 0, 0};
  Path paths[TURBID_INTERLEAVE];
  for (int i = 0; i < TURBID_INTERLEAVE; ++i) paths[i].index = -1;
  int claimed = 0, claim_end = 0;
  long steps = 0;
  bool busy = true;
  while (busy) {
    busy = false;
    for (int i = 0; i < TURBID_INTERLEAVE; ++i) {
      Path* path = paths + i;
      if (path->index < 0) {
        if (claimed == claim_end) {
          claimed = p.first_ray + atomic_add(claims, TURBID_RAYS_PER_CLAIM);
          claim_end = min(claimed + TURBID_RAYS_PER_CLAIM, p.end_ray);
          claimed = min(claimed, claim_end);
          if (claimed == claim_end) continue;
        }
        begin(path, &medium, &sinks, &p, rays + claimed, claimed);
        ++claimed;
        busy = true;
        continue;
      }
      busy = true;
      if (path->steps >= p.max_steps) {
        end_path(path, &sinks, &p, path->power);
        continue;
      }
      if (path->steps_left == 0) {
        store_ray(&sinks, path, &path->ray, path->place.room, path->power, rays + path->index);
        end_path(path, &sinks, &p, none());
        continue;
      }
      ++path->steps;
      --path->steps_left;
      ++steps;
      Stride stride;
      if (glide(&medium, &path->ray, &path->place, p.step, &stride)) {
        const int region = path->ray.region;
        if (!medium.regions[region].attenuates) continue;
        const Extinction sigma = extinction_in(&medium, region, path->place.coefficient_tile, stride.cell);
        attenuate(path, &medium, &sinks, &p, sigma, stride.length, path->place.source_tile, stride.cell);
      } else {
        step_with_care(path, &medium, &sinks, &p, rays + path->index);
      }
    }
  }
  global long* work = tallies + 3 * TURBID_TALLY_WORK;
  add_count(work, steps);
  add_count(work + 1, sinks.deposits);
  add_count(work + 2, sinks.interfaces);
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
