// SPDX-License-Identifier: Apache-2.0
// Monte Carlo transport, the ground truth: photons of one colour go through the same medium as the marched rays and scatter
// until they escape or are too weak; nothing is diffusive.
// In: sources with their cumulative powers. Out: fixed-point sums of the track-length estimate of the fluence and of where the
// photons' weight ended. Integer sums: the order in which photons run changes no bit.
//
// Between two points of a straight or bent path:
//   constant coefficients: the distance to the next scattering is exponential with sigma_s, absorption is a continuous decay
//     w' = w exp(-sigma_a l), which tallies the fluence w (1 - exp(-sigma_a l)) / sigma_a: exact for any step length l;
//   varying coefficients: delta tracking (Woodcock et al. 1965) with a majorant M >= sigma_s + sigma_a per block: tentative
//     collisions at the rate M; each takes the share sigma_a / M of the weight and scatters with probability
//     sigma_s / (M - sigma_a), else nothing happens; the fluence tally is w l. Unbiased for the interpolated coefficients.
// Steps end at voxel faces, so a segment counts in the one voxel that holds it. One colour at a time: simpler than spectral
// sampling, and every weight that started is found again exactly.
#include "lib/phase.h"
#include "lib/photon_source.h"
#include "lib/photon_state.h"

#if TURBID_CHANNELS != 1
#error "photon.cl follows one colour at a time: TURBID_CHANNELS must be 1"
#endif
#ifndef TURBID_ANISOTROPIC
#error "TURBID_ANISOTROPIC (1: some g differs from 0) must be defined"
#endif

// A photon below this weight survives with the probability given and is that much heavier then.
#define ROULETTE_WEIGHT 0.01f
#define ROULETTE_SURVIVAL 0.1f
// A voxel face nearer than this counts as passed [voxels]: a step that ended on a face does not meet it again.
#define PASSED 0.01f
// Beside the events of lib/trace.h: the photon has come down to the ground.
#define EVENT_GROUND 3

// Distance along the unit direction to the next voxel face.
static float distance_to_voxel_face(float3 x, float3 direction) {
  const float3 inverse = 1.0f / fmax(fabs(direction), 1e-6f);
  const float3 above = x - floor(x);
  const float3 t = select(above, 1.0f - above, direction > 0.0f) * inverse;
  const float3 next = t + select((float3)(0.0f), inverse, t < PASSED);
  return fmin(next.x, fmin(next.y, next.z));
}

// The active voxel of a region that holds a point, or -1.
static int voxel_at(const global int* block_index, const global short* owner, float3 x, int region) {
  const int ix = clamp((int)x.x, 0, TURBID_VOXELS_X - 1), iy = clamp((int)x.y, 0, TURBID_VOXELS_Y - 1),
            iz = clamp((int)x.z, 0, TURBID_VOXELS_Z - 1);
  const int block = block_index[(ix >> 3) + BLOCKS_X * ((iy >> 3) + BLOCKS_Y * (iz >> 3))];
  if (block < 0) return -1;
  const int at = 512 * block + (ix & 7) + 8 * ((iy & 7) + 8 * (iz & 7));
  return owner[at] == region ? at : -1;
}

static int voxel_block(float3 x) {
  const int ix = clamp((int)x.x >> 3, 0, BLOCKS_X - 1), iy = clamp((int)x.y >> 3, 0, BLOCKS_Y - 1),
            iz = clamp((int)x.z >> 3, 0, BLOCKS_Z - 1);
  return ix + BLOCKS_X * (iy + BLOCKS_Y * iz);
}

// Coefficients at a point of a region, per voxel edge.
typedef struct {
  float sigma_s, sigma_a, g;
} Coefficients;

static Coefficients coefficients_at(const Medium* medium, const global PhotonRegion* constants, const PhotonParams* p, int region,
                                    float3 x) {
  Coefficients result = {constants[region].sigma_s[p->channel], constants[region].sigma_a[p->channel], constants[region].g};
#if TURBID_HETEROGENEOUS
  const int set = medium->regions[region].coefficient_set;
  const Cell cell = locate(x);
  const int tile = set >= 0 ? tile_of(medium, set, cell.block) : -1;
  if (tile >= 0) {
    const float4 value = interpolate4(medium->coefficient_tiles, p->channel * p->coefficient_tiles + tile, cell);
    result.sigma_s = value.x;
    result.sigma_a = value.y;
    result.g = value.z;
  }
#endif
  return result;
}

