// SPDX-License-Identifier: Apache-2.0
// Camera samples, lights and surroundings as the view pass reads them. Positions in voxels, radiance per scene unit squared.
#ifndef TURBID_SHARED_VIEW_PARAMS_H
#define TURBID_SHARED_VIEW_PARAMS_H
#include "dialect.h"

// Where a camera sample starts.
typedef struct {
  float position[3];   // the first hit, or the camera [voxels]
  int region;          // region entered, or -1: the sample sees no medium and no opaque object
  float direction[3];  // unit
  int entering;        // 1: `normal` is the surface's that is entered; 0: the sample starts inside `region`
  float normal[3];
  float padding;
} ViewSample;
TURBID_ASSERT_SIZE(ViewSample, 48);

#define TURBID_LIGHT_DIRECTIONAL 0
#define TURBID_LIGHT_POINT 1
#define TURBID_LIGHT_SPOT 2
#define TURBID_LIGHT_BIT(kind) (1 << (kind))

typedef struct {
  int kind;
  float position[3];      // point, spot [voxels]
  float direction[3];     // where the light goes, unit
  float cos_half_angle;   // spot
  float intensity[3];     // point, spot: irradiance at a distance of one voxel; directional: irradiance [W/unit^2]
  int map_size;           // shadow map, 0: none
  int map_offset;         // of its first texel in the arrays of all
  float map_origin[3];    // depths are counted from here [voxels]
  float voxel_to_clip[16];  // column-major
} LightParams;
TURBID_ASSERT_SIZE(LightParams, 128);

typedef struct {
  float step;             // [voxels]
  int max_steps;
  int max_branches;
  float min_weight;
  int sample_count;
  int transmittance;      // 1: shadow maps know what passes the media
  int light_count;
  int ground;             // 1: there is a ground plane
  float ground_height;    // [voxels]
  float ground_colour[3];
  float ground_colour2[3];
  float checker_size;     // [voxels], 0: plain
  float background[3];    // radiance
  int ground_map_size;    // light through the media, 0: none
  float ground_map_origin[2];  // [voxels]
  float ground_map_texel;      // [voxels]
  float origin[3];        // scene position of the domain's corner, in voxels, so that checkerboards stay put
  float tint[3];          // colour of the one channel of a grey scene
  float eta_observer;     // index of the ambient where the camera is
} ViewParams;
TURBID_ASSERT_SIZE(ViewParams, 120);

#endif
