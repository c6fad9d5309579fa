// SPDX-License-Identifier: Apache-2.0
// Medium grids in; tiles of 9^3 nodes and their maps out. A tile exists only where its field is needed.
#include "host/transport/device_medium.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/parallel.h"
#include "host/transport/block_states.h"
#include "host/transport/tile_values.h"

namespace turbid {
namespace {

constexpr int kTileEdge = TURBID_TILE_EDGE;
constexpr int kTileNodes = TURBID_TILE_NODES;

/// Collects the tile maps of all sets and numbers the tiles of each kind.
class TileMaps {
 public:
  explicit TileMaps(int blocks) : blocks_(blocks) {}
  /// A new set; state[block]: TURBID_TILE_OUTSIDE, TURBID_TILE_INSIDE, or anything >= 0 to get the next tile number.
  int add(std::vector<int> state, int* next_tile) {
    for (int& entry : state) {
      if (entry >= 0) entry = (*next_tile)++;
    }
    map_.insert(map_.end(), state.begin(), state.end());
    return sets_++;
  }
  std::vector<int> take() {
    if (map_.empty()) map_.assign(blocks_, TURBID_TILE_OUTSIDE);
    return std::move(map_);
  }
  int tile(int set, int block) const { return map_[static_cast<std::size_t>(set) * blocks_ + block]; }

