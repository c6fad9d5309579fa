// SPDX-License-Identifier: Apache-2.0
// One step of a ray through the medium: straight where the index is constant, kick-drift-kick where it is graded, cut short
// at the domain's faces and at the zero crossing of a body's signed distance.
//
// Ray equation in the parameter tau, dtau = ds / eta:              [Ihrke et al. 2007; Sharma et al. 1982]
//     dx/dtau = v,   dv/dtau = grad(eta^2 / 2),   |v| = eta(x)
#ifndef TURBID_LIB_TRACE_H
#define TURBID_LIB_TRACE_H
#include "lib/interface.h"
#include "lib/medium.h"

typedef struct {
  float3 x;      // [voxels]
  float3 v;      // |v| = eta
  int region;
  float grace;   // see RayState
} Ray;

// Arc length [voxels] after an interface in which the sampled surface is not looked at again: a grazing ray stays within the
// sampling's ripples for a while and would meet the same surface many times over.
#define GRACE 0.5f

#define EVENT_NONE 0      // the whole step was done
#define EVENT_SURFACE 1   // the ray stands just before another region's surface
#define EVENT_FACE 2      // the ray stands on a face of the domain

typedef struct {
  int event;
  float length;       // arc length done [voxels]
  float3 middle;      // point half way
  int next_region;    // EVENT_SURFACE: the region beyond
  int surface;        // EVENT_SURFACE: the body whose surface it is
  float3 beyond;      // EVENT_SURFACE: a point just beyond the surface
  int face;           // EVENT_FACE: 0..5 for -x, +x, -y, +y, -z, +z
} Step;

// Fraction of the segment from `from` to `to` after which it leaves [0, n] along one axis, or 1.
static float fraction_inside(float from, float to, float size) {
  if (to < 0.0f) return from <= 0.0f ? 0.0f : from / (from - to);
  if (to > size) return from >= size ? 0.0f : (size - from) / (to - from);
  return 1.0f;
}

// Distance along the unit direction to where the ray leaves its block of cells; at least a hundredth of a voxel.
static float distance_to_block_end(float3 x, float3 direction) {
  const float3 y = x - 0.5f;
  const float3 block = clamp(floor(y * 0.125f), (float3)(0.0f), (float3)(BLOCKS_X - 1, BLOCKS_Y - 1, BLOCKS_Z - 1));
  float result = 1e9f;
  const float position[3] = {x.x, x.y, x.z};
  const float along[3] = {direction.x, direction.y, direction.z};
  const float lower[3] = {8.0f * block.x + 0.5f, 8.0f * block.y + 0.5f, 8.0f * block.z + 0.5f};
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] > 1e-6f) result = fmin(result, (lower[axis] + 8.0f - position[axis]) / along[axis]);
    if (along[axis] < -1e-6f) result = fmin(result, (lower[axis] - position[axis]) / along[axis]);
  }
  return fmax(result, 0.0f) + 0.01f;
}

// Narrows the first change of region on the segment a-b down to 2^-6 of it, then takes the zero of the signed distance by
// the secant: `before` stays in `region`, `beyond` is in the next one.
static void find_crossing(const Medium* medium, Step* step, int region, float3 a, float3 b, float3* before) {
  float low = 0.0f, high = 1.0f;
  int next = step->next_region;
  for (int i = 0; i < 6; ++i) {
    const float middle = 0.5f * (low + high);
    const int there = region_at(medium, locate(a + middle * (b - a)));
    if (there == region) {
      low = middle;
    } else {
      high = middle;
      next = there;
    }
  }
  step->next_region = next;
  step->surface = max(region, next);
  const float d_low = surface_at(medium, step->surface, locate(a + low * (b - a))).w;
  const float d_high = surface_at(medium, step->surface, locate(a + high * (b - a))).w;
  const float length = fmax(distance(a, b), 1e-6f);
  if ((d_low < 0.0f) != (d_high < 0.0f)) {
    const float zero = low + (high - low) * d_low / (d_low - d_high);
    const float guard = 1e-3f / length;  // a thousandth of a voxel on either side
    low = fmax(low, zero - guard);
    high = fmin(high, zero + guard);
  }
  *before = a + low * (b - a);
  step->beyond = a + high * (b - a);
}

