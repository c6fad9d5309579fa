// SPDX-License-Identifier: Apache-2.0
// The medium as rays see it. Rays live in voxel units: the domain is [0, n) along each axis, voxel i has its centre at i + 1/2.
//
// Values are given at voxel centres ("nodes") and interpolated trilinearly between them. Cells between nodes are grouped in
// tiles of 8^3 cells = 9^3 nodes, so that the eight corners of any cell lie in one tile. A map per field set says for each
// block of cells which tile holds it. Only blocks where a field is needed have a tile.
#ifndef TURBID_SHARED_MEDIUM_PARAMS_H
#define TURBID_SHARED_MEDIUM_PARAMS_H
#include "dialect.h"

#define TURBID_TILE_EDGE 9
#define TURBID_TILE_NODES 729
#define TURBID_TILE_OUTSIDE (-1)  // no tile; for signed distances: every point of the block is outside the body
#define TURBID_TILE_INSIDE (-2)   // signed distances only: every point of the block is inside the body
#define TURBID_TOUCH 0.01f  // two bodies with a gap narrower than this between them touch [voxels]
// block_region where more than one region may meet in the block: minus the steepest slope of the distances interpolated there, in
// this unit and rounded up.
#define TURBID_SLOPE_UNIT (1.0f / 64)

#define TURBID_FACE_OPEN 0
#define TURBID_FACE_MIRROR 1
#define TURBID_FACE_PERIODIC 2

// One region's constants; coefficients per voxel edge.
typedef struct {
  float eta;              // refractive index where index_set < 0
  int index_set;          // row of the tile map for (grad u, u), u = eta^2 / 2; -1: constant
  int distance_set;       // row for (grad d, d), the signed distance in voxels; -1: the ambient
  int coefficient_set;    // row for (sigma_s, sigma_a); -1: constant
  int source_set;         // row for the deposit and the gathered source; -1: the region does not scatter
  int smooth_group;       // 1: shares its blurred index with the other regions marked so; no interface between them
  int opaque;             // 1: an opaque Lambertian surface
  int attenuates;         // 1: sigma_s + sigma_a > 0 somewhere
  float sigma_s[4];       // where coefficient_set < 0; the fourth is 0
  float sigma_a[4];
  float reflectance[3];   // of an opaque surface
  float reflectance2[3];  // second colour of its checkerboard
  float checker_size;     // [voxels], 0: plain
  float tau_per_arc;      // 1 / largest eta of the region: dtau of a step of unit arc
} RegionParams;
TURBID_ASSERT_SIZE(RegionParams, 96);

#endif
