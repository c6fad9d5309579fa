// SPDX-License-Identifier: Apache-2.0
// Marching pass (Bernabei et al. III-B): light rays bend, are attenuated, and leave what is scattered in the voxels.
// In: rays. Out: rays still under way and branches split off at interfaces, deposits on the source tiles, tallies, light on
// the ground. A launch does at most `batch_steps` steps per ray, and one split.
//
// Attenuation (Beer and Lambert), sigma constant over a step of length ds:
//     P' = P exp(-sigma_t ds);   the loss P - P' is scattered by the share sigma_s / sigma_t and absorbed else.
// (Bernabei's Fig. 4 adds exponentials where it must multiply, and deposits P' where it must deposit the scattered loss.)
#include "lib/ground.h"
#include "lib/trace.h"
#include "shared/march_params.h"

#if !defined(TURBID_FIRST_MOMENT)
#error "TURBID_FIRST_MOMENT (1: some phase function is anisotropic) must be defined"
#endif

typedef struct {
  Colour absorbed, deposited, reflected, opaque_surface, in_flight;
  int deposits, interfaces;  // how often
} Tally;

static Ray ray_from(const global RayState* state) {
  Ray ray;
  ray.x = vload3(0, state->position);
  ray.v = vload3(0, state->velocity);
  ray.region = state->region;
  ray.grace = state->grace;
  return ray;
}

static void store_ray(global RayState* state, const Ray* ray, Colour power, const global RayState* parent, int bounces,
                      int steps) {
  vstore3(ray->x, 0, state->position);
  vstore3(ray->v, 0, state->velocity);
  state->region = ray->region;
  state->grace = ray->grace;
#if TURBID_CHANNELS == 3
  vstore3(power.xyz, 0, state->power);
#else
  state->power[0] = power;
#endif
  state->floor_power = parent->floor_power;
  state->texel = parent->texel;
  state->entering = 0;
  state->bounces = bounces;
  state->steps = steps;
}

// Deposits the scattered part of what was lost along the way from `from` to `to`, and tallies the rest.
static void lose(const Medium* medium, Tally* tally, global long* deposit, global long* flux, size_t flux_stride, int region,
                 float3 from, float3 to, Colour loss, Extinction sigma, float fixed_per_watt) {
#if TURBID_SCATTERING
  const int set = medium->regions[region].source_set;
  if (set >= 0) {
    const Colour sigma_t = sigma.sigma_s + sigma.sigma_a;
    const Cell cell = locate(from + centre_of_loss(colour_max(sigma_t) * distance(from, to)) * (to - from));
    const int tile = tile_of(medium, set, cell.block);
    if (tile >= 0) {
      const Colour scattered = loss * (sigma.sigma_s / fmax(sigma_t, 1e-30f));
      splat(deposit, tile, cell, scattered, fixed_per_watt);
#if TURBID_FIRST_MOMENT
      const float3 direction = (to - from) / fmax(distance(from, to), 1e-12f);
      splat(flux, tile, cell, scattered * direction.x, fixed_per_watt);
      splat(flux + flux_stride, tile, cell, scattered * direction.y, fixed_per_watt);
      splat(flux + 2 * flux_stride, tile, cell, scattered * direction.z, fixed_per_watt);
#endif
      tally->deposited += scattered;
      ++tally->deposits;
      loss -= scattered;
    }
  }
#endif
  tally->absorbed += loss;
}

// Light that has left the media, for the view pass: on the ground where it lands, or, where rays stay straight, as the shadow
// texel's transmittance.
static void collect(global long* ground, global int* ground_rays, global long* transmitted, const MarchParams* p, int texel,
                    float3 x, float3 direction, Colour power) {
  if (!p->straight) {
    const GroundMap map = {p->ground ? p->ground_size : 0, p->ground_height, (float2)(p->ground_origin[0], p->ground_origin[1]),
                           p->ground_texel};
    light_ground(ground, ground_rays, map, x, direction, power, p->fixed_per_watt);
  } else if (texel >= 0) {
    add_power(transmitted + TURBID_CHANNELS * texel, power, p->fixed_per_watt);
  }
}

