// SPDX-License-Identifier: Apache-2.0
// View pass (Bernabei et al. III-D): camera samples enter the media where they were rasterised, bend, and gather what the
// fluence scatters towards the camera. In: samples, source tiles. Out: radiance [W/(unit^2 sr)] of surfaces and of media.
//
// Along a path radiance / eta^2 is invariant but for extinction and sources (numerics section 7):
//     L_obs = eta_obs^2 * integral of Tr j / eta^2 ds,    j = (sigma_s fluence + deposit + emission) / (4 pi)
// with the source constant over a step ds:  Tr j (1 - exp(-sigma_t ds)) / sigma_t.
//
// A work-item follows a packet of camera samples in step, see lib/packet.h.
#include "lib/gather.h"
#include "lib/surroundings.h"

#if !defined(TURBID_SAMPLES_PER_CLAIM)
#error "TURBID_SAMPLES_PER_CLAIM must be defined"
#endif

#define STACK 16

typedef struct {
  Ray ray;
  Colour weight;  // Tr, Fresnel factors and eta_obs^2, of radiance / eta^2
} Branch;

// A camera sample: the branch it follows and those that wait. While the packet carries the branch on, what changes from step
// to step stands there, and `now` and `gathered` are out of date.
typedef struct {
  Branch now;
  float room;  // see Packet
  Colour gathered;
  float3 surfaces;
  int index;  // of the sample; < 0: none
  int steps, met, stacked;
  Branch stack[STACK];
} Path;

typedef struct {
  Packet rays;
  LANE_ARRAY float weight[TURBID_CHANNELS][LANES], gathered[TURBID_CHANNELS][LANES];
  LANE_ARRAY int steps[LANES];
} Hot;

// Takes a path out of the packet, and puts it back.
static void take_path(const Hot* hot, int lane, Path* path) {
  path->now.ray = take_ray(&hot->rays, lane);
  path->now.weight = lane_colour(hot->weight, lane);
  path->gathered = lane_colour(hot->gathered, lane);
  path->steps = hot->steps[lane];
  path->room = room_around(&hot->rays, lane, path->now.ray.x);
}

static void put_path(Hot* hot, int lane, const Path* path, const Medium* medium, float step_size) {
  if (path->index < 0) {
    clear_lane(&hot->rays, lane);
    return;
  }
  put_ray(&hot->rays, lane, medium, &path->now.ray, step_size, path->room);
  set_lane_colour(path->now.weight, hot->weight, lane);
  set_lane_colour(path->gathered, hot->gathered, lane);
  hot->steps[lane] = path->steps;
}

#if TURBID_CHANNELS == 3
static float3 colour_rgb(Colour c) { return c.xyz; }
#else
static float3 colour_rgb(Colour c) { return (float3)(c); }
#endif

static float3 opaque_radiance(const Medium* medium, const Surroundings* s, const ViewParams* p, int region, float3 x,
                              float3 normal) {
  const global RegionParams* surface = medium->regions + region;
  float3 reflectance = vload3(0, surface->reflectance);
  if (surface->checker_size > 0.0f) {
    const float3 square = floor((x + vload3(0, p->origin)) / surface->checker_size);
    if (((int)square.x + (int)square.y + (int)square.z) & 1) reflectance = vload3(0, surface->reflectance2);
  }
  return reflectance * direct_irradiance(s, p, x, normal, 1.0f) * M_1_PI_F;
}

// Splits the path at an interface: the stronger part goes on, the weaker one is stacked while there is room.
static void split(Path* path, float3 normal, float eta_from, float eta_to, int next_region, float3 beyond, float grace,
                  float min_weight, int room) {
  const Branch* branch = &path->now;
  const float3 direction = branch->ray.v * rsqrt(dot(branch->ray.v, branch->ray.v));
  const Interface surface = meet_interface(direction, normal, eta_from, eta_to);
  Branch reflected = *branch, refracted = *branch;
  reflected.weight *= surface.reflectance;
  reflected.ray.v = eta_from * surface.reflected;
  reflected.ray.grace = grace;
  refracted.weight *= 1.0f - surface.reflectance;
  refracted.ray.v = eta_to * surface.refracted;
  refracted.ray.x = beyond;
  refracted.ray.region = next_region;
  refracted.ray.grace = grace;
  const bool keep_reflected = surface.reflectance > 0.5f;
  const Branch weaker = keep_reflected ? refracted : reflected;
  path->now = keep_reflected ? reflected : refracted;
  if (path->stacked < room && colour_max(weaker.weight) >= min_weight) path->stack[path->stacked++] = weaker;
}