// Advances the ray by at most `step_size` of arc (farther where nothing can happen on the way) and says what stopped it.
static Step advance(const Medium* medium, Ray* ray, float step_size) {
  Step step;
  step.event = EVENT_NONE;
  step.next_region = ray->region;
  step.surface = ray->region;
  step.face = 0;
  const float3 from = ray->x;
  const Cell cell = locate(from);
  float3 to;
  float3 v = ray->v;
  bool graded = false;
#if TURBID_GRADED
  const int index_set = medium->regions[ray->region].index_set;
  graded = index_set >= 0 && tile_of(medium, index_set, cell.block) >= 0;
  float dtau = 0.0f;
  if (graded) {
    // Kick, drift, kick: second order and symplectic for a constant dtau; the arc length of a step follows eta.
    const float4 u = index_at(medium, ray->region, cell);
    dtau = step_size * medium->regions[ray->region].tau_per_arc;
    v += 0.5f * dtau * u.xyz;
    to = from + dtau * v;
  } else
#endif
  {
    const float3 direction = v * rsqrt(dot(v, v));
    float length = step_size;
    const global RegionParams* region = medium->regions + ray->region;
    if (medium->block_region[cell.block] == ray->region && region->source_set < 0 && region->coefficient_set < 0) {
      length = fmax(length, distance_to_block_end(from, direction));
    }
    to = from + length * direction;
  }
  // The domain's faces.
  float inside = 1.0f;
  {
    const float fx = fraction_inside(from.x, to.x, (float)TURBID_VOXELS_X);
    const float fy = fraction_inside(from.y, to.y, (float)TURBID_VOXELS_Y);
    const float fz = fraction_inside(from.z, to.z, (float)TURBID_VOXELS_Z);
    inside = fmin(fx, fmin(fy, fz));
    if (inside < 1.0f) {
      step.event = EVENT_FACE;
      if (fx <= fy && fx <= fz) step.face = to.x > from.x ? 1 : 0;
      else if (fy <= fz) step.face = to.y > from.y ? 3 : 2;
      else step.face = to.z > from.z ? 5 : 4;
      to = from + inside * (to - from);
    }
  }
  // Another region's surface on the way?
#if TURBID_BODIES > 0
  const int there = region_at(medium, locate(to));
  if (there != ray->region) {
    // A ray that starts on the rasterised surface may find itself a little on the wrong side of the sampled one, which is
    // coarser: it keeps its region while it gets clear.
    const bool getting_clear = ray->grace > 0.0f && step.event == EVENT_NONE;
    if (!getting_clear) {
      step.event = EVENT_SURFACE;
      step.next_region = there;
      const float3 end = to;
      find_crossing(medium, &step, ray->region, from, end, &to);
    }
  }
#endif
#if TURBID_GRADED
  if (graded) {
    // The closing kick; after a shortened step the velocity follows the part that was done.
    const float done = length(to - from) / fmax(length(v) * dtau, 1e-12f);
    const float4 u = index_at(medium, ray->region, locate(to));
    v = ray->v + (v - ray->v) * done + 0.5f * dtau * done * u.xyz;
  }
#endif
  step.length = distance(from, to);
  step.middle = 0.5f * (from + to);
  ray->x = to;
  ray->v = v;
  ray->grace -= step.length;
  return step;
}

// No reflection between two regions: their blurred indices join, or the indices agree to what sampling can tell (a graded index
// is interpolated from voxels: its value at a surface is uncertain by about 1e-3, which grazing rays would take for a mirror).
static bool index_matched(const Medium* medium, int a, int b, float eta_a, float eta_b) {
  if (medium->regions[a].smooth_group && medium->regions[b].smooth_group) return true;
  const bool graded = medium->regions[a].index_set >= 0 || medium->regions[b].index_set >= 0;
  return fabs(eta_a - eta_b) <= (graded ? 3e-3f : 1e-6f);
}

// Unit normal of a body's surface, outward.
static float3 surface_normal(const Medium* medium, int body, float3 x) {
  const float3 gradient = surface_at(medium, body, locate(x)).xyz;
  return gradient * rsqrt(fmax(dot(gradient, gradient), 1e-12f));
}

#endif