kernel void march(MEDIUM_ARGUMENTS, MarchParams p, const global RayState* rays, global RayState* next,
                  global int* next_count, global long* deposit, global long* flux, global long* tallies, global long* ground,
                  global int* ground_rays, global long* transmitted) {
  const int index = p.first_ray + get_global_id(0);
  if (index >= p.ray_count) return;
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  const global RayState* state = rays + index;
  Ray ray = ray_from(state);
  Colour power = colour_load(state->power);
  const float floor_power = state->floor_power;
  int bounces = state->bounces, steps = state->steps;
  const Colour none = colour_of(0.0f, 0.0f, 0.0f);
  Tally tally = {none, none, none, none, none, 0, 0};
  bool alive = true;

  if (state->entering) {
    const float eta_from = length(ray.v);
    const Cell cell = locate(ray.x);
    const float eta_to = eta_at(&medium, ray.region, cell);
    const float3 direction = ray.v / eta_from;
    if (!index_matched(&medium, 0, ray.region, eta_from, eta_to)) {
      const Interface surface = meet_interface(direction, vload3(0, state->normal), eta_from, eta_to);
      tally.reflected = surface.reflectance * power;
      power -= tally.reflected;
      ray.v = eta_to * surface.refracted;
      alive = surface.reflectance < 1.0f;
    } else {
      ray.v = eta_to * direction;
    }
  }

  bool split = false;
  for (int i = 0; alive && !split && i < p.batch_steps; ++i) {
    if (steps >= p.max_steps) {
      tally.in_flight += power;
      alive = false;
      break;
    }
    ++steps;
    const int region = ray.region;
    const float3 from = ray.x;
    const Step step = advance(&medium, &ray, p.step);
    if (p.ground && region == 0 && from.y > p.ground_height && ray.x.y <= p.ground_height) {
      // The ground cuts through the domain: what reaches it counts as escaped downwards.
      add_power(tallies + 3 * (TURBID_TALLY_ESCAPED + 2), power, p.fixed_per_watt);
      collect(ground, ground_rays, transmitted, &p, state->texel, from, normalize(ray.x - from), power);
      alive = false;
      break;
    }
    if (medium.regions[region].attenuates) {
      const Extinction sigma = extinction_at(&medium, region, locate(step.middle));
      const Colour loss = power * -expm1(-(sigma.sigma_s + sigma.sigma_a) * step.length);
      power -= loss;
      lose(&medium, &tally, deposit, flux, p.flux_stride, region, from, ray.x, loss, sigma, p.fixed_per_watt);
      if (colour_max(power) < floor_power) {
        // Too weak to follow: what is left ends here as if the medium went on.
        const Colour sigma_t = sigma.sigma_s + sigma.sigma_a;
        const Colour ended = sigma_t > 0.0f ? power : none;
        tally.in_flight += power - ended;
        lose(&medium, &tally, deposit, flux, p.flux_stride, region, from, ray.x, ended, sigma, p.fixed_per_watt);
        alive = false;
        break;
      }
    }
    if (step.event == EVENT_FACE) {
      const int axis = step.face >> 1;
      const int kind = p.faces[step.face];
      if (kind == TURBID_FACE_MIRROR) {
        if (axis == 0) ray.v.x = -ray.v.x;
        if (axis == 1) ray.v.y = -ray.v.y;
        if (axis == 2) ray.v.z = -ray.v.z;
      } else if (kind == TURBID_FACE_PERIODIC) {
        const float other = (step.face & 1) ? 0.0f : 1.0f;
        if (axis == 0) ray.x.x = other * TURBID_VOXELS_X;
        if (axis == 1) ray.x.y = other * TURBID_VOXELS_Y;
        if (axis == 2) ray.x.z = other * TURBID_VOXELS_Z;
        ray.region = region_at(&medium, locate(ray.x));
      } else {
        add_power(tallies + 3 * (TURBID_TALLY_ESCAPED + step.face), power, p.fixed_per_watt);
        collect(ground, ground_rays, transmitted, &p, state->texel, ray.x, normalize(ray.v), power);
        alive = false;
      }
    } else if (step.event == EVENT_SURFACE) {
      const int next_region = step.next_region;
      if (medium.regions[next_region].opaque) {
        tally.opaque_surface += power;
        alive = false;
        break;
      }
      const float eta_from = length(ray.v);
      const float eta_to = eta_at(&medium, next_region, locate(step.beyond));
      const bool no_interface =
          index_matched(&medium, region, next_region, eta_from, eta_to);
      if (no_interface) {
        ray.x = step.beyond;
        ray.region = next_region;
        continue;
      }
      if (++bounces > p.max_bounces) {
        tally.in_flight += power;
        alive = false;
        break;
      }
      ++tally.interfaces;
      const float3 normal = surface_normal(&medium, step.surface, step.beyond);
      const Interface surface = meet_interface(ray.v / eta_from, normal, eta_from, eta_to);
      Ray reflected = ray, refracted = ray;
      reflected.v = eta_from * surface.reflected;
      refracted.v = eta_to * surface.refracted;
      refracted.x = step.beyond;
      refracted.region = next_region;
      reflected.grace = refracted.grace = GRACE;
      // The stronger branch goes on here, the weaker one is stored as a ray of its own.
      const bool keep_reflected = surface.reflectance > 0.5f;
      const Colour reflected_power = surface.reflectance * power;
      const Colour refracted_power = power - reflected_power;
      const Colour side_power = keep_reflected ? refracted_power : reflected_power;
      const Ray side = keep_reflected ? refracted : reflected;
      ray = keep_reflected ? reflected : refracted;
      power = keep_reflected ? reflected_power : refracted_power;
      if (colour_max(side_power) >= floor_power) {
        store_ray(next + atomic_inc(next_count), &side, side_power, state, bounces, steps);
        split = true;
      } else {
        tally.in_flight += side_power;
      }
    }
  }
  if (alive) store_ray(next + atomic_inc(next_count), &ray, power, state, bounces, steps);
  global long* work = tallies + 3 * TURBID_TALLY_WORK;
  atom_add((volatile global long*)work, (long)(steps - state->steps));
  if (tally.deposits) atom_add((volatile global long*)work + 1, (long)tally.deposits);
  if (tally.interfaces) atom_add((volatile global long*)work + 2, (long)tally.interfaces);
  add_power(tallies + 3 * TURBID_TALLY_ABSORBED, tally.absorbed, p.fixed_per_watt);
  add_power(tallies + 3 * TURBID_TALLY_DEPOSITED, tally.deposited, p.fixed_per_watt);
  add_power(tallies + 3 * TURBID_TALLY_REFLECTED, tally.reflected, p.fixed_per_watt);
  add_power(tallies + 3 * TURBID_TALLY_OPAQUE, tally.opaque_surface, p.fixed_per_watt);
  add_power(tallies + 3 * TURBID_TALLY_IN_FLIGHT, tally.in_flight, p.fixed_per_watt);
}
