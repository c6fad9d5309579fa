// SPDX-License-Identifier: Apache-2.0
// A photon under way and what it still has to add to the sums: the track-length estimate of the fluence per voxel, and where
// its weight ended. Weights are fixed-point, losses telescope: every unit that started is found again exactly.
#include "lib/ground.h"
#include "lib/random.h"
#include "lib/trace.h"
#include "shared/photon_params.h"

typedef struct {
  Ray ray;
  float weight;         // of the start weight 1
  long held;            // the weight in fixed point: what the tallies still have to account for
  float optical_depth;  // left until the next collision
  bool unscattered;
  bool from_lamp;       // else emitted by the medium
  int steps;
  Random random;
} Photon;

// What a work-item has still to add to the global sums.
typedef struct {
  long reflected, opaque_surface, in_flight, roulette, absorbed;
  int absorbing_region;
  int sum;              // index into the voxel sums; -1: none
  float track;          // weight times length in that voxel
} Pending;

static void flush_track(Pending* pending, global long* voxel_sums, float unit) {
  if (pending->sum >= 0) add_fixed(voxel_sums + pending->sum, pending->track * unit + 0.5f);
  pending->sum = -1;
  pending->track = 0.0f;
}

static void flush_absorbed(Pending* pending, global long* tallies, int region) {
  if (pending->absorbed != 0)
    atom_add((volatile global long*)(tallies + TURBID_PHOTON_ABSORBED + pending->absorbing_region), pending->absorbed);
  pending->absorbed = 0;
  pending->absorbing_region = region;
}

static void flush(Pending* pending, global long* tallies, global long* voxel_sums, float unit) {
  flush_track(pending, voxel_sums, unit);
  flush_absorbed(pending, tallies, 0);
  volatile global long* to = (volatile global long*)tallies;
  if (pending->reflected) atom_add(to + TURBID_PHOTON_REFLECTED, pending->reflected);
  if (pending->opaque_surface) atom_add(to + TURBID_PHOTON_OPAQUE, pending->opaque_surface);
  if (pending->in_flight) atom_add(to + TURBID_PHOTON_IN_FLIGHT, pending->in_flight);
  if (pending->roulette) atom_add(to + TURBID_PHOTON_ROULETTE, pending->roulette);
}

// Gives the photon another weight; returns what it lost, so that losses telescope exactly.
static long reweigh(Photon* photon, float weight, float unit) {
  const long before = photon->held;
  photon->weight = weight;
  photon->held = (long)(weight * unit);
  return before - photon->held;
}

// Adds weight times length to what is pending for a voxel.
static void count_track(Pending* pending, global long* voxel_sums, const PhotonParams* p, int sum, bool first_flight, float track) {
  if (sum >= 0 && first_flight) sum += p->voxel_sums;
  if (sum != pending->sum) {
    flush_track(pending, voxel_sums, p->unit);
    pending->sum = sum;
  }
  pending->track += track;
}

// 1 - exp(-x) for x >= 0: a short series where absorption is weak, which is nearly always.
static float loss_over(float x) {
  return x < 0.03f ? x * (1.0f - x * (0.5f - x * (0.16666667f - 0.041666667f * x))) : -expm1(-x);
}

// The photon leaves for good through a face of the domain, and may light the ground outside.
static void escape(Photon* photon, const PhotonParams* p, global long* tallies, global long* ground, global int* ground_rays,
                   int face, float3 x, float3 direction) {
  const GroundMap map = {p->ground_size, p->ground_height, (float2)(p->ground_origin[0], p->ground_origin[1]), p->ground_texel};
  light_ground(ground, ground_rays, map, x, normalize(direction), photon->weight, p->unit);
  const long weight = reweigh(photon, 0.0f, p->unit);
  atom_add((volatile global long*)(tallies + TURBID_PHOTON_ESCAPED + face), weight);
  if (photon->unscattered) atom_add((volatile global long*)(tallies + TURBID_PHOTON_UNSCATTERED + face), weight);
}
