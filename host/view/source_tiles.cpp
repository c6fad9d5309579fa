// SPDX-License-Identifier: Apache-2.0
// Patches of voxels around each tile: known values inside, two rounds of extrapolation outside.
#include "host/view/source_tiles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "host/base/parallel.h"

namespace turbid {
namespace {

constexpr int kHalo = 3;  // voxels known around a tile
// Edge of a patch; the outermost voxels are never known, so that looking two voxels on needs no test of bounds.
constexpr int kRim = kHalo + 1, kPatch = TURBID_TILE_EDGE + 2 * kRim;
constexpr int kPatchVoxels = kPatch * kPatch * kPatch;
constexpr float kFaintest = 1e-36f;  // has a finite inverse

struct alignas(16) Colour4 {
  float c[4] = {0, 0, 0, 0};  // the fourth stays 0: four at once are one instruction
};

struct Patch {
  std::vector<Colour4> value = std::vector<Colour4>(kPatchVoxels);
  std::vector<Colour4> trend = std::vector<Colour4>(kPatchVoxels);  // 1 / value; 0 where there is none
  std::vector<char> known = std::vector<char>(kPatchVoxels);
  std::array<std::uint32_t, kPatch * kPatch> rows{};  // the same, a bit per voxel of each row along x
  std::vector<std::pair<int, Colour4>> found;
  void set(int index, const Colour4& colour) {
    known[index] = 1;
    rows[index / kPatch] |= 1u << index % kPatch;
    value[index] = colour;
    for (int k = 0; k < 4; ++k) trend[index].c[k] = colour.c[k] > kFaintest ? 1.0f / colour.c[k] : 0.0f;
  }
  /// Of node (x, y, z) of the tile, and of its row.
  static int row(int y, int z) { return y + kRim + kPatch * (z + kRim); }
  static int index(int x, int y, int z) { return x + kRim + kPatch * row(y, z); }
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
      patch.rows[Patch::row(y, z)] = 0;
      for (int x = -halo, i = Patch::index(x, y, z); x < TURBID_TILE_EDGE + halo; ++x, ++i) {
        const int vx = x + 8, block = blocks[vx / 8 + 3 * (vy / 8) + 9 * (vz / 8)];
        const std::size_t at = std::max(block, 0) * std::size_t{512} + vx % 8 + row;
        patch.known[i] = 0;
        if (block >= 0 && sources.region[at] == tile.region)
          patch.set(i, {{sources.value[at].x, sources.value[at].y, sources.value[at].z, 0}});
        else
          all = false;
      }
    }
  }
  return all;
}

/// A voxel's neighbours by bits of a mask, three to a row: how far on each lies in a patch, and its weight.
struct Neighbour {
  int step;
  float weight;
};
std::array<Neighbour, 27> neighbours() {
  std::array<Neighbour, 27> all{};
  for (int k = 0; k < 27; ++k) {
    const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1, squared = dx * dx + dy * dy + dz * dz;
    if (squared > 0) all[k] = {dx + kPatch * (dy + kPatch * dz), 1.0f / static_cast<float>(squared)};
  }
  return all;
}

/// One round: every unknown voxel next to known ones continues their trend, a * (a / b) for values b, a on the way to it,
/// held between a / 2 and 2 a; averaged over the directions that have it, nearer ones heavier. The tile and `halo` voxels
/// around it.
void extrapolate(Patch& patch, int halo) {
  static const std::array<Neighbour, 27> all = neighbours();
  const std::uint32_t inside = ((1u << (TURBID_TILE_EDGE + 2 * halo)) - 1) << (kRim - halo);
  patch.found.clear();
  for (int z = -halo; z < TURBID_TILE_EDGE + halo; ++z) {
    for (int y = -halo; y < TURBID_TILE_EDGE + halo; ++y) {
      std::uint32_t around[9], near = 0;
      for (int k = 0; k < 9; ++k) {
        around[k] = patch.rows[Patch::row(y + k % 3 - 1, z + k / 3 - 1)];
        near |= around[k] | around[k] << 1 | around[k] >> 1;
      }
      std::uint32_t wanted = near & ~around[4] & inside;
      for (; wanted != 0; wanted &= wanted - 1) {
        const int bit = std::countr_zero(wanted), here = bit + kPatch * Patch::row(y, z);
        std::uint32_t known = 0;
        for (int k = 0; k < 9; ++k) known |= (around[k] >> (bit - 1) & 7u) << 3 * k;
        Colour4 sum;
        float weights = 0;
        for (; known != 0; known &= known - 1) {
          const Neighbour& n = all[std::countr_zero(known)];
          const int first = here + n.step, second = first + n.step;
          const Colour4 a = patch.value[first], b = patch.trend[second];
          const bool trend = patch.known[second];
          const float weight = trend ? n.weight : 0.1f * n.weight;  // where no trend is known along this direction
          for (int k = 0; k < 4; ++k) {
            const float on = std::min(std::max(a.c[k] * (a.c[k] * b.c[k]), 0.5f * a.c[k]), 2.0f * a.c[k]);
            sum.c[k] += weight * (trend && b.c[k] > 0 ? on : a.c[k]);
          }
          weights += weight;
        }
        for (float& k : sum.c) k /= weights;
        patch.found.emplace_back(here, sum);
      }
    }
  }
  for (const auto& [index, value] : patch.found) patch.set(index, value);
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
            if (!patch.known[at]) continue;
            const Colour4& value = patch.value[at];
            if (channels == 3) {
              for (int c = 0; c < 3; ++c) out[c] = value.c[c];
            } else {
              out[0] = device.features.to_channels({value.c[0], value.c[1], value.c[2]}).x;
            }
          }
        }
      }
    }
  });
  return tiles;
}

}  // namespace turbid
