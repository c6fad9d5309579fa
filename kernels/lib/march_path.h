// SPDX-License-Identifier: Apache-2.0
// A light ray on its way: how it enters, what a segment takes from it, what happens at faces and surfaces, where it ends.
#ifndef TURBID_LIB_MARCH_PATH_H
#define TURBID_LIB_MARCH_PATH_H
#include "lib/ground.h"
#include "lib/packet.h"
#include "shared/march_params.h"

#ifndef TURBID_FIRST_MOMENT
#error "TURBID_FIRST_MOMENT (1: some phase function is anisotropic) must be defined"
#endif
#ifndef TURBID_OWN_SUMS
#error "TURBID_OWN_SUMS (1: every work-item has sums of its own, 0: all share them) must be defined"
#endif

// While a packet carries the ray on, what changes from step to step stands there.
typedef struct {
  Ray ray;
  float room;   // see Packet
  Colour power, absorbed, deposited;
  float floor_power;
  int index;    // in `rays`; < 0: no ray
  int bounces, steps, steps_left;
  int steps_in_packet;  // that it may do there
} Path;

// Where the light goes; the same for all paths of a work-item.
typedef struct {
  global RayState* next;
  global int* next_count;
  global long *deposit, *flux, *tallies, *ground, *transmitted;
  global int* ground_rays;
  int deposits, interfaces;  // how often
#if LANES > 1
  long own_tallies[3 * TURBID_TALLY_WORK];  // of the work-item, for others' caches to be left alone
#endif
} Sinks;

static Colour none(void) { return colour_of(0.0f, 0.0f, 0.0f); }

static void store_ray(Sinks* sinks, const Path* path, const Ray* ray, float room, Colour power,
                      const global RayState* parent) {
  global RayState* state = sinks->next + atomic_inc(sinks->next_count);
  vstore3(ray->x, 0, state->position);
  vstore3(ray->v, 0, state->velocity);
  state->region = ray->region;
  state->grace = ray->grace;
  state->room = room;
#if TURBID_CHANNELS == 3
  vstore3(power.xyz, 0, state->power);
#else
  state->power[0] = power;
#endif
  state->floor_power = path->floor_power;
  state->texel = parent->texel;
  state->entering = 0;
  state->bounces = path->bounces;
  state->steps = path->steps;
}

static void tally(Sinks* sinks, int kind, Colour power, const MarchParams* p) {
#if LANES > 1
  for (int channel = 0; channel < TURBID_CHANNELS; ++channel) {
    sinks->own_tallies[3 * kind + channel] += (long)(colour_channel(power, channel) * p->fixed_per_watt);
  }
#else
  add_power(sinks->tallies + 3 * kind, power, p->fixed_per_watt);
#endif
}

// At a work-item's end.
static void add_tallies(const Sinks* sinks, long steps) {
#if LANES > 1
  for (int i = 0; i < 3 * TURBID_TALLY_WORK; ++i) add_count(sinks->tallies + i, sinks->own_tallies[i]);
#endif
  global long* work = sinks->tallies + 3 * TURBID_TALLY_WORK;
  add_count(work, steps);
  add_count(work + 1, sinks->deposits);
  add_count(work + 2, sinks->interfaces);
}

// Ends a path's turn; `left` is power that goes nowhere any more.
static void end_path(Path* path, Sinks* sinks, const MarchParams* p, Colour in_flight) {
  tally(sinks, TURBID_TALLY_ABSORBED, path->absorbed, p);
  tally(sinks, TURBID_TALLY_DEPOSITED, path->deposited, p);
  tally(sinks, TURBID_TALLY_IN_FLIGHT, in_flight, p);
  path->index = -1;
}

