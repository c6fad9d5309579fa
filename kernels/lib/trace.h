// SPDX-License-Identifier: Apache-2.0
// One step of a ray through the medium: straight where the index is constant, drift-kick-drift where it is graded, cut short
// at the domain's faces and at the zero crossing of a body's signed distance. `advance` does any step of one ray; packet.h has the
// many steps on which nothing can happen, for several rays at a fraction of the cost.
//
// Ray equation in the parameter tau, dtau = ds / eta:              [Ihrke et al. 2007; Sharma et al. 1982]
//     dx/dtau = v,   dv/dtau = grad(eta^2 / 2),   |v| = eta(x)
// Half a drift, the kick, half a drift: second order and symplectic for a constant dtau, like kick-drift-kick, but force,
// coefficients and source are all sampled at one point, the middle of the step.
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

// Arc length [voxels] after an interface in which the ray may stand on the wrong side of the sampled surface: a grazing ray
// stays within the sampling's ripples for a while and would meet the same surface many times over.
#define GRACE 0.5f
// As deep as that [voxels] the ripples reach: 1/(6 R) on average on a ball of radius R voxels. A ray that comes farther out
// has met another face of the body, near an edge or behind a thin sheet.
#define RIPPLE 0.1f

#define EVENT_NONE 0      // the whole step was done
#define EVENT_SURFACE 1   // the ray stands just before another region's surface
#define EVENT_FACE 2      // the ray stands on a face of the domain

typedef struct {
  int event;
  float length;       // arc length done [voxels]
  float3 middle;      // point half way
  float eta_squared;  // there
  float room;         // as far as this around the end point, within its block, no surface is met [voxels]
  int next_region;    // EVENT_SURFACE: the region beyond
  int surface;        // EVENT_SURFACE: the body whose surface it is
  float3 beyond;      // EVENT_SURFACE: a point just beyond the surface
  float3 normal;      // EVENT_SURFACE: of the surface there, see surface_normal
  int face;           // EVENT_FACE: 0..5 for -x, +x, -y, +y, -z, +z
} Step;

// Fraction of the segment from `from` to `to` after which it leaves [0, n] along one axis, or 1.
static float fraction_inside(float from, float to, float size) {
  if (to < 0.0f) return from <= 0.0f ? 0.0f : from / (from - to);
  if (to > size) return from >= size ? 0.0f : (size - from) / (to - from);
  return 1.0f;
}

// How far along the unit direction a ray stays in the blocks of cells that are all `region`'s, or within its own block where
// more regions meet; and a hundredth of a voxel more. `alone`: its own block is all the region's.
static float distance_in_blocks(const Medium* medium, int region, float3 x, float3 direction, bool* alone) {
  const float3 y = (x - 0.5f) * 0.125f, last = (float3)(BLOCKS_X - 1, BLOCKS_Y - 1, BLOCKS_Z - 1);
  const float3 block = clamp(floor(y), (float3)(0.0f), last);
  // To the next face of a block and from face to face, along each axis.
  const float3 along = fabs(direction) > 1e-6f ? direction : (float3)(1e-6f);
  const float3 inverse = 8.0f / along, between = fabs(inverse);
  const bool up_x = along.x > 0.0f, up_y = along.y > 0.0f, up_z = along.z > 0.0f;
  const float3 face = block + (float3)(up_x ? 1.0f : 0.0f, up_y ? 1.0f : 0.0f, up_z ? 1.0f : 0.0f);
  float3 next = (face - y) * inverse;
  int left_x = (int)(up_x ? last.x - block.x : block.x), left_y = (int)(up_y ? last.y - block.y : block.y),
      left_z = (int)(up_z ? last.z - block.z : block.z);
  int at = (int)block.x + BLOCKS_X * ((int)block.y + BLOCKS_Y * (int)block.z);
  *alone = medium->block_region[at] == region;
  float end = fmin(next.x, fmin(next.y, next.z));
  while (*alone) {
    if (next.x == end) {
      if (left_x-- == 0) break;
      at += up_x ? 1 : -1;
      next.x += between.x;
    } else if (next.y == end) {
      if (left_y-- == 0) break;
      at += up_y ? BLOCKS_X : -BLOCKS_X;
      next.y += between.y;
    } else {
      if (left_z-- == 0) break;
      at += up_z ? BLOCKS_X * BLOCKS_Y : -BLOCKS_X * BLOCKS_Y;
      next.z += between.z;
    }
    if (medium->block_region[at] != region) break;
    end = fmin(next.x, fmin(next.y, next.z));
  }
  return fmax(end, 0.0f) + 0.01f;
}

// Below this square of its length the interpolated gradient averages over an edge of the body.
#define SMOOTH_GRADIENT 0.9f

