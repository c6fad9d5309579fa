// SPDX-License-Identifier: Apache-2.0
// Patches of voxels around each tile: known values inside, two rounds of extrapolation outside.
#include "host/view/source_tiles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/parallel.h"

namespace turbid {
namespace {

constexpr int kHalo = 3;  // voxels known around a tile
// Edge of a patch; the outermost voxels are never known, so that looking two voxels on needs no test of bounds.
constexpr int kRim = kHalo + 1, kPatch = TURBID_TILE_EDGE + 2 * kRim;
constexpr int kPatchVoxels = kPatch * kPatch * kPatch;

struct Patch {
  std::vector<glm::vec3> value = std::vector<glm::vec3>(kPatchVoxels);
  std::vector<char> known = std::vector<char>(kPatchVoxels);
  std::vector<std::pair<int, glm::vec3>> found;
  /// Of node (x, y, z) of the tile.
  static int index(int x, int y, int z) { return x + kRim + kPatch * (y + kRim + kPatch * (z + kRim)); }
};

/// The source of every active voxel, and whose it is: [block][voxel].
struct VoxelSources {
  std::vector<glm::vec3> value;
  std::vector<std::int16_t> region;
};

VoxelSources voxel_sources(const FluenceVolume& volume, const MediumVolume& medium, float h) {
  const std::size_t stride = volume.colour_stride();
  VoxelSources sources{std::vector<glm::vec3>(stride), std::vector<std::int16_t>(stride)};
  parallel_ranges(volume.blocks.count(), [&](int begin, int end) {
    std::vector<int> owner(512);
    std::vector<Coefficients> varying(512);
    for (int block = begin; block < end; ++block) {
      const glm::ivec3 lower = 8 * volume.blocks.coordinates(block), size(8);
      medium.read_owner(lower, size, owner);
      int read = -1;  // region that `varying` belongs to
      for (int r = 0; r < medium.region_count(); ++r) {
        if (std::find(owner.begin(), owner.end(), r) == owner.end()) continue;
        const Region& region = medium.region(r);
        if (region.heterogeneous) medium.read_coefficients(read = r, lower, size, varying);
        const Coefficients constant{region.sigma_s, region.sigma_a, region.emission, region.g};
        for (int i = 0; i < 512; ++i) {
          if (owner[i] != r) continue;
          const Coefficients& k = read == r ? varying[i] : constant;
          const glm::vec3 sigma_s = delta_scaled(k.sigma_s, k.g);
          const std::size_t at = block * std::size_t{512} + i;
          for (int c = 0; c < 3; ++c) {
            sources.value[at][c] =
                h * (sigma_s[c] * volume.fluence[c * stride + at] + volume.deposit[c * stride + at] + k.emission[c]);
          }
        }
      }
      std::copy(owner.begin(), owner.end(), sources.region.begin() + block * std::ptrdiff_t{512});
    }
  });
  return sources;
}

/// Values of a region's own voxels in a tile and `halo` voxels around it; whether all of them are known.
bool load(Patch& patch, int halo, const SourceTile& tile, const BlockGrid& grid, const VoxelSources& sources) {
  int blocks[27];
  for (int k = 0; k < 27; ++k) blocks[k] = grid.find(tile.block + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1);
  bool all = true;
  for (int z = -halo; z < TURBID_TILE_EDGE + halo; ++z) {
    const int vz = z + 8;  // from the first of the 27 blocks
    for (int y = -halo; y < TURBID_TILE_EDGE + halo; ++y) {
      const int vy = y + 8, row = 8 * (vy % 8 + 8 * (vz % 8));
      for (int x = -halo, i = Patch::index(x, y, z); x < TURBID_TILE_EDGE + halo; ++x, ++i) {
        const int vx = x + 8, block = blocks[vx / 8 + 3 * (vy / 8) + 9 * (vz / 8)];
        const std::size_t at = std::max(block, 0) * std::size_t{512} + vx % 8 + row;
        patch.known[i] = block >= 0 && sources.region[at] == tile.region;
        if (patch.known[i])
          patch.value[i] = sources.value[at];
        else
          all = false;
      }
    }
  }
  return all;
}

/// The 26 directions to a neighbour, in the order of their sums: how far on it lies in a patch, and its weight.
struct Neighbour {
  int step;
  float weight;
};
std::array<Neighbour, 26> neighbours() {
  std::array<Neighbour, 26> all;
  int k = 0;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const int squared = dx * dx + dy * dy + dz * dz)
          all[k++] = {dx + kPatch * (dy + kPatch * dz), 1.0f / static_cast<float>(squared)};
  return all;
}

/// One round: every unknown voxel next to known ones continues their trend, a * (a / b) for values b, a on the way to it,
/// held between a / 2 and 2 a; averaged over the directions that have it, nearer ones heavier. The tile and `halo` voxels
/// around it.
void extrapolate(Patch& patch, int halo) {
  static const std::array<Neighbour, 26> all = neighbours();
  patch.found.clear();
  for (int z = -halo; z < TURBID_TILE_EDGE + halo; ++z) {
    for (int y = -halo; y < TURBID_TILE_EDGE + halo; ++y) {
      for (int x = -halo, here = Patch::index(x, y, z); x < TURBID_TILE_EDGE + halo; ++x, ++here) {
        if (patch.known[here]) continue;
        glm::vec3 sum(0);
        float weights = 0;
        for (const Neighbour& n : all) {
          const int first = here + n.step, second = first + n.step;
          if (!patch.known[first]) continue;
          const glm::vec3 a = patch.value[first];
          if (patch.known[second]) {
            const glm::vec3 b = patch.value[second];
            for (int c = 0; c < 3; ++c) {
              const float guess = b[c] > 0 ? std::clamp(a[c] * (a[c] / b[c]), 0.5f * a[c], 2.0f * a[c]) : a[c];
              sum[c] += n.weight * guess;
            }
            weights += n.weight;
          } else {
            sum += 0.1f * n.weight * a;  // no trend known along this direction
            weights += 0.1f * n.weight;
          }
        }
        if (weights > 0) patch.found.emplace_back(here, sum / weights);
      }
    }
  }
  for (const auto& [index, value] : patch.found) {
    patch.value[index] = value;
    patch.known[index] = 1;
  }
}

}  // namespace