// Light that has left the media, for the view pass: on the ground where it lands, or, where rays stay straight, as the shadow
// texel's transmittance.
static void collect(Sinks* sinks, const MarchParams* p, int texel, float3 x, float3 direction, Colour power) {
  if (!p->straight) {
    const GroundMap map = {p->ground ? p->ground_size : 0, p->ground_height, (float2)(p->ground_origin[0], p->ground_origin[1]),
                           p->ground_texel};
    light_ground(sinks->ground, sinks->ground_rays, map, x, direction, power, p->fixed_per_watt);
  } else if (texel >= 0) {
    add_power(sinks->transmitted + TURBID_CHANNELS * texel, power, p->fixed_per_watt);
  }
}

// Leaves scattered power in the nodes around a point.
static ALWAYS_INLINE void add_deposit(Sinks* sinks, const MarchParams* p, int tile, Cell cell, Colour scattered) {
#if TURBID_OWN_SUMS
  splat_own(sinks->deposit, tile, cell, scattered, p->fixed_per_watt);
#else
  splat(sinks->deposit, tile, cell, scattered, p->fixed_per_watt);
#endif
}

#if TURBID_FIRST_MOMENT
// The same times the light's direction.
static void add_moment(Sinks* sinks, const MarchParams* p, int tile, Cell cell, Colour scattered, float3 direction) {
  splat(sinks->flux, tile, cell, scattered * direction.x, p->fixed_per_watt);
  splat(sinks->flux + p->flux_stride, tile, cell, scattered * direction.y, p->fixed_per_watt);
  splat(sinks->flux + 2 * (size_t)p->flux_stride, tile, cell, scattered * direction.z, p->fixed_per_watt);
}
#endif

// Takes what a segment loses out of the path: its scattered part into the source tile, the rest absorbed. False: too weak to
// follow, the path has ended.
static bool attenuate(Path* path, const Medium* medium, Sinks* sinks, const MarchParams* p,
                      Extinction sigma, float length, int tile, Cell cell) {
  const Colour sigma_t = sigma.sigma_s + sigma.sigma_a;
  const Colour share = path->power * mean_transmittance(sigma_t * length) * length;
  Colour scattered = sigma.sigma_s * share, absorbed = sigma.sigma_a * share;
  path->power -= scattered + absorbed;
  const bool ends = colour_max(path->power) < path->floor_power;
  Colour in_flight = none();
  if (ends) {
    // What is left ends here as if the medium went on.
    const Colour rest = sigma_t > 0.0f ? path->power : none(), last = rest * (sigma.sigma_s / fmax(sigma_t, 1e-30f));
    in_flight = path->power - rest;
    scattered += last;
    absorbed += rest - last;
  }
#if TURBID_SCATTERING
  if (tile >= 0) {
    const float depth = colour_max(sigma_t) * length;
    const float3 direction = path->ray.v * rsqrt(dot(path->ray.v, path->ray.v));
    if (depth > THICK_STEP) {
      const Cell centre = locate(path->ray.x + (centre_of_loss(depth) - 1.0f) * length * direction);
      const int there = tile_of(medium, medium->regions[path->ray.region].source_set, centre.block);
      if (there >= 0) cell = centre, tile = there;
    }
    add_deposit(sinks, p, tile, cell, scattered);
    ++sinks->deposits;
#if TURBID_FIRST_MOMENT
    add_moment(sinks, p, tile, cell, scattered, direction);
#endif
    path->deposited += scattered;
  } else {
    absorbed += scattered;
  }
#else
  absorbed += scattered;
#endif
  path->absorbed += absorbed;
  if (ends) end_path(path, sinks, p, in_flight);
  return !ends;
}

