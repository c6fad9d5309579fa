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
#if !defined(TURBID_HALF_TILES)
#error "TURBID_HALF_TILES (1: tiles of index and coefficients are stored in half precision) must be defined"
#endif

// Numbers of index and coefficients are stored 2^exponent times as large, so that half precision resolves small ones too.
#if TURBID_HALF_TILES
typedef half TileNumber;
#define UNIT_OF(exponent) as_float((127 - (exponent)) << 23)
#define INDEX_UNIT UNIT_OF(TURBID_INDEX_EXPONENT)
#define COEFFICIENT_UNIT UNIT_OF(TURBID_COEFFICIENT_EXPONENT)
#else
typedef float TileNumber;
#define INDEX_UNIT 1.0f
#define COEFFICIENT_UNIT 1.0f
#endif

// The two x-neighbours of a row of corners come in one load.
static ALWAYS_INLINE float2 load2(const global float* at) { return vload2(0, at); }
static ALWAYS_INLINE float4 __attribute__((overloadable)) load4(const global float* at) { return vload4(0, at); }
static ALWAYS_INLINE float8 __attribute__((overloadable)) load8(const global float* at) { return vload8(0, at); }
static ALWAYS_INLINE float16 __attribute__((overloadable)) load16(const global float* at) { return vload16(0, at); }
static ALWAYS_INLINE float4 __attribute__((overloadable)) load4(const global half* at) { return vload_half4(0, at); }
static ALWAYS_INLINE float8 __attribute__((overloadable)) load8(const global half* at) { return vload_half8(0, at); }
static ALWAYS_INLINE float16 __attribute__((overloadable)) load16(const global half* at) {
  return (float16)(vload_half8(0, at), vload_half8(1, at));
}

#define BLOCKS_X (TURBID_VOXELS_X / 8)
#define BLOCKS_Y (TURBID_VOXELS_Y / 8)
#define BLOCKS_Z (TURBID_VOXELS_Z / 8)
#define BLOCKS (BLOCKS_X * BLOCKS_Y * BLOCKS_Z)

typedef struct {
  const global RegionParams* regions;
  const global int* tile_map;          // [set][block]
  const global int* block_region;      // [block]: the one region of the block; < 0: see TURBID_SLOPE_UNIT
  const global float* distance_tiles;  // [tile][node][4]
  const global TileNumber* index_tiles;  // [tile][node][4]
  const global TileNumber* coefficient_tiles;  // [tile][node][COEFFICIENT_WIDTH]
} Medium;

// The kernels that trace rays take the medium by these arguments.
#define MEDIUM_ARGUMENTS                                                                                     \
  const global RegionParams *regions, const global int *tile_map, const global int *block_region,           \
      const global float *distance_tiles, const global TileNumber *index_tiles, const global TileNumber *coefficient_tiles
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

// Trilinear value of four-wide nodes.
#define INTERPOLATE4(Number)                                                                                          \
  static float4 __attribute__((overloadable)) interpolate4(const global Number* tiles, int tile, Cell cell) {         \
    const global Number* at = tiles + 4 * ((size_t)tile * TURBID_TILE_NODES + cell.node);                             \
    const float8 a = load8(at), b = load8(at + 4 * TURBID_TILE_EDGE);                                                 \
    const float8 c = load8(at + 4 * TURBID_TILE_EDGE * TURBID_TILE_EDGE);                                             \
    const float8 d = load8(at + 4 * TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1));                                       \
    const float8 low = a + cell.fraction.z * (c - a), high = b + cell.fraction.z * (d - b);                           \
    const float8 row = low + cell.fraction.y * (high - low);                                                          \
    return row.lo + cell.fraction.x * (row.hi - row.lo);                                                              \
  }
INTERPOLATE4(float)
#if TURBID_HALF_TILES
INTERPOLATE4(half)
#endif

