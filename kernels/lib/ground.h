// SPDX-License-Identifier: Apache-2.0
// Light that leaves the media downwards, collected on a map of the ground.
#ifndef TURBID_LIB_GROUND_H
#define TURBID_LIB_GROUND_H
#include "lib/deposit.h"

typedef struct {
  int size;        // texels per side; 0: there is no ground
  float height;    // [voxels]
  float2 origin;   // lower corner (x, z) [voxels]
  float texel;     // edge of a texel [voxels]
} GroundMap;

// Bilinear splat of light that goes down from x onto the map; `ground_rays` counts the rays per texel.
static void light_ground(global long* ground, global int* ground_rays, GroundMap map, float3 x, float3 direction, Colour power,
                         float fixed_per_watt) {
  if (map.size == 0 || direction.y > -1e-4f || x.y < map.height) return;
  const float t = (map.height - x.y) / direction.y;
  const float u = (x.x + t * direction.x - map.origin.x) / map.texel - 0.5f;
  const float v = (x.z + t * direction.z - map.origin.y) / map.texel - 0.5f;
  if (!(u >= 0.0f && v >= 0.0f && u < map.size - 1 && v < map.size - 1)) return;
  const int iu = (int)u, iv = (int)v;
  const float fu = u - iu, fv = v - iv;
  atomic_inc(ground_rays + (int)(v + 0.5f) * map.size + (int)(u + 0.5f));
  for (int corner = 0; corner < 4; ++corner) {
    const int du = corner & 1, dv = corner >> 1;
    const float weight = (du ? fu : 1.0f - fu) * (dv ? fv : 1.0f - fv);
    const size_t texel = (size_t)(iv + dv) * map.size + iu + du;
    add_power(ground + TURBID_CHANNELS * texel, weight * power, fixed_per_watt);
  }
}

#endif
