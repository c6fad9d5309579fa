// SPDX-License-Identifier: Apache-2.0
// Reads the medium's coefficients once more, unscaled.
#include "host/transport/photon_medium.h"

#include <algorithm>
#include <map>

#include "host/base/parallel.h"
#include "host/transport/diffusion_medium.h"
#include "host/transport/hat_volume.h"

namespace turbid {
namespace {

constexpr int kVoxels = 512;
constexpr int kTileEdge = TURBID_TILE_EDGE, kTileNodes = TURBID_TILE_NODES;

glm::ivec3 block_coordinates(int block, glm::ivec3 blocks) {
  return {block % blocks.x, (block / blocks.x) % blocks.y, block / (blocks.x * blocks.y)};
}

/// Owner, first-flight scattering and emission of the voxels of one active block.
void fill_block(PhotonMedium& out, const MediumVolume& medium, int block, const std::vector<float>& floors) {
  const glm::ivec3 lower = 8 * out.blocks.coordinates(block);
  const float h = medium.frame().voxel_size;
  std::vector<int> owner(kVoxels);
  medium.read_owner(lower, glm::ivec3(8), owner);
  std::map<int, std::vector<Coefficients>> varying;
  for (int v = 0; v < kVoxels; ++v) {
    const int r = owner[v];
    if (r < 0 || floors[r] < 0.0f) continue;
    const Region& region = medium.region(r);
    Coefficients k{region.sigma_s, region.sigma_a, region.emission, region.g};
    if (region.heterogeneous) {
      auto& values = varying[r];
      if (values.empty()) {
        values.resize(kVoxels);
        medium.read_coefficients(r, lower, glm::ivec3(8), values);
      }
      k = values[v];
    }
    const std::size_t at = block * std::size_t{kVoxels} + v;
    out.region[at] = static_cast<std::int16_t>(r);
    out.sigma_s[at] = h * delta_scaled(k.sigma_s, k.g);
    if (!out.emission.empty()) out.emission[at] = h * h * h * k.emission;
  }
}

/// Coefficients of the regions where they vary, in the tiles that the tile map already numbers.
std::vector<float> coefficient_tiles(const MediumVolume& medium, const DeviceMedium& device, int tiles) {
  const glm::ivec3 blocks = device.frame.blocks();
  const int channels = device.features.channels, block_count = device.block_count();
  const float h = device.frame.voxel_size;
  std::vector<float> out(static_cast<std::size_t>(channels) * tiles * kTileNodes * 4, 0.0f);
  for (int r = 0; r < medium.region_count(); ++r) {
    const int set = device.region_params[r].coefficient_set;
    if (set < 0) continue;
    parallel_ranges(block_count, [&](int begin, int end) {
      std::vector<Coefficients> nodes(kTileNodes);
      for (int block = begin; block < end; ++block) {
        const int tile = device.tile_map[static_cast<std::size_t>(set) * block_count + block];
        if (tile < 0) continue;
        medium.read_coefficients(r, 8 * block_coordinates(block, blocks), glm::ivec3(kTileEdge), nodes);
        for (int c = 0; c < channels; ++c) {
          float* node = out.data() + (static_cast<std::size_t>(c) * tiles + tile) * kTileNodes * 4;
          for (const Coefficients& k : nodes) {
            node[0] = h * k.sigma_s[c];
            node[1] = h * k.sigma_a[c];
            node[2] = k.g;
            node += 4;
          }
        }
      }
    });
  }
  return out;
}

/// Largest sigma_s + sigma_a among the nodes that interpolation inside a block of voxels may read.
std::vector<float> majorants(const MediumVolume& medium, const DeviceMedium& device,
                             const std::vector<PhotonRegion>& regions, int sets) {
  const glm::ivec3 blocks = device.frame.blocks();
  const int channels = device.features.channels, block_count = device.block_count();
  std::vector<float> out(static_cast<std::size_t>(channels) * sets * block_count, 0.0f);
  for (int r = 0; r < medium.region_count(); ++r) {
    const int set = regions[r].majorant_set;
    if (set < 0) continue;
    parallel_ranges(block_count, [&](int begin, int end) {
      std::vector<Coefficients> nodes(10 * 10 * 10);
      for (int block = begin; block < end; ++block) {
        medium.read_coefficients(r, 8 * block_coordinates(block, blocks) - 1, glm::ivec3(10), nodes);
        glm::vec3 largest(0);
        for (const Coefficients& k : nodes) largest = glm::max(largest, k.sigma_s + k.sigma_a);
        // A little more than the largest node: interpolated values round up.
        for (int c = 0; c < channels; ++c)
          out[(static_cast<std::size_t>(c) * sets + set) * block_count + block] =
              device.frame.voxel_size * largest[c] * 1.00001f;
      }
    });
  }
  return out;
}

}  // namespace

std::uint64_t fingerprint(std::uint64_t before, const void* bytes, std::size_t size) {
  const auto* at = static_cast<const unsigned char*>(bytes);
  for (std::size_t i = 0; i < size; ++i) before = (before ^ at[i]) * 0x100000001b3ull;
  return before;
}

PhotonMedium upload_photon_medium(cl::Session& session, const MediumVolume& medium, const DeviceMedium& device) {
  const std::vector<float> floors = floors_of_s(medium);
  PhotonMedium out(active_blocks(medium, floors));
  const glm::ivec3 blocks = device.frame.blocks();
  const int block_count = device.block_count();
  const float h = device.frame.voxel_size;
  out.region.assign(out.stride(), -1);
  out.sigma_s.assign(out.stride(), glm::vec3(0));
  if (device.features.emission) out.emission.assign(out.stride(), glm::vec3(0));
  parallel_ranges(out.blocks.count(), [&](int begin, int end) {
    for (int block = begin; block < end; ++block) fill_block(out, medium, block, floors);
  });
  CutEmission cut = cut_emission(medium);
  for (const glm::ivec3& voxel : cut.voxels) {
    const int block = out.blocks.find(voxel / 8);
    const glm::ivec3 local = voxel % 8;
    if (block >= 0) out.emission[block * std::size_t{kVoxels} + local.x + 8 * (local.y + 8 * local.z)] = glm::vec3(0);
  }
  out.emitting_parts = std::move(cut.parts);
  out.active_voxels = out.stride() - std::count(out.region.begin(), out.region.end(), std::int16_t{-1});
  out.volume = box_volumes(medium, out.blocks, out.region);

  std::vector<PhotonRegion> regions(medium.region_count());
  for (int r = 0; r < medium.region_count(); ++r) {
    const Region& region = medium.region(r);
    for (int c = 0; c < 3; ++c) {
      regions[r].sigma_s[c] = h * region.sigma_s[c];
      regions[r].sigma_a[c] = h * region.sigma_a[c];
    }
    regions[r].g = region.g;
    const int set = device.region_params[r].coefficient_set;
    regions[r].majorant_set = set >= 0 ? out.majorant_sets++ : -1;
    if (set < 0) continue;
    const auto first = device.tile_map.begin() + static_cast<std::ptrdiff_t>(set) * block_count;
    out.coefficient_tiles = std::max(out.coefficient_tiles, *std::max_element(first, first + block_count) + 1);
  }
  const std::vector<float> tiles = coefficient_tiles(medium, device, out.coefficient_tiles);
  const std::vector<float> bounds = majorants(medium, device, regions, out.majorant_sets);
  std::vector<int> block_index(block_count);
  for (int block = 0; block < block_count; ++block)
    block_index[block] = out.blocks.find(block_coordinates(block, blocks));

  out.fingerprint = 0xcbf29ce484222325ull;
  for (const auto hash :
       {fingerprint(0, regions), fingerprint(0, tiles), fingerprint(0, bounds), fingerprint(0, block_index),
        fingerprint(0, out.region), fingerprint(0, device.region_params), fingerprint(0, device.tile_map),
        fingerprint(0, device.block_region), fingerprint(0, session.read(session.march_queue(), device.distance_tiles)),
        fingerprint(0, session.read(session.march_queue(), device.index_tiles.bytes))}) {
    out.fingerprint = fingerprint(out.fingerprint, &hash, sizeof hash);
  }
  out.regions_buffer = session.upload(regions);
  out.coefficients = session.upload(tiles);
  out.majorants = session.upload(bounds);
  out.block_index = session.upload(block_index);
  out.owner = session.upload(out.region);
  return out;
}

}  // namespace turbid
