// SPDX-License-Identifier: Apache-2.0
// Where photons begin: sources are picked by their cumulative powers, stratified over the photons of a batch; points, pencils,
// cones, Lambert emitters, emitting voxels, and rays that enter through a surface.
#include "lib/phase.h"
#include "lib/photon_state.h"

// The source that holds a point of the cumulative powers.
static int pick_source(const global ulong* cumulative, int count, ulong u) {
  int low = 0, high = count - 1;
  while (low < high) {
    const int middle = (low + high) >> 1;
    if (u < cumulative[middle]) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return low;
}

static float3 any_direction(uint4 bits) { return turned((float3)(0.0f, 0.0f, 1.0f), 1.0f - 2.0f * uniform(bits.x), uniform(bits.y)); }

// Starts photon number `index` of the launch; false if it ends where it enters.
static bool start(Photon* photon, const Medium* medium, const PhotonParams* p, const global PhotonSource* sources,
                  const global ulong* cumulative, uint index, Pending* pending) {
  const ulong number = ((ulong)p->first_photon[1] << 32 | p->first_photon[0]) + index;
  photon->random.counter = (uint4)((uint)number, (uint)(number >> 32), 0, p->channel);
  photon->random.key = (uint2)(p->seed[0], p->seed[1]);
  const uint4 bits = draw(&photon->random);
  const ulong stratum = (ulong)p->stratum[1] << 32 | p->stratum[0];
  const ulong u = (p->first_in_batch + index) * stratum + mul_hi((ulong)bits.x << 32 | bits.y, stratum);
  const global PhotonSource* source = sources + pick_source(cumulative + (size_t)p->channel * p->source_count, p->source_count, u);
  photon->optical_depth = exponential(bits.z);
  photon->weight = 1.0f;
  photon->held = (long)p->unit;
  photon->unscattered = true;
  photon->from_lamp = source->kind != TURBID_SOURCE_VOXEL;
  photon->steps = 0;
  Ray* ray = &photon->ray;
  ray->x = vload3(0, source->position);
  ray->region = source->region;
  ray->grace = source->grace;
  float3 direction = vload3(0, source->direction);
  if (source->kind == TURBID_SOURCE_VOXEL) {
    const float3 lower = ray->x;
    ray->x = lower + vload3(0, source->normal);
    // A few tries find the voxel's part in its region, but for slivers, which have a point of theirs.
    for (int i = 0; i < 64; ++i) {
      const uint4 place = draw(&photon->random);
      const float3 x = lower + (float3)(uniform(place.x), uniform(place.y), uniform(place.z));
      if (region_at(medium, locate(x)) == ray->region) {
        ray->x = x;
        break;
      }
    }
    direction = any_direction(draw(&photon->random));
  } else if (source->kind == TURBID_SOURCE_CONE) {
    const uint4 aim = draw(&photon->random);
    direction = turned(direction, 1.0f - (1.0f - source->cos_half_angle) * uniform(aim.x), uniform(aim.y));
  } else if (source->kind == TURBID_SOURCE_LAMBERT) {
    const uint4 aim = draw(&photon->random);
    direction = turned(direction, sqrt(uniform(aim.x)), uniform(aim.y));
  }
  const float eta = eta_at(medium, ray->region, locate(ray->x));
  if (source->kind == TURBID_SOURCE_ENTERING) {
    const float eta_from = medium->regions[0].eta;
    if (!index_matched(medium, 0, ray->region, eta_from, eta)) {
      const Interface surface = meet_interface(direction, vload3(0, source->normal), eta_from, eta);
      pending->reflected += reweigh(photon, 1.0f - surface.reflectance, p->unit);
      if (surface.reflectance >= 1.0f) return false;
      direction = surface.refracted;
    }
  }
  ray->v = eta * direction;
  return true;
}