// Unit normal of a body's surface, outward. Central differences of the distance have length 1 and are second order where the
// surface is smooth; within a voxel and a half of an edge they turn away from the flat face that the rays meet, by up to 45
// degrees, and light that enters and light that leaves no longer balance. There the gradient of the interpolant itself holds:
// its zero crossing is that very face.
static float3 surface_normal(const Medium* medium, int body, float3 x) {
  const Cell cell = locate(x);
  float3 gradient = surface_at(medium, body, cell).xyz;
  if (dot(gradient, gradient) < SMOOTH_GRADIENT) {
    const int tile = tile_of(medium, medium->regions[body].distance_set, cell.block);
    if (tile >= 0) gradient = slope4(medium->distance_tiles, tile, cell);
  }
  return gradient * rsqrt(fmax(dot(gradient, gradient), 1e-12f));
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
  const Cell cell_low = locate(a + low * (b - a)), cell_high = locate(a + high * (b - a));
  float d_low = surface_at(medium, step->surface, cell_low).w;
  float d_high = surface_at(medium, step->surface, cell_high).w;
  const int other = min(region, next);
  if ((d_low < 0.0f) == (d_high < 0.0f) && other > 0) {
    // The gap between bodies that touch: it ends at the earlier one's surface.
    step->surface = other;
    d_low = surface_at(medium, other, cell_low).w;
    d_high = surface_at(medium, other, cell_high).w;
  }
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

// How far a point lies on the other side of the surface between two regions [voxels].
static float depth_beyond(const Medium* medium, int region, int next, float3 x) {
  const float outside = surface_at(medium, max(region, next), locate(x)).w;
  return region > next ? outside : -outside;
}

// What the segment from `from` to `*to` meets: `*to` is moved to a face of the domain or just before another region's surface.
static void meet(const Medium* medium, Step* step, int region, float grace, float3 from, float3* to) {
  const float fx = fraction_inside(from.x, to->x, (float)TURBID_VOXELS_X);
  const float fy = fraction_inside(from.y, to->y, (float)TURBID_VOXELS_Y);
  const float fz = fraction_inside(from.z, to->z, (float)TURBID_VOXELS_Z);
  const float inside = fmin(fx, fmin(fy, fz));
  if (inside < 1.0f) {
    step->event = EVENT_FACE;
    if (fx <= fy && fx <= fz) step->face = to->x > from.x ? 1 : 0;
    else if (fy <= fz) step->face = to->y > from.y ? 3 : 2;
    else step->face = to->z > from.z ? 5 : 4;
    *to = from + inside * (*to - from);
  }
  step->room = 1e9f;
#if TURBID_BODIES > 0
  const int there = region_with_room(medium, locate(*to), &step->room);
  if (there == region) return;
  step->room = 0.0f;
  // A ray that starts on the rasterised surface may find itself a little on the wrong side of the sampled one, which is
  // coarser: it keeps its region while it gets clear.
  if (grace > 0.0f && step->event == EVENT_NONE &&
      depth_beyond(medium, region, there, *to) < fmax(depth_beyond(medium, region, there, from), RIPPLE))
    return;
  step->next_region = there;
  float3 before;
  find_crossing(medium, step, region, from, *to, &before);
  // At a kink of the sampled surface the ray may find itself outside while it heads inwards: it goes on, for reflected by
  // that normal it would come back to where it is, for ever.
  step->normal = surface_normal(medium, step->surface, step->beyond);
  const float outwards = dot(*to - from, step->normal);
  if (step->surface == region ? outwards < 0.0f : outwards > 0.0f) return;
  step->event = EVENT_SURFACE;
  *to = before;
#endif
}

// Advances the ray by at most `step_size` of arc, or through clear media to the next surface or face, and says what stopped it.
// `room`: as far as this the ray surely meets no surface in its block [voxels]; 0 where nothing is known.
static Step advance(const Medium* medium, Ray* ray, float step_size, float room) {
  Step step;
  step.event = EVENT_NONE;
  step.next_region = ray->region;
  step.surface = ray->region;
  step.face = 0;
  step.room = room;
  const float3 from = ray->x;
  const global RegionParams* region = medium->regions + ray->region;
  float3 to, v = ray->v;
  bool graded = false;
#if TURBID_GRADED
  const float dtau = step_size * region->tau_per_arc;
  if (region->index_set >= 0) {
    const Cell cell = locate(from + 0.5f * dtau * v);
    const int tile = tile_of(medium, region->index_set, cell.block);
    if (tile >= 0) {
      graded = true;
      v += dtau * INDEX_UNIT * interpolate4(medium->index_tiles, tile, cell).xyz;
      to = from + 0.5f * dtau * (ray->v + v);
      const float3 target = to;
      meet(medium, &step, ray->region, ray->grace, from, &to);
      float done = dtau;
      if (step.event != EVENT_NONE) {
        // The velocity follows the part of the step that was done.
        done *= distance(from, to) / fmax(distance(from, target), 1e-12f);
        v = ray->v + done * index_at(medium, ray->region, locate(from + 0.5f * done * ray->v)).xyz;
      }
      step.middle = from + 0.5f * done * ray->v;
    }
  }
#endif
  if (!graded) {
    const float3 direction = v * rsqrt(dot(v, v));
    // Constant coefficients and nothing to gather: one exact segment, until the index changes.
    const bool exact = region->source_set < 0 && region->coefficient_set < 0, straight = exact && region->index_set < 0;
    float done = 0.0f;
    to = from;
    do {
      const float3 start = to;
      float length = step_size;
      if (exact) {
        bool alone;
        const float end = distance_in_blocks(medium, ray->region, start, direction, &alone);
        length = fmax(length, alone ? end : fmin(step.room, end));
      }
      to = start + length * direction;
      meet(medium, &step, ray->region, ray->grace - done, start, &to);
      done += distance(start, to);
    } while (straight && step.event == EVENT_NONE);
    step.middle = 0.5f * (from + to);
  }
  step.length = distance(from, to);
  const float3 mean = 0.5f * (ray->v + v);
  step.eta_squared = dot(mean, mean);
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

#endif