// The branch has ended: the one stacked last goes on, or the sample is done.
static void next_branch(Path* path, const ViewParams* p, global float* radiance) {
  if (path->stacked > 0) {
    path->now = path->stack[--path->stacked];
    path->room = 0.0f;
    return;
  }
  global float* at = radiance + 8 * path->index;
  vstore3(path->surfaces, 0, at);
  at[3] = (float)path->steps;  // for profiles
  const float3 media = colour_rgb(path->gathered) * (TURBID_CHANNELS == 3 ? (float3)(1.0f) : vload3(0, p->tint));
  vstore3(media, 0, at + 4);
  path->index = -1;
}

static void begin(Path* path, const Medium* medium, const Surroundings* around, const ViewParams* p,
                  const global ViewSample* sample, int index, global float* radiance) {
  const float3 start = vload3(0, sample->position);
  const float3 direction = vload3(0, sample->direction);
  const float eta_ambient = medium->regions[0].eta;
  path->index = index;
  path->surfaces = (float3)(0.0f);
  path->gathered = colour_of(0.0f, 0.0f, 0.0f);
  path->steps = path->met = path->stacked = 0;
  path->room = 0.0f;
  if (sample->region < 0) {
    path->surfaces = surroundings_radiance(around, p, start, direction);
    next_branch(path, p, radiance);
    return;
  }
  if (medium->regions[sample->region].opaque) {
    path->surfaces = opaque_radiance(medium, around, p, sample->region, start, vload3(0, sample->normal));
    next_branch(path, p, radiance);
    return;
  }
  Branch* first = &path->now;
  first->ray.x = start;
  first->ray.region = sample->region;
  first->ray.grace = 1.5f;
  first->weight = colour_of(1.0f, 1.0f, 1.0f) * (p->eta_observer * p->eta_observer);
  const float eta = eta_at(medium, sample->region, locate(start));
  first->ray.v = direction * eta;
  if (sample->entering && !index_matched(medium, 0, sample->region, eta_ambient, eta)) {
    first->ray.region = 0;
    first->ray.v = direction * eta_ambient;
    split(path, vload3(0, sample->normal), eta_ambient, eta, sample->region, start, 1.5f, p->min_weight, STACK);
  }
}

// At another region's surface. False: the branch has ended there.
static bool meet_surface(Path* path, const Medium* medium, const Surroundings* around, const ViewParams* p,
                         const Step* step) {
  Branch* branch = &path->now;
  const int next_region = step->next_region;
  if (medium->regions[next_region].opaque) {
    path->surfaces += colour_rgb(branch->weight) / (p->eta_observer * p->eta_observer) *
                      opaque_radiance(medium, around, p, next_region, branch->ray.x, step->normal);
    return false;
  }
  const float eta_from = length(branch->ray.v);
  const float eta_to = eta_at(medium, next_region, locate(step->beyond));
  if (index_matched(medium, branch->ray.region, next_region, eta_from, eta_to)) {
    branch->ray.x = step->beyond;
    branch->ray.region = next_region;
    return true;
  }
  if (++path->met > 8 * p->max_branches) return false;
  split(path, step->normal, eta_from, eta_to, next_region, step->beyond, GRACE, p->min_weight,
        path->met <= p->max_branches ? STACK : 0);
  return colour_max(path->now.weight) >= p->min_weight;
}