static void scatter(Photon* photon, const Medium* medium, float g, uint4 bits) {
  const float speed_squared = dot(photon->ray.v, photon->ray.v);
  const float inverse = rsqrt(speed_squared);
  float eta = speed_squared * inverse;
#if TURBID_GRADED
  eta = eta_at(medium, photon->ray.region, locate(photon->ray.x));
#endif
#if TURBID_ANISOTROPIC
  const float cosine = sample_henyey_greenstein(g, uniform(bits.x));
#else
  const float cosine = 2.0f * uniform(bits.x) - 1.0f;  // the same bits as above with g = 0
#endif
  photon->ray.v = eta * turned(photon->ray.v * inverse, cosine, uniform(bits.y));
  photon->ray.grace = 0.0f;
  photon->unscattered = false;
}

// One step of the photon; false when it has ended.
static bool follow(Photon* photon, const Medium* medium, const PhotonParams* p, const global PhotonRegion* constants,
                   const global float* majorants, const global int* block_index, const global short* owner,
                   global long* voxel_sums, global long* tallies, global long* ground, global int* ground_rays,
                   Pending* pending) {
  if (++photon->steps > p->max_steps) {
    pending->in_flight += reweigh(photon, 0.0f, p->unit);
    return false;
  }
  Ray* ray = &photon->ray;
  const int region = ray->region;
  const float3 from = ray->x;
  const float3 heading = ray->v * rsqrt(dot(ray->v, ray->v));
  const bool attenuates = medium->regions[region].attenuates;
  float arc = distance_to_voxel_face(from, heading);
  float per_arc = 1.0f;  // step size that `advance` wants per arc length
#if TURBID_GRADED || TURBID_BODIES > 0
  const Cell cell = locate(from);
  if (medium->block_region[cell.block] != region) arc = fmin(arc, p->step);
#endif
#if TURBID_GRADED
  const int index_set = medium->regions[region].index_set;
  if (index_set >= 0 && tile_of(medium, index_set, cell.block) >= 0) {
    arc = fmin(arc, p->step);
    per_arc = 1.0f / (medium->regions[region].tau_per_arc * length(ray->v));
  }
#endif
  float rate = 0.0f;  // of collisions [1/voxel]
  bool varies = false, collides = false;
  if (attenuates) {
#if TURBID_HETEROGENEOUS
    const int set = constants[region].majorant_set;
    varies = set >= 0;
    // Of the block that holds the segment: a point a little ahead, since the photon may stand on the block's face.
    if (varies) rate = majorants[(p->channel * p->majorant_sets + set) * BLOCKS + voxel_block(from + PASSED * heading)];
#endif
    if (!varies) rate = constants[region].sigma_s[p->channel];
    if (photon->optical_depth < rate * arc) {
      arc = photon->optical_depth / rate;
      collides = true;
    }
  }
  Step step = advance(medium, ray, arc * per_arc, 0.0f);
  if (p->ground_size > 0 && region == 0 && from.y > p->ground_height && ray->x.y <= p->ground_height) {
    // The ground cuts through the domain: the path ends there.
    const float part = (from.y - p->ground_height) / (from.y - ray->x.y);
    step.length *= part;
    step.middle = from + 0.5f * part * (ray->x - from);
    step.event = EVENT_GROUND;
  }

  const bool first_flight = photon->unscattered && photon->from_lamp;
  const float sigma_a = attenuates && !varies ? constants[region].sigma_a[p->channel] : 0.0f;
  if (attenuates) {
    collides = collides && step.event == EVENT_NONE;
    photon->optical_depth = collides ? 0.0f : fmax(photon->optical_depth - rate * step.length, 0.0f);
    if (pending->absorbing_region != region) flush_absorbed(pending, tallies, region);
  }
  // One segment in one voxel; but where nothing scatters, `advance` goes on through a whole block.
  float3 middle = step.middle;
  float piece = step.length, done = 0.0f;
  const bool pieces = piece > 1.001f * arc + PASSED;
  do {
    if (pieces) {
      piece = fmin(distance_to_voxel_face(from + done * heading, heading), step.length - done);
      middle = from + (done + 0.5f * piece) * heading;
    }
    done += piece;
    float track = photon->weight * piece;
    if (sigma_a > 0.0f) {
      const float depth = sigma_a * piece;
      const float share = loss_over(depth);
      track = depth > 1e-3f ? photon->weight * share / sigma_a : track * (1.0f - depth * (0.5f - 0.16666667f * depth));
      pending->absorbed += reweigh(photon, photon->weight * (1.0f - share), p->unit);
    }
#if TURBID_SCATTERING
    count_track(pending, voxel_sums, p, voxel_at(block_index, owner, middle, region), first_flight, track);
#endif
  } while (pieces && done < step.length);
  if (attenuates) {
    if (collides) {
      const uint4 bits = draw(&photon->random);
      photon->optical_depth = exponential(bits.z);
      if (varies) {
        const Coefficients at = coefficients_at(medium, constants, p, region, ray->x);
        const float absorbed = fmin(at.sigma_a / rate, 1.0f);
        pending->absorbed += reweigh(photon, photon->weight * (1.0f - absorbed), p->unit);
        if (uniform(bits.w) * (rate - at.sigma_a) < at.sigma_s) scatter(photon, medium, at.g, bits);
      } else {
        scatter(photon, medium, constants[region].g, bits);
      }
    }
  }

  if (photon->weight < ROULETTE_WEIGHT) {
    if (photon->weight <= 0.0f || uniform(draw(&photon->random).x) >= ROULETTE_SURVIVAL) {
      pending->roulette += reweigh(photon, 0.0f, p->unit);
      return false;
    }
    pending->roulette += reweigh(photon, photon->weight / ROULETTE_SURVIVAL, p->unit);
  }

  if (step.event == EVENT_NONE) return true;
  int next_region = step.next_region;
  float3 beyond = step.beyond;
  const int axis = step.face >> 1;
  if (step.event == EVENT_GROUND) {
    escape(photon, p, tallies, ground, ground_rays, 2, from, ray->x - from);
    return false;
  }
  if (step.event == EVENT_FACE) {
    const int kind = p->faces[step.face];
    if (kind == TURBID_FACE_OPEN) {
      escape(photon, p, tallies, ground, ground_rays, step.face, ray->x, ray->v);
      return false;
    }
    if (kind == TURBID_FACE_MIRROR) {
      if (axis == 0) ray->v.x = -ray->v.x;
      if (axis == 1) ray->v.y = -ray->v.y;
      if (axis == 2) ray->v.z = -ray->v.z;
      return true;
    }
    const float other = (step.face & 1) ? 0.0f : 1.0f;
    beyond = ray->x;
    if (axis == 0) beyond.x = other * TURBID_VOXELS_X;
    if (axis == 1) beyond.y = other * TURBID_VOXELS_Y;
    if (axis == 2) beyond.z = other * TURBID_VOXELS_Z;
    next_region = region_at(medium, locate(beyond));
    if (next_region == region) {
      ray->x = beyond;
      return true;
    }
  }
  if (medium->regions[next_region].opaque) {
    pending->opaque_surface += reweigh(photon, 0.0f, p->unit);
    return false;
  }
  const float eta_from = length(ray->v);
  const float eta_to = eta_at(medium, next_region, locate(beyond));
  if (index_matched(medium, region, next_region, eta_from, eta_to)) {
    ray->x = beyond;
    ray->region = next_region;
    return true;
  }
  float3 normal = (float3)(axis == 0, axis == 1, axis == 2);  // bodies that differ across a periodic seam
  if (step.event == EVENT_SURFACE) normal = step.normal;
  const Interface surface = meet_interface(ray->v / eta_from, normal, eta_from, eta_to);
  if (uniform(draw(&photon->random).x) < surface.reflectance) {
    ray->v = eta_from * surface.reflected;
  } else {
    ray->v = eta_to * surface.refracted;
    ray->x = beyond;
    ray->region = next_region;
  }
  ray->grace = step.event == EVENT_SURFACE ? GRACE : 0.0f;
  return true;
}

// Each work-item follows every (global size)-th photon of the launch, one after the other in a single loop: items whose photon
// has ended do not wait for their neighbours.
kernel void photon(MEDIUM_ARGUMENTS, PhotonParams p, const global PhotonRegion* constants, const global PhotonSource* sources,
                   const global ulong* cumulative, const global float* majorants, const global int* block_index,
                   const global short* owner, global long* voxel_sums, global long* tallies, global long* ground,
                   global int* ground_rays) {
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  ground += (size_t)p.channel * p.ground_size * p.ground_size;
  Pending pending = {0, 0, 0, 0, 0, 0, -1, 0.0f};
  Photon photon;
  bool alive = false;
  uint next = get_global_id(0);
  for (;;) {
    if (!alive) {
      flush_track(&pending, voxel_sums, p.unit);  // photons never share a floating-point sum: its rounding would depend on order
      if (next >= (uint)p.photon_count) break;
      alive = start(&photon, &medium, &p, sources, cumulative, next, &pending);
      next += get_global_size(0);
    } else {
      alive = follow(&photon, &medium, &p, constants, majorants, block_index, owner, voxel_sums, tallies, ground, ground_rays,
                     &pending);
    }
  }
  flush(&pending, tallies, voxel_sums, p.unit);
}