std::vector<float> make_source_tiles(const FluenceVolume& volume, const MediumVolume& medium, const DeviceMedium& device) {
  const int channels = device.features.channels, width = channels == 3 ? 4 : 1;
  // At least one: it stands in where rays find none.
  std::vector<float> tiles(std::max<std::size_t>(device.source_tiles.size(), 1) * TURBID_TILE_NODES * width, 0.0f);
  const VoxelSources sources = voxel_sources(volume, medium, device.frame.voxel_size);
  parallel_ranges(static_cast<int>(device.source_tiles.size()), [&](int begin, int end) {
    Patch patch;
    for (int tile = begin; tile < end; ++tile) {
      if (!load(patch, 0, device.source_tiles[tile], volume.blocks, sources)) {
        load(patch, kHalo, device.source_tiles[tile], volume.blocks, sources);
        extrapolate(patch, 2);  // as far as the second round looks
        extrapolate(patch, 0);
      }
      float* out = tiles.data() + static_cast<std::size_t>(tile) * TURBID_TILE_NODES * width;
      for (int z = 0; z < TURBID_TILE_EDGE; ++z) {
        for (int y = 0; y < TURBID_TILE_EDGE; ++y) {
          for (int x = 0; x < TURBID_TILE_EDGE; ++x, out += width) {
            const int at = Patch::index(x, y, z);
            const glm::vec3 value = patch.known[at] ? patch.value[at] : glm::vec3(0);
            if (channels == 3) {
              for (int c = 0; c < 3; ++c) out[c] = value[c];
            } else {
              out[0] = device.features.to_channels(value).x;
            }
          }
        }
      }
    }
  });
  return tiles;
}

}  // namespace turbid