// One step of any kind. False: the branch has ended.
static bool step_with_care(Path* path, const Medium* medium, const Surroundings* around, const ViewParams* p,
                           const global float* source_tiles) {
  Branch* branch = &path->now;
  const int region = branch->ray.region;
  const float3 from = branch->ray.x;
  const Step step = advance(medium, &branch->ray, p->step, path->room);
  const float3 heading = (branch->ray.x - from) / fmax(step.length, 1e-9f);
  if (region == 0 && p->ground) {
    const float t = distance_to_ground(p, from, heading);
    if (t <= step.length) {
      path->surfaces += colour_rgb(branch->weight) / (p->eta_observer * p->eta_observer) *
                        ground_radiance(around, p, from + t * heading, heading);
      return false;
    }
  }
  const int set = medium->regions[region].source_set;
  if (set >= 0 || medium->regions[region].attenuates) {
    const Cell middle = locate(step.middle);
    const Colour source = source_in(source_tiles, set >= 0 ? tile_of(medium, set, middle.block) : -1, middle);
    gather(&path->gathered, &branch->weight, extinction_at(medium, region, middle), source, step.length, step.eta_squared);
    if (colour_max(branch->weight) < p->min_weight) return false;
  }
  if (step.event == EVENT_FACE) {
    path->surfaces += colour_rgb(branch->weight) / (p->eta_observer * p->eta_observer) *
                      surroundings_radiance(around, p, branch->ray.x, normalize(branch->ray.v));
    return false;
  }
  if (step.event == EVENT_SURFACE && !meet_surface(path, medium, around, p, &step)) return false;
  path->room = step.event == EVENT_NONE ? step.room : 0.0f;
  return true;
}

// What a work-item has claimed of the samples.
typedef struct {
  int next, end;
} Claim;

// Begins the next samples until one has a path to follow, or none is left.
static void begin_next(Path* path, Claim* claim, const Medium* medium, const Surroundings* around, const ViewParams* p,
                       const global ViewSample* samples, global int* claims, global float* radiance) {
  while (path->index < 0) {
    if (claim->next == claim->end) {
      claim->next = min(atomic_add(claims, TURBID_SAMPLES_PER_CLAIM), p->sample_count);
      claim->end = min(claim->next + TURBID_SAMPLES_PER_CLAIM, p->sample_count);
      if (claim->next == claim->end) return;
    }
    begin(path, medium, around, p, samples + claim->next, claim->next, radiance);
    ++claim->next;
  }
}

// Work-items claim samples a few at a time until none is left; `claims` counts from 0 in each launch.
kernel void view(MEDIUM_ARGUMENTS, const global int4* region_tiles, ViewParams p, const global ViewSample* samples, global int* claims,
                 const global float* source_tiles, const global LightParams* lights, const global float* shadow_depths,
                 const global float* transmittance, const global float* ground_map, global float* radiance) {
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  const Surroundings around = {lights, shadow_depths, transmittance, ground_map};
  Path paths[LANES];
  Hot hot;
  Claim claim = {0, 0};
  for (int i = 0; i < LANES; ++i) {
    paths[i].index = -1;
    clear_lane(&hot.rays, i);
    begin_next(paths + i, &claim, &medium, &around, &p, samples, claims, radiance);
    put_path(&hot, i, paths + i, &medium, p.step);
  }
  Ints alive = MASK(LOAD(hot.rays.region) >= 0);
  while (any_of(alive)) {
    Strides strides;
    Ints ended, waiting;
    do {
      const Ints wanted = alive & MASK(LOAD(hot.steps) < p.max_steps);
      STORE(LOAD(hot.steps) - wanted, hot.steps);  // a mask is -1
      const Ints gone =
          glide(&medium, region_tiles, &hot.rays, alive, wanted, p.step, p.ground, p.ground_height, source_tiles, &strides);
      ended = alive & ~wanted;
      if (any_of(gone & LOAD(hot.rays.participates))) {
        ended |= gather_all(&hot.rays, &strides, gone, p.min_weight, hot.gathered[0], hot.weight[0]);
      }
      waiting = (alive & ~gone) | ended;
    } while (!any_of(waiting));
    LANE_ARRAY int ends[LANES];
    STORE(ended, ends);
    FOR_LANES(i, waiting) {
      Path* path = paths + i;
      take_path(&hot, i, path);
      if (ends[i] || !step_with_care(path, &medium, &around, &p, source_tiles)) {
        next_branch(path, &p, radiance);
        begin_next(path, &claim, &medium, &around, &p, samples, claims, radiance);
      }
      put_path(&hot, i, path, &medium, p.step);
    }
    alive = MASK(LOAD(hot.rays.region) >= 0);
  }
}
