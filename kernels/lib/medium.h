// SPDX-License-Identifier: Apache-2.0
// Sampling the medium at a point: which region owns it, its signed distances, index and coefficients.
//
// Interpolation is trilinear in values AND in central-difference gradients, both given at voxel centres: second order for
// the eikonal force (design notes, numerics section 6).
#ifndef TURBID_LIB_MEDIUM_H
#define TURBID_LIB_MEDIUM_H
#include "lib/colour.h"
#include "shared/medium_params.h"

#if !defined(TURBID_VOXELS_X) || !defined(TURBID_VOXELS_Y) || !defined(TURBID_VOXELS_Z)
#error "TURBID_VOXELS_X, _Y and _Z (voxels of the domain) must be defined"
#endif
#if !defined(TURBID_BODIES) || !defined(TURBID_GRADED) || !defined(TURBID_HETEROGENEOUS) || !defined(TURBID_SCATTERING)
#error "TURBID_BODIES, TURBID_GRADED, TURBID_HETEROGENEOUS and TURBID_SCATTERING must be defined"
#endif

#define BLOCKS_X (TURBID_VOXELS_X / 8)
#define BLOCKS_Y (TURBID_VOXELS_Y / 8)
#define BLOCKS_Z (TURBID_VOXELS_Z / 8)
#define BLOCKS (BLOCKS_X * BLOCKS_Y * BLOCKS_Z)

typedef struct {
  const global RegionParams* regions;
  const global int* tile_map;          // [set][block]
  const global int* block_region;      // [block]: the one region of the block, or TURBID_MIXED_BLOCK
  const global float* distance_tiles;  // [tile][node][4]
  const global float* index_tiles;     // [tile][node][4]
  const global float* coefficient_tiles;  // [tile][node][COEFFICIENT_WIDTH]
} Medium;

// The kernels that trace rays take the medium by these arguments.
#define MEDIUM_ARGUMENTS                                                                                     \
  const global RegionParams *regions, const global int *tile_map, const global int *block_region,           \
      const global float *distance_tiles, const global float *index_tiles, const global float *coefficient_tiles
#define MEDIUM_FROM_ARGUMENTS {regions, tile_map, block_region, distance_tiles, index_tiles, coefficient_tiles}

// The cell between eight nodes that holds a point. Within half a voxel of the domain's faces the outermost node's value holds.
typedef struct {
  int block;        // of cells
  int node;         // lowest corner, within the tile
  float3 fraction;  // position in the cell, in [0, 1)
} Cell;

static Cell locate(float3 x) {
  const float3 last = (float3)(TURBID_VOXELS_X - 1, TURBID_VOXELS_Y - 1, TURBID_VOXELS_Z - 1);
  const float3 y = clamp(x - 0.5f, (float3)(0.0f), last);
  const int ix = min((int)y.x, TURBID_VOXELS_X - 2);
  const int iy = min((int)y.y, TURBID_VOXELS_Y - 2);
  const int iz = min((int)y.z, TURBID_VOXELS_Z - 2);
  Cell cell;
  cell.block = (ix >> 3) + BLOCKS_X * ((iy >> 3) + BLOCKS_Y * (iz >> 3));
  cell.node = (ix & 7) + TURBID_TILE_EDGE * ((iy & 7) + TURBID_TILE_EDGE * (iz & 7));
  cell.fraction = (float3)(y.x - (float)ix, y.y - (float)iy, y.z - (float)iz);
  return cell;
}

// Trilinear value of four-wide nodes; the two x-neighbours of a corner come in one load.
static float4 interpolate4(const global float* tiles, int tile, Cell cell) {
  const global float* at = tiles + 4 * ((size_t)tile * TURBID_TILE_NODES + cell.node);
  const float8 a = vload8(0, at);
  const float8 b = vload8(0, at + 4 * TURBID_TILE_EDGE);
  const float8 c = vload8(0, at + 4 * TURBID_TILE_EDGE * TURBID_TILE_EDGE);
  const float8 d = vload8(0, at + 4 * TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1));
  const float8 low = a + cell.fraction.z * (c - a);
  const float8 high = b + cell.fraction.z * (d - b);
  const float8 row = low + cell.fraction.y * (high - low);
  return row.lo + cell.fraction.x * (row.hi - row.lo);
}

