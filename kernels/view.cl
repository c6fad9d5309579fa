// SPDX-License-Identifier: Apache-2.0
// View pass (Bernabei et al. III-D): camera samples enter the media where they were rasterised, bend, and gather what the
// fluence scatters towards the camera. In: samples, source tiles. Out: radiance [W/(unit^2 sr)] of surfaces and of media.
//
// Along a path radiance / eta^2 is invariant but for extinction and sources (numerics section 7):
//     L_obs = eta_obs^2 * integral of Tr j / eta^2 ds,    j = (sigma_s fluence + deposit + emission) / (4 pi)
// with the source constant over a step ds:  Tr j (1 - exp(-sigma_t ds)) / sigma_t.
#include "lib/surroundings.h"
#include "lib/trace.h"

#define STACK 16

typedef struct {
  Ray ray;
  Colour weight;  // Tr, Fresnel factors and eta_obs^2, of radiance / eta^2
} Branch;

#if TURBID_CHANNELS == 3
static float3 colour_rgb(Colour c, const ViewParams* p) { return c.xyz; }
#else
static float3 colour_rgb(Colour c, const ViewParams* p) { return (float3)(c); }
#endif

// Source of radiance 4 pi j at a point of a region [W/unit^2 per voxel].
static Colour source_at(const Medium* medium, const global float* source_tiles, int region, Cell cell) {
#if TURBID_SCATTERING
  const int set = medium->regions[region].source_set;
  const int tile = set >= 0 ? tile_of(medium, set, cell.block) : -1;
  if (tile >= 0) {
#if TURBID_CHANNELS == 3
    return interpolate4(source_tiles, tile, cell);
#else
    const global float* at = source_tiles + (size_t)tile * TURBID_TILE_NODES + cell.node;
    const float2 a = vload2(0, at), b = vload2(0, at + TURBID_TILE_EDGE);
    const float2 c = vload2(0, at + TURBID_TILE_EDGE * TURBID_TILE_EDGE);
    const float2 d = vload2(0, at + TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1));
    const float2 row = mix(mix(a, b, cell.fraction.y), mix(c, d, cell.fraction.y), cell.fraction.z);
    return mix(row.x, row.y, cell.fraction.x);
#endif
  }
#endif
  return colour_of(0.0f, 0.0f, 0.0f);
}

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

// Splits a branch at an interface: the stronger part goes on as *branch, the weaker one is stacked while there is room.
static void split(Branch* branch, Branch* stack, int* stacked, float3 normal, float eta_from, float eta_to, int next_region,
                  float3 beyond, float grace, float min_weight, int room) {
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
  *branch = keep_reflected ? reflected : refracted;
  if (*stacked < room && colour_max(weaker.weight) >= min_weight) stack[(*stacked)++] = weaker;
}