// Gradient of the last component's trilinear interpolant [per voxel].
static float3 slope4(const global float* tiles, int tile, Cell cell) {
  const global float* at = tiles + 4 * ((size_t)tile * TURBID_TILE_NODES + cell.node);
  const int up = 4 * TURBID_TILE_EDGE, back = up * TURBID_TILE_EDGE;
  const float2 a = (float2)(at[3], at[7]), b = (float2)(at[up + 3], at[up + 7]);
  const float2 c = (float2)(at[back + 3], at[back + 7]), d = (float2)(at[back + up + 3], at[back + up + 7]);
  const float2 low = a + cell.fraction.z * (c - a), high = b + cell.fraction.z * (d - b);
  const float2 row = low + cell.fraction.y * (high - low), along_y = high - low;
  const float2 along_z = (c - a) + cell.fraction.y * ((d - b) - (c - a));
  return (float3)(row.y - row.x, along_y.x + cell.fraction.x * (along_y.y - along_y.x),
                  along_z.x + cell.fraction.x * (along_z.y - along_z.x));
}

// Pairs of nodes of `width` values at a cell's four rows along x, which LOAD reads, by the rows' weights.
#define WEIGH_ROWS(LOAD, width, at, rows, stride)                                                    \
  ((rows)[0] * LOAD(at) + (rows)[stride] * LOAD((at) + (width) * TURBID_TILE_EDGE) +                 \
   (rows)[2 * (stride)] * LOAD((at) + (width) * TURBID_TILE_EDGE * TURBID_TILE_EDGE) +               \
   (rows)[3 * (stride)] * LOAD((at) + (width) * TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1)))

// interpolate4 by the weights of the four rows of corners and of the corners farther along x.
#define WEIGH4(Number)                                                                                                      \
  static ALWAYS_INLINE float4 __attribute__((overloadable)) weigh4(const global Number* at, const float* rows, int stride,  \
                                                                   float x) {                                               \
    const float8 row = WEIGH_ROWS(load8, 4, at, rows, stride);                                                              \
    return row.lo + x * (row.hi - row.lo);                                                                                  \
  }
WEIGH4(float)
#if TURBID_HALF_TILES
WEIGH4(half)
#endif

// A colour at a node of a source tile.
#if TURBID_CHANNELS == 3
#define SOURCE_WIDTH 4
static ALWAYS_INLINE float4 weigh_colour(const global float* at, const float* rows, int stride, float x) {
  return weigh4(at, rows, stride, x);
}
#else
#define SOURCE_WIDTH 1
static ALWAYS_INLINE float weigh_colour(const global float* at, const float* rows, int stride, float x) {
  const float2 row = WEIGH_ROWS(load2, 1, at, rows, stride);
  return row.x + x * (row.y - row.x);
}
#endif

static int tile_of(const Medium* medium, int set, int block) { return medium->tile_map[set * BLOCKS + block]; }

// Gradient [1] and signed distance [voxels] of a body's surface; defined in blocks with a tile only.
static float4 surface_at(const Medium* medium, int region, Cell cell) {
  const int tile = tile_of(medium, medium->regions[region].distance_set, cell.block);
  if (tile == TURBID_TILE_INSIDE) return (float4)(0.0f, 0.0f, 0.0f, -8.0f);
  if (tile == TURBID_TILE_OUTSIDE) return (float4)(0.0f, 0.0f, 0.0f, 8.0f);
  return interpolate4(medium->distance_tiles, tile, cell);
}

// The body that stands last in the scene and holds the point, or 0, the ambient. Faces of two bodies that coincide leave
// points that rounding puts in neither: the gap between bodies that touch belongs to the later one, so that a path goes from
// one straight into the other.
// `room`: as far as this [voxels] around the point, but within its block of cells, the region is the same, since no distance
// changes faster there than the steepest slope.
static int region_with_room(const Medium* medium, Cell cell, float* room) {
  *room = 1e9f;
  const int only = medium->block_region[cell.block];
  if (only >= 0) return only;
  const float per_distance = -1.0f / (TURBID_SLOPE_UNIT * only);
  float nearest = 1e9f;  // of the bodies passed over
  int nearest_region = 0;
  for (int region = TURBID_BODIES; region >= 1; --region) {
    const int tile = tile_of(medium, medium->regions[region].distance_set, cell.block);
    if (tile == TURBID_TILE_INSIDE) return region;
    if (tile == TURBID_TILE_OUTSIDE) continue;
    const float signed_distance = interpolate4(medium->distance_tiles, tile, cell).w;
    *room = fmin(*room, fmax(per_distance * (fabs(signed_distance) - TURBID_TOUCH), 0.0f));
    if (signed_distance < 0.0f) return region;
    if (nearest + signed_distance < TURBID_TOUCH) return nearest_region;
    if (signed_distance < nearest) {
      nearest = signed_distance;
      nearest_region = region;
    }
  }
  return 0;
}