 private:
  int blocks_;
  int sets_ = 0;
  std::vector<int> map_;
};

/// Calls fill(block, tile) for every block of the set that has a tile.
template <class Fill>
void for_each_tile(const TileMaps& maps, int set, int blocks, const Fill& fill) {
  parallel_ranges(blocks, [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      if (const int tile = maps.tile(set, block); tile >= 0) fill(block, tile);
    }
  });
}

template <std::size_t n>
void copy(const glm::vec3& from, float (&to)[n]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

/// What rays look up of the block that they are in, in one place.
std::vector<int> region_tiles(const DeviceMedium& device) {
  std::vector<int> tiles;
  for (const RegionParams& region : device.region_params) {
    for (int block = 0; block < device.block_count(); ++block) {
      for (int set : {region.index_set, region.coefficient_set, region.source_set}) {
        tiles.push_back(set < 0 ? -1 : device.tile_map[static_cast<std::size_t>(set) * device.block_count() + block]);
      }
      tiles.push_back(device.block_region[block]);
    }
  }
  return tiles;
}

/// Room for tiles; where rays read any, there is a first one, which stands in for those that are missing.
std::vector<float> room_for(int tiles, bool read, int width) {
  return std::vector<float>(static_cast<std::size_t>(read ? std::max(tiles, 1) : tiles) * kTileNodes * width);
}

}  // namespace

std::vector<cl::Define> DeviceMedium::defines() const {
  return {{"TURBID_CHANNELS", features.channels},
          {"TURBID_BODIES", features.bodies},
          {"TURBID_GRADED", features.graded_index},
          {"TURBID_HETEROGENEOUS", features.heterogeneous},
          {"TURBID_SCATTERING", features.scattering},
          {"TURBID_HALF_TILES", storage == Storage::half_precision},
          {"TURBID_INDEX_EXPONENT", index_tiles.exponent},
          {"TURBID_COEFFICIENT_EXPONENT", coefficient_tiles.exponent},
          {"TURBID_VOXELS_X", frame.voxels.x},
          {"TURBID_VOXELS_Y", frame.voxels.y},
          {"TURBID_VOXELS_Z", frame.voxels.z}};
}

DeviceMedium upload_medium(cl::Session& session, const MediumVolume& medium, const SceneFeatures& features, Storage storage) {
  DeviceMedium device;
  device.storage = storage;
  device.frame = medium.frame();
  device.features = features;
  const glm::ivec3 blocks = device.frame.blocks();
  const int block_count = device.block_count();
  const int regions = medium.region_count();
  const float h = device.frame.voxel_size;
  TileMaps maps(block_count);
  std::vector<std::vector<int>> body_state(regions);
  std::vector<float> slope(block_count, 0.0f);
  for (int r = 1; r < regions; ++r) body_state[r] = classify(medium, r, &slope);
  device.block_region = only_region(body_state, slope);
  device.region_params.resize(regions);

  // Signed distances.
  int distance_tiles = 0;
  for (int r = 0; r < regions; ++r) {
    device.region_params[r].distance_set = r == 0 ? -1 : maps.add(body_state[r], &distance_tiles);
  }
  std::vector<float> distances(static_cast<std::size_t>(distance_tiles) * kTileNodes * 4);
  for (int r = 1; r < regions; ++r) {
    for_each_tile(maps, device.region_params[r].distance_set, block_count, [&](int block, int tile) {
      std::vector<float> halo(halo_nodes(kDistanceHalo));
      medium.read_signed_distance(r, 8 * block_coordinates(block, blocks) - kDistanceHalo,
                                  glm::ivec3(halo_edge(kDistanceHalo)), halo);
      with_gradient<kDistanceHalo>(halo, distances.data() + static_cast<std::size_t>(tile) * kTileNodes * 4);
    });
  }

  // Graded indices: one set for each region with its own field, one for the whole smooth group.
  int index_tiles = 0, smooth_set = -1;
  std::vector<std::pair<int, int>> index_sets;  // (region that reads it, set)
  for (int r = 0; r < regions; ++r) {
    const Region& region = medium.region(r);
    RegionParams& params = device.region_params[r];
    params.smooth_group = region.smooth_surface;
    params.index_set = -1;
    if (!(region.graded_index || features.general) || region.opaque) continue;
    if (region.smooth_surface && smooth_set >= 0) {
      params.index_set = smooth_set;
      continue;
    }
    std::vector<int> present = presence(r, body_state, block_count);
    if (region.smooth_surface) {
      // The blurred field: wherever it differs from the ambient's constant.
      std::fill(present.begin(), present.end(), 0);
      const float ambient = medium.region(0).eta;
      parallel_ranges(block_count, [&](int begin, int end) {
        std::vector<float> halo(halo_nodes(kIndexHalo));
        for (int block = begin; block < end; ++block) {
          medium.read_eta(r, 8 * block_coordinates(block, blocks) - kIndexHalo, glm::ivec3(halo_edge(kIndexHalo)),
                          halo);
          const bool flat = std::all_of(halo.begin(), halo.end(), [&](float eta) { return eta == ambient; });
          if (flat) present[block] = TURBID_TILE_OUTSIDE;
        }
      });
    }
    params.index_set = maps.add(std::move(present), &index_tiles);
    if (region.smooth_surface) smooth_set = params.index_set;
    index_sets.emplace_back(r, params.index_set);
  }
  std::vector<float> indices = room_for(index_tiles, features.graded_index, 4);
  for (const auto& [r, set] : index_sets) {
    for_each_tile(maps, set, block_count, [&, reader = r](int block, int tile) {
      std::vector<float> halo(halo_nodes(kIndexHalo));
      medium.read_eta(reader, 8 * block_coordinates(block, blocks) - kIndexHalo, glm::ivec3(halo_edge(kIndexHalo)),
                      halo);
      for (float& eta : halo) eta = 0.5f * eta * eta;
      with_gradient<kIndexHalo>(halo, indices.data() + static_cast<std::size_t>(tile) * kTileNodes * 4);
    });
  }

  // Varying coefficients, per voxel edge.
  const int width = features.channels == 3 ? 8 : 2, half = width / 2;
  int coefficient_tiles = 0;
  for (int r = 0; r < regions; ++r) {
    device.region_params[r].coefficient_set =
        medium.region(r).heterogeneous || (features.general && !medium.region(r).opaque)
            ? maps.add(presence(r, body_state, block_count), &coefficient_tiles)
            : -1;
  }
  std::vector<float> coefficients = room_for(coefficient_tiles, features.heterogeneous, width);
  for (int r = 0; r < regions; ++r) {
    const int set = device.region_params[r].coefficient_set;
    if (set < 0) continue;
    for_each_tile(maps, set, block_count, [&](int block, int tile) {
      std::vector<Coefficients> nodes(kTileNodes);
      medium.read_coefficients(r, 8 * block_coordinates(block, blocks), glm::ivec3(kTileEdge), nodes);
      float* out = coefficients.data() + static_cast<std::size_t>(tile) * kTileNodes * width;
      for (const Coefficients& node : nodes) {
        const glm::vec3 sigma_s = delta_scaled(node.sigma_s, node.g) * h, sigma_a = node.sigma_a * h;
        for (int c = 0; c < features.channels; ++c) {
          out[c] = sigma_s[c];
          out[half + c] = sigma_a[c];
        }
        out += width;
      }
    });
  }

  // Where light may be scattered.
  int source_tiles = 0;
  for (int r = 0; r < regions; ++r) {
    device.region_params[r].source_set = -1;
    if (!medium.region(r).participates() && !(features.general && !medium.region(r).opaque)) continue;
    const std::vector<int> present = presence(r, body_state, block_count);
    for (int block = 0; block < block_count; ++block) {
      if (present[block] >= 0) device.source_tiles.push_back({r, block_coordinates(block, blocks)});
    }
    device.region_params[r].source_set = maps.add(present, &source_tiles);
  }
  device.tile_map = maps.take();

  // Region constants.
  for (int r = 0; r < regions; ++r) {
    const Region& region = medium.region(r);
    RegionParams& params = device.region_params[r];
    params.eta = region.eta;
    params.opaque = region.opaque;
    params.attenuates = !region.opaque && (region.scatters || region.absorbs);
    copy(delta_scaled(region.sigma_s, region.g) * h, params.sigma_s);
    copy(region.sigma_a * h, params.sigma_a);
    copy(region.reflectance, params.reflectance);
    copy(region.reflectance2, params.reflectance2);
    params.checker_size = region.checker_size / h;
    float eta_max = region.eta;
    const int set = params.index_set;
    if (set >= 0) {
      for (int block = 0; block < block_count; ++block) {
        const int tile = device.tile_map[static_cast<std::size_t>(set) * block_count + block];
        if (tile < 0) continue;
        const float* node = indices.data() + static_cast<std::size_t>(tile) * kTileNodes * 4;
        for (int i = 0; i < kTileNodes; ++i) eta_max = std::max(eta_max, std::sqrt(2.0f * node[4 * i + 3]));
      }
    }
    params.tau_per_arc = 1.0f / eta_max;
  }

  device.regions_buffer = session.upload(device.region_params);
  device.tile_map_buffer = session.upload(device.tile_map);
  device.region_tiles = session.upload(region_tiles(device));
  device.block_region_buffer = session.upload(device.block_region);
  device.distance_tiles = session.upload(distances);
  device.index_tiles = store_tiles(session, indices, storage);
  device.coefficient_tiles = store_tiles(session, coefficients, storage);
  return device;
}

}  // namespace turbid