static int tile_of(const Medium* medium, int set, int block) { return medium->tile_map[set * BLOCKS + block]; }

// Gradient [1] and signed distance [voxels] of a body's surface; defined in blocks with a tile only.
static float4 surface_at(const Medium* medium, int region, Cell cell) {
  const int tile = tile_of(medium, medium->regions[region].distance_set, cell.block);
  if (tile == TURBID_TILE_INSIDE) return (float4)(0.0f, 0.0f, 0.0f, -8.0f);
  if (tile == TURBID_TILE_OUTSIDE) return (float4)(0.0f, 0.0f, 0.0f, 8.0f);
  return interpolate4(medium->distance_tiles, tile, cell);
}

// The body that stands last in the scene and holds the point, or 0, the ambient.
static int region_at(const Medium* medium, Cell cell) {
  const int only = medium->block_region[cell.block];
  if (only != TURBID_MIXED_BLOCK) return only;
  for (int region = TURBID_BODIES; region >= 1; --region) {
    if (surface_at(medium, region, cell).w < 0.0f) return region;
  }
  return 0;
}

// (grad u, u) with u = eta^2 / 2.
static float4 index_at(const Medium* medium, int region, Cell cell) {
  const float eta = medium->regions[region].eta;
#if TURBID_GRADED
  const int set = medium->regions[region].index_set;
  if (set >= 0) {
    const int tile = tile_of(medium, set, cell.block);
    if (tile >= 0) return interpolate4(medium->index_tiles, tile, cell);
  }
#endif
  return (float4)(0.0f, 0.0f, 0.0f, 0.5f * eta * eta);
}

static float eta_at(const Medium* medium, int region, Cell cell) {
  return sqrt(2.0f * index_at(medium, region, cell).w);
}

typedef struct {
  Colour sigma_s, sigma_a;  // [1/voxel]
} Extinction;

#if TURBID_CHANNELS == 3
#define COEFFICIENT_WIDTH 8
#else
#define COEFFICIENT_WIDTH 2
#endif

static Extinction extinction_at(const Medium* medium, int region, Cell cell) {
  Extinction result;
#if TURBID_HETEROGENEOUS
  const int set = medium->regions[region].coefficient_set;
  const int tile = set >= 0 ? tile_of(medium, set, cell.block) : -1;
  if (tile >= 0) {
    const global float* at = medium->coefficient_tiles + COEFFICIENT_WIDTH * ((size_t)tile * TURBID_TILE_NODES + cell.node);
#if TURBID_CHANNELS == 3
#define CORNER(offset) vload8(0, at + COEFFICIENT_WIDTH * (offset))
    float8 value[4];
#else
#define CORNER(offset) vload2(0, at + COEFFICIENT_WIDTH * (offset))
    float2 value[4];
#endif
    for (int row = 0; row < 4; ++row) {
      const int offset = TURBID_TILE_EDGE * ((row & 1) + TURBID_TILE_EDGE * (row >> 1));
      value[row] = CORNER(offset) + cell.fraction.x * (CORNER(offset + 1) - CORNER(offset));
    }
#undef CORNER
    value[0] += cell.fraction.y * (value[1] - value[0]);
    value[2] += cell.fraction.y * (value[3] - value[2]);
    value[0] += cell.fraction.z * (value[2] - value[0]);
    result.sigma_s = value[0].lo;
    result.sigma_a = value[0].hi;
    return result;
  }
#endif
  result.sigma_s = colour_load(medium->regions[region].sigma_s);
  result.sigma_a = colour_load(medium->regions[region].sigma_a);
  return result;
}

#endif