kernel void view(MEDIUM_ARGUMENTS, ViewParams p, const global ViewSample* samples, const global float* source_tiles,
                 const global LightParams* lights, const global float* shadow_depths, const global float* transmittance,
                 const global float* ground_map, global float* radiance) {
  const int index = get_global_id(0);
  if (index >= p.sample_count) return;
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  const Surroundings around = {lights, shadow_depths, transmittance, ground_map};
  const global ViewSample* sample = samples + index;
  const float3 start = vload3(0, sample->position);
  const float3 direction = vload3(0, sample->direction);
  float3 surfaces = (float3)(0.0f);
  Colour gathered = colour_of(0.0f, 0.0f, 0.0f);
  Branch stack[STACK];
  int stacked = 0, met = 0;
  const float eta_observer = medium.regions[0].eta;

  if (sample->region < 0) {
    surfaces = surroundings_radiance(&around, &p, start, direction);
  } else if (medium.regions[sample->region].opaque) {
    surfaces = opaque_radiance(&medium, &around, &p, sample->region, start, vload3(0, sample->normal));
  } else {
    Branch first;
    first.ray.x = start;
    first.ray.region = sample->region;
    first.ray.grace = 1.5f;
    first.weight = colour_of(1.0f, 1.0f, 1.0f) * (eta_observer * eta_observer);
    const float eta = eta_at(&medium, sample->region, locate(start));
    first.ray.v = direction * eta;
    if (sample->entering && !index_matched(&medium, 0, sample->region, eta_observer, eta)) {
      first.ray.region = 0;
      first.ray.v = direction * eta_observer;
      split(&first, stack, &stacked, vload3(0, sample->normal), eta_observer, eta, sample->region, start, 1.5f,
            p.min_weight, STACK);
    }
    stack[stacked++] = first;
  }

  int steps = 0;
  while (stacked > 0) {
    Branch branch = stack[--stacked];
    while (steps < p.max_steps) {
      ++steps;
      const int region = branch.ray.region;
      const float3 from = branch.ray.x;
      const Step step = advance(&medium, &branch.ray, p.step);
      const float3 heading = (branch.ray.x - from) / fmax(step.length, 1e-9f);
      if (region == 0 && p.ground) {
        const float t = distance_to_ground(&p, from, heading);
        if (t <= step.length) {
          surfaces += colour_rgb(branch.weight, &p) / (eta_observer * eta_observer) *
                      ground_radiance(&around, &p, from + t * heading, heading);
          break;
        }
      }
      const Cell middle = locate(step.middle);
      if (medium.regions[region].source_set >= 0 || medium.regions[region].attenuates) {
        const Extinction sigma = extinction_at(&medium, region, middle);
        const Colour sigma_t = sigma.sigma_s + sigma.sigma_a;
        const Colour depth = sigma_t * step.length;
        const Colour source = source_at(&medium, source_tiles, region, middle);
        const float eta = eta_at(&medium, region, middle);
        const Colour lost = -expm1(-depth);
        const Colour path = depth > 1e-4f ? lost / fmax(sigma_t, 1e-20f) : step.length * (1.0f - 0.5f * depth);
        gathered += branch.weight * source * path * (0.25f * M_1_PI_F / (eta * eta));
        branch.weight *= 1.0f - lost;
        if (colour_max(branch.weight) < p.min_weight) break;
      }
      if (step.event == EVENT_FACE) {
        surfaces += colour_rgb(branch.weight, &p) / (eta_observer * eta_observer) *
                    surroundings_radiance(&around, &p, branch.ray.x, normalize(branch.ray.v));
        break;
      }
      if (step.event == EVENT_SURFACE) {
        const int next_region = step.next_region;
        if (medium.regions[next_region].opaque) {
          const float3 normal = surface_normal(&medium, step.surface, step.beyond);
          surfaces += colour_rgb(branch.weight, &p) / (eta_observer * eta_observer) *
                      opaque_radiance(&medium, &around, &p, next_region, branch.ray.x, normal);
          break;
        }
        const float eta_from = length(branch.ray.v);
        const float eta_to = eta_at(&medium, next_region, locate(step.beyond));
        if (index_matched(&medium, region, next_region, eta_from, eta_to)) {
          branch.ray.x = step.beyond;
          branch.ray.region = next_region;
          continue;
        }
        if (++met > 8 * p.max_branches) break;
        const float3 normal = surface_normal(&medium, step.surface, step.beyond);
        split(&branch, stack, &stacked, normal, eta_from, eta_to, next_region, step.beyond, GRACE, p.min_weight,
              met <= p.max_branches ? STACK : 0);
        if (colour_max(branch.weight) < p.min_weight) break;
      }
    }
  }
  vstore3(surfaces, 0, radiance + 8 * index);
  radiance[8 * index + 3] = (float)steps;  // for profiles
  const float3 media = colour_rgb(gathered, &p) * (TURBID_CHANNELS == 3 ? (float3)(1.0f) : vload3(0, p.tint));
  vstore3(media, 0, radiance + 8 * index + 4);
}