// Loads a ray; one that has still to pass the surface it stands on does so.
static void begin(Path* path, const Medium* medium, Sinks* sinks, const MarchParams* p, const global RayState* state,
                  int index) {
  path->index = index;
  path->ray.x = vload3(0, state->position);
  path->ray.v = vload3(0, state->velocity);
  path->ray.region = state->region;
  path->ray.grace = state->grace;
  path->power = colour_load(state->power);
  path->floor_power = state->floor_power;
  path->absorbed = path->deposited = none();
  path->bounces = state->bounces;
  path->steps = state->steps;
  path->steps_left = p->batch_steps;
  path->room = state->room;
  if (!state->entering) return;
  const int region = path->ray.region;
  const float eta_from = length(path->ray.v);
  const float eta_to = eta_at(medium, region, locate(path->ray.x));
  const float3 direction = path->ray.v / eta_from;
  path->ray.v = eta_to * direction;
  if (index_matched(medium, 0, region, eta_from, eta_to)) return;
  const Interface surface = meet_interface(direction, vload3(0, state->normal), eta_from, eta_to);
  const Colour reflected = surface.reflectance * path->power;
  tally(sinks, TURBID_TALLY_REFLECTED, reflected, p);
  path->power -= reflected;
  path->ray.v = eta_to * surface.refracted;
  if (surface.reflectance >= 1.0f) end_path(path, sinks, p, none());
}

// At a face of the domain.
static void meet_face(Path* path, const Medium* medium, Sinks* sinks, const MarchParams* p, int texel, int face) {
  Ray* ray = &path->ray;
  const int axis = face >> 1;
  if (p->faces[face] == TURBID_FACE_MIRROR) {
    if (axis == 0) ray->v.x = -ray->v.x;
    if (axis == 1) ray->v.y = -ray->v.y;
    if (axis == 2) ray->v.z = -ray->v.z;
  } else if (p->faces[face] == TURBID_FACE_PERIODIC) {
    const float other = (face & 1) ? 0.0f : 1.0f;
    if (axis == 0) ray->x.x = other * TURBID_VOXELS_X;
    if (axis == 1) ray->x.y = other * TURBID_VOXELS_Y;
    if (axis == 2) ray->x.z = other * TURBID_VOXELS_Z;
    ray->region = region_at(medium, locate(ray->x));
  } else {
    tally(sinks, TURBID_TALLY_ESCAPED + face, path->power, p);
    collect(sinks, p, texel, ray->x, normalize(ray->v), path->power);
    end_path(path, sinks, p, none());
  }
}

// At another region's surface: the stronger branch goes on, the weaker one is stored as a ray of its own, and so is the path
// then, since a launch has room for one split of each ray.
static void meet_surface(Path* path, const Medium* medium, Sinks* sinks, const MarchParams* p,
                         const global RayState* state, const Step* step) {
  Ray* ray = &path->ray;
  const int next_region = step->next_region;
  if (medium->regions[next_region].opaque) {
    tally(sinks, TURBID_TALLY_OPAQUE, path->power, p);
    end_path(path, sinks, p, none());
    return;
  }
  const float eta_from = length(ray->v);
  const float eta_to = eta_at(medium, next_region, locate(step->beyond));
  if (index_matched(medium, ray->region, next_region, eta_from, eta_to)) {
    ray->x = step->beyond;
    ray->region = next_region;
    return;
  }
  if (++path->bounces > p->max_bounces) {
    end_path(path, sinks, p, path->power);
    return;
  }
  ++sinks->interfaces;
  const Interface surface = meet_interface(ray->v / eta_from, step->normal, eta_from, eta_to);
  Ray reflected = *ray, refracted = *ray;
  reflected.v = eta_from * surface.reflected;
  refracted.v = eta_to * surface.refracted;
  refracted.x = step->beyond;
  refracted.region = next_region;
  reflected.grace = refracted.grace = GRACE;
  const bool keep_reflected = surface.reflectance > 0.5f;
  const Colour reflected_power = surface.reflectance * path->power;
  const Colour refracted_power = path->power - reflected_power;
  const Colour side_power = keep_reflected ? refracted_power : reflected_power;
  const Ray side = keep_reflected ? refracted : reflected;
  *ray = keep_reflected ? reflected : refracted;
  path->power = keep_reflected ? reflected_power : refracted_power;
  if (colour_max(side_power) < path->floor_power) {
    tally(sinks, TURBID_TALLY_IN_FLIGHT, side_power, p);
    return;
  }
  store_ray(sinks, path, &side, 0.0f, side_power, state);
  store_ray(sinks, path, ray, 0.0f, path->power, state);
  end_path(path, sinks, p, none());
}

#endif