static int region_at(const Medium* medium, Cell cell) {
  float room;
  return region_with_room(medium, cell, &room);
}

// (grad u, u) with u = eta^2 / 2.
static float4 index_at(const Medium* medium, int region, Cell cell) {
  const float eta = medium->regions[region].eta;
#if TURBID_GRADED
  const int set = medium->regions[region].index_set;
  if (set >= 0) {
    const int tile = tile_of(medium, set, cell.block);
    if (tile >= 0) return INDEX_UNIT * interpolate4(medium->index_tiles, tile, cell);
  }
#endif
  return (float4)(0.0f, 0.0f, 0.0f, 0.5f * eta * eta);
}

// The refractive index.
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

// Interpolated in a tile of coefficients, or the region's constants where there is none (tile < 0).
static Extinction extinction_in(const Medium* medium, int region, int tile, Cell cell) {
  Extinction result;
#if TURBID_HETEROGENEOUS
  if (tile >= 0) {
    const global TileNumber* at = medium->coefficient_tiles + COEFFICIENT_WIDTH * ((size_t)tile * TURBID_TILE_NODES + cell.node);
#if TURBID_CHANNELS == 3
#define ROW(offset) load16(at + COEFFICIENT_WIDTH * (offset))
    typedef float16 Row;
#else
#define ROW(offset) load4(at + COEFFICIENT_WIDTH * (offset))
    typedef float4 Row;
#endif
    const Row a = ROW(0), b = ROW(TURBID_TILE_EDGE);
    const Row c = ROW(TURBID_TILE_EDGE * TURBID_TILE_EDGE), d = ROW(TURBID_TILE_EDGE * (TURBID_TILE_EDGE + 1));
#undef ROW
    const Row low = a + cell.fraction.z * (c - a), high = b + cell.fraction.z * (d - b);
    const Row row = low + cell.fraction.y * (high - low);
    result.sigma_s = COEFFICIENT_UNIT * (row.lo.lo + cell.fraction.x * (row.hi.lo - row.lo.lo));
    result.sigma_a = COEFFICIENT_UNIT * (row.lo.hi + cell.fraction.x * (row.hi.hi - row.lo.hi));
    return result;
  }
#endif
  result.sigma_s = colour_load4(medium->regions[region].sigma_s);
  result.sigma_a = colour_load4(medium->regions[region].sigma_a);
  return result;
}

// (sigma_s, sigma_a) of nodes by weights, see weigh4.
#if TURBID_CHANNELS == 3
static ALWAYS_INLINE float8 coefficients_of(const global TileNumber* at, const float* rows, int stride, float x) {
  const float16 row = WEIGH_ROWS(load16, 8, at, rows, stride);
  return COEFFICIENT_UNIT * (row.lo + x * (row.hi - row.lo));
}
#else
static ALWAYS_INLINE float2 coefficients_of(const global TileNumber* at, const float* rows, int stride, float x) {
  const float4 row = WEIGH_ROWS(load4, 2, at, rows, stride);
  return COEFFICIENT_UNIT * (row.lo + x * (row.hi - row.lo));
}
#endif

static Extinction extinction_at(const Medium* medium, int region, Cell cell) {
  const int set = medium->regions[region].coefficient_set;
  return extinction_in(medium, region, set >= 0 ? tile_of(medium, set, cell.block) : -1, cell);
}

#endif
