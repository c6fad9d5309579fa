// SPDX-License-Identifier: Apache-2.0
// The medium as the ray kernels read it: regions, tile maps and tiles (kernels/shared/medium_params.h) on the device.
#pragma once
#include <vector>

#include "host/cl/session.h"
#include "host/scene/features.h"
#include "host/transport/tile_values.h"
#include "kernels/shared/medium_params.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// A tile of cells in which one region may scatter.
struct SourceTile {
  int region;
  glm::ivec3 block;
};

struct DeviceMedium {
  GridFrame frame;
  SceneFeatures features;
  Storage storage = Storage::single_precision;  ///< of index_tiles and coefficient_tiles
  std::vector<RegionParams> region_params;
  std::vector<int> tile_map;             ///< [set][block]
  std::vector<int> block_region;         ///< [block]
  std::vector<SourceTile> source_tiles;  ///< in the order of their numbers in the tile map

  cl::Buffer<RegionParams> regions_buffer;
  cl::Buffer<int> tile_map_buffer, block_region_buffer;
  cl::Buffer<int> region_tiles;          ///< [region][block][4]: tiles of index, coefficients, source; block_region
  cl::Buffer<float> distance_tiles;
  StoredTiles index_tiles, coefficient_tiles;

  /// Relative error that half-precision storage may leave in the fluence. Roundings of coefficients average out along a path;
  /// those of the index turn it, and a focus moves: the lens of scenes/luneburg.toml, which focuses on its far side, makes
  /// 1.1e-3 of 1.9e-4, all other bundled scenes less than what was rounded.
  double storage_error() const { return coefficient_tiles.rounding + 8 * index_tiles.rounding; }
  int block_count() const { return frame.blocks().x * frame.blocks().y * frame.blocks().z; }
  /// The mandatory -D integers of every program that traces rays.
  std::vector<cl::Define> defines() const;
};

/// Cuts the medium into tiles and uploads them. Signed distances are always kept in single precision: they tell who owns a
/// point.
DeviceMedium upload_medium(cl::Session&, const MediumVolume&, const SceneFeatures&,
                           Storage = Storage::single_precision);

/// First-flight coefficients of forward scattering: the delta-Eddington share f = g^2 counts as not scattered
/// (numerics section 4); the rest scatters with g* = g / (1 + g). Backward scattering has no forward peak to set aside, and
/// g* would leave (-1, 1): f = 0.
inline float scaled_g(float g) { return g > 0.0f ? g / (1.0f + g) : g; }
inline glm::vec3 delta_scaled(glm::vec3 sigma_s, float g) { return sigma_s * (g > 0.0f ? 1.0f - g * g : 1.0f); }

}  // namespace turbid
