// SPDX-License-Identifier: Apache-2.0
// Photons of the Monte Carlo reference: where they start, the coefficients they meet, and where their weight goes.
//
// A launch follows photons of one colour. Each starts with weight 1; sums are kept in fixed point, `unit` units per weight.
#ifndef TURBID_SHARED_PHOTON_PARAMS_H
#define TURBID_SHARED_PHOTON_PARAMS_H
#include "dialect.h"

#define TURBID_SOURCE_RAY 0       // the given position and direction, inside `region`
#define TURBID_SOURCE_ENTERING 1  // the same, with the surface of `region` still to pass from the ambient (Fresnel)
#define TURBID_SOURCE_CONE 2      // evenly over the directions within the angle about `direction`; cosine -1: all of them
#define TURBID_SOURCE_LAMBERT 3   // over the hemisphere about `direction`, with its cosine
#define TURBID_SOURCE_VOXEL 4     // emitted by the medium: any direction, anywhere in the voxel's part of its region

typedef struct {
  float position[3];     // [voxels]; of a voxel, its lower corner
  int region;
  float direction[3];    // unit
  float grace;           // see RayState
  float normal[3];       // outward, of the surface to enter; of a voxel: a point of its part, from the lower corner
  int kind;              // TURBID_SOURCE_...
  float cos_half_angle;  // of a cone
  float padding[3];
} PhotonSource;
TURBID_ASSERT_SIZE(PhotonSource, 64);

// One region's true coefficients (those of RegionParams are delta-scaled), per voxel edge.
typedef struct {
  float sigma_s[3];
  float sigma_a[3];
  float g;
  int majorant_set;      // row of the majorants where coefficients vary; -1: constant
} PhotonRegion;
TURBID_ASSERT_SIZE(PhotonRegion, 32);

// Where weight ends: tally[kind].
#define TURBID_PHOTON_REFLECTED 0    // by Fresnel where light enters
#define TURBID_PHOTON_OPAQUE 1       // absorbed by opaque surfaces
#define TURBID_PHOTON_IN_FLIGHT 2    // of photons ended by max_steps
#define TURBID_PHOTON_ROULETTE 3     // taken by Russian roulette, less what it gave: zero on average
#define TURBID_PHOTON_ESCAPED 4      // + face -x, +x, -y, +y, -z, +z
#define TURBID_PHOTON_UNSCATTERED 10 // + face: of what escaped, the part that never scattered
#define TURBID_PHOTON_ABSORBED 16    // + region
#define TURBID_PHOTON_TALLIES 16     // before the regions

typedef struct {
  unsigned seed[2];
  unsigned first_photon[2];     // number of the launch's first photon among all of its colour: low, high word
  unsigned first_in_batch;      // and within its batch
  unsigned stratum[2];          // 2^63 / photons of the batch: low, high word
  int photon_count;             // of the launch
  int channel;
  int source_count;
  int coefficient_tiles;        // tiles of one colour
  int majorant_sets;
  int voxel_sums;               // active blocks x 512: scattered light first, then light that has not scattered
  int max_steps;
  float step;                   // longest step where rays bend or surfaces may be met [voxels]
  float unit;                   // fixed-point units per weight
  int faces[6];                 // TURBID_FACE_...
  float ground_height;          // [voxels]
  float ground_origin[2];       // lower corner of the collecting map (x, z) [voxels]
  float ground_texel;           // edge of its texels [voxels]
  int ground_size;              // texels per side; 0: no ground
} PhotonParams;
TURBID_ASSERT_SIZE(PhotonParams, 108);

#endif
