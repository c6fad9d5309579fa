// SPDX-License-Identifier: Apache-2.0
// Light rays under way, and where their power goes.
#ifndef TURBID_SHARED_MARCH_PARAMS_H
#define TURBID_SHARED_MARCH_PARAMS_H
#include "dialect.h"

// A ray between two batches. Positions in voxels; |velocity| = eta.
typedef struct {
  float position[3];
  int region;
  float velocity[3];
  float grace;        // arc length left in which a start on the rasterised surface may lie outside the sampled one [voxels]
  float power[3];     // [W]; first channel only in grey scenes
  float floor_power;  // the ray ends when its strongest channel falls below this [W]
  float normal[3];    // outward normal of the surface the ray starts on; used while entering = 1
  int entering;       // 1: the ray has still to pass the surface of `region` from the ambient
  int bounces;        // interfaces met so far
  int steps;          // steps done so far
  int texel;          // of the light's shadow map, counted through all maps; -1: none
  float room;         // see Place in lib/trace.h; 0: unknown
} RayState;
TURBID_ASSERT_SIZE(RayState, 80);

// Where power ends, in 64-bit fixed point: tally[kind * 3 + channel].
#define TURBID_TALLY_ABSORBED 0     // along the rays, by the medium
#define TURBID_TALLY_DEPOSITED 1    // scattered out of the rays: the diffusion's source
#define TURBID_TALLY_REFLECTED 2    // by Fresnel where light enters
#define TURBID_TALLY_OPAQUE 3       // absorbed by opaque surfaces
#define TURBID_TALLY_IN_FLIGHT 4    // branches ended by max_steps, max_bounces or min_power
#define TURBID_TALLY_ESCAPED 5      // + face: through the domain's faces -x, +x, -y, +y, -z, +z
#define TURBID_TALLY_WORK 11        // no power but counts: steps, deposits, interfaces met
#define TURBID_TALLY_COUNT 12

typedef struct {
  float step;             // arc length of a step [voxels]
  int batch_steps;        // steps per launch
  int max_steps;
  int max_bounces;
  int first_ray;          // of this launch
  int end_ray;            // one beyond the last
  float fixed_per_watt;   // fixed-point units per watt
  int faces[6];           // TURBID_FACE_...
  int straight;           // 1: nothing refracts; what passes the medium is collected per shadow-map texel instead
  int ground;             // 1: light that leaves the domain downwards is collected on the ground
  float ground_height;    // [voxels]
  float ground_origin[2]; // lower corner of the collecting map (x, z) [voxels]
  float ground_texel;     // edge of its texels [voxels]
  int ground_size;        // texels per side
  int flux_stride;        // numbers per axis of the deposits' first moment
  int own_nodes;          // nodes of one work-item's own sums; 0: all add to the same ones
} MarchParams;
TURBID_ASSERT_SIZE(MarchParams, 88);

#endif
