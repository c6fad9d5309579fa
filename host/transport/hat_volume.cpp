// SPDX-License-Identifier: Apache-2.0
// Supersamples the cells that surfaces cut; cells that lie wholly inside count an eighth for each corner.
#include "host/transport/hat_volume.h"

#include <algorithm>
#include <cmath>

#include "host/base/parallel.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512;
constexpr int kNodes = kEdge + 2;  // a block's voxels with one more on each side
constexpr int kSamples = 4;        // per cell and axis
constexpr int kBoxSamples = 8;     // per voxel and axis

/// Distances of all bodies at the nodes around one block.
struct Nodes {
  std::vector<std::vector<float>> body;  // [body][node]
  static int index(int x, int y, int z) { return x + kNodes * (y + kNodes * z); }
};

float trilinear(const std::vector<float>& values, int corner, float fx, float fy, float fz) {
  auto row = [&](int at) { return values[at] + fx * (values[at + 1] - values[at]); };
  auto plane = [&](int at) { return row(at) + fy * (row(at + kNodes) - row(at)); };
  return plane(corner) + fz * (plane(corner + kNodes * kNodes) - plane(corner));
}

int region_at(const Nodes& nodes, int corner, float fx, float fy, float fz) {
  for (int r = static_cast<int>(nodes.body.size()) - 1; r >= 1; --r) {
    if (trilinear(nodes.body[r], corner, fx, fy, fz) < 0.0f) return r;
  }
  return 0;
}

/// True if every corner of the cell has one sign for every body: one region fills the cell.
bool uniform(const Nodes& nodes, int corner) {
  for (std::size_t r = 1; r < nodes.body.size(); ++r) {
    const std::vector<float>& d = nodes.body[r];
    const bool inside = d[corner] < 0.0f;
    for (int k = 1; k < 8; ++k) {
      const int at = corner + (k & 1) + kNodes * ((k >> 1 & 1) + kNodes * (k >> 2));
      if ((d[at] < 0.0f) != inside) return false;
    }
  }
  return true;
}

/// Distances of all bodies around one block; true if a surface may pass.
bool read_nodes(const MediumVolume& medium, glm::ivec3 lower, Nodes& nodes) {
  bool mixed = false;
  nodes.body.resize(medium.region_count());
  for (int r = 1; r < medium.region_count(); ++r) {
    nodes.body[r].resize(kNodes * kNodes * kNodes);
    medium.read_signed_distance(r, lower - 1, glm::ivec3(kNodes), nodes.body[r]);
    const auto [low, high] = std::minmax_element(nodes.body[r].begin(), nodes.body[r].end());
    mixed |= *low < 0.0f && *high >= 0.0f;
  }
  return mixed;
}

void fill_block(const MediumVolume& medium, const DiffusionMedium& diffusion, int block, float* out) {
  const glm::ivec3 lower = kEdge * diffusion.blocks.coordinates(block);
  Nodes nodes;
  const bool mixed = read_nodes(medium, lower, nodes);
  const std::int16_t* region = diffusion.region.data() + block * std::size_t{kVoxels};
  if (!mixed) {
    for (int v = 0; v < kVoxels; ++v) out[v] = 1.0f;
    return;
  }
  auto add = [&](int x, int y, int z, int r, float weight) {
    if (x < 0 || y < 0 || z < 0 || x >= kEdge || y >= kEdge || z >= kEdge) return;
    const int v = x + kEdge * (y + kEdge * z);
    if (region[v] == r) out[v] += weight;
  };
  std::fill(out, out + kVoxels, 0.0f);
  for (int z = -1; z < kEdge; ++z) {
    for (int y = -1; y < kEdge; ++y) {
      for (int x = -1; x < kEdge; ++x) {
        const int corner = Nodes::index(x + 1, y + 1, z + 1);
        if (uniform(nodes, corner)) {
          const int r = region_at(nodes, corner, 0, 0, 0);
          for (int k = 0; k < 8; ++k) add(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2), r, 0.125f);
          continue;
        }
        constexpr float kWeight = 1.0f / (kSamples * kSamples * kSamples);
        for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
          const float fx = (i % kSamples + 0.5f) / kSamples, fy = (i / kSamples % kSamples + 0.5f) / kSamples,
                      fz = (i / (kSamples * kSamples) + 0.5f) / kSamples;
          const int r = region_at(nodes, corner, fx, fy, fz);
          for (int k = 0; k < 8; ++k) {
            const float w = (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy) * (k & 4 ? fz : 1 - fz);
            add(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2), r, kWeight * w);
          }
        }
      }
    }
  }
  for (int v = 0; v < kVoxels; ++v) out[v] = std::max(out[v], 0.02f);
}

/// True if one region fills the eight cells that meet at a voxel's centre and hold an eighth of it each.
bool whole(const Nodes& nodes, glm::ivec3 voxel) {
  for (int k = 0; k < 8; ++k)
    if (!uniform(nodes, Nodes::index(voxel.x + (k & 1), voxel.y + (k >> 1 & 1), voxel.z + (k >> 2)))) return false;
  return true;
}

constexpr int kBoxPoints = kBoxSamples * kBoxSamples * kBoxSamples;

/// Point i of the samples of a voxel, from its lower corner [voxels].
glm::vec3 sample_point(int i) {
  return (glm::vec3(i % kBoxSamples, i / kBoxSamples % kBoxSamples, i / (kBoxSamples * kBoxSamples)) + 0.5f) /
         static_cast<float>(kBoxSamples);
}

int region_of_sample(const Nodes& nodes, glm::ivec3 voxel, int i) {
  const glm::vec3 place = sample_point(i) + 0.5f;  // from the node before the voxel's own
  const glm::ivec3 cell(place);
  const glm::vec3 f = place - glm::vec3(cell);
  return region_at(nodes, Nodes::index(voxel.x + cell.x, voxel.y + cell.y, voxel.z + cell.z), f.x, f.y, f.z);
}

/// Volume of a voxel's part in region r.
float box_volume(const Nodes& nodes, glm::ivec3 voxel, int r) {
  if (whole(nodes, voxel)) return 1.0f;
  int inside = 0;
  for (int i = 0; i < kBoxPoints; ++i) inside += region_of_sample(nodes, voxel, i) == r;
  return std::max(static_cast<float>(inside) / kBoxPoints, 0.02f);
}

void add_parts(const Nodes& nodes, glm::ivec3 lower, glm::ivec3 voxel, std::vector<VoxelPart>& out) {
  std::vector<VoxelPart> parts(nodes.body.size());
  for (int i = 0; i < kBoxPoints; ++i) {
    VoxelPart& part = parts[static_cast<std::size_t>(region_of_sample(nodes, voxel, i))];
    if (part.volume == 0.0f) part.inside = sample_point(i);
    part.volume += 1.0f / kBoxPoints;
  }
  for (std::size_t r = 0; r < parts.size(); ++r)
    if (parts[r].volume > 0.0f) out.push_back({lower + voxel, static_cast<int>(r), parts[r].volume, parts[r].inside});
}

}  // namespace

std::vector<float> box_volumes(const MediumVolume& medium, const BlockGrid& blocks,
                               const std::vector<std::int16_t>& region) {
  std::vector<float> result(region.size(), 0.0f);
  parallel_ranges(blocks.count(), [&](int begin, int end) {
    Nodes nodes;
    for (int block = begin; block < end; ++block) {
      const bool mixed = read_nodes(medium, kEdge * blocks.coordinates(block), nodes);
      for (int v = 0; v < kVoxels; ++v) {
        const std::size_t at = block * std::size_t{kVoxels} + v;
        if (region[at] < 0) continue;
        result[at] = mixed ? box_volume(nodes, {v % kEdge, v / kEdge % kEdge, v / (kEdge * kEdge)}, region[at]) : 1.0f;
      }
    }
  });
  return result;
}

std::vector<VoxelPart> parts_of_cut_voxels(const MediumVolume& medium) {
  const glm::ivec3 blocks = medium.frame().blocks();
  std::vector<std::vector<VoxelPart>> of_block(static_cast<std::size_t>(blocks.x) * blocks.y * blocks.z);
  parallel_ranges(static_cast<int>(of_block.size()), [&](int begin, int end) {
    Nodes nodes;
    for (int block = begin; block < end; ++block) {
      const glm::ivec3 lower =
          kEdge * glm::ivec3(block % blocks.x, block / blocks.x % blocks.y, block / (blocks.x * blocks.y));
      if (!read_nodes(medium, lower, nodes)) continue;
      for (int v = 0; v < kVoxels; ++v) {
        const glm::ivec3 voxel(v % kEdge, v / kEdge % kEdge, v / (kEdge * kEdge));
        if (!whole(nodes, voxel)) add_parts(nodes, lower, voxel, of_block[block]);
      }
    }
  });
  std::vector<VoxelPart> result;
  for (const std::vector<VoxelPart>& parts : of_block) result.insert(result.end(), parts.begin(), parts.end());
  return result;
}

std::vector<float> hat_volumes(const MediumVolume& medium, const DiffusionMedium& diffusion) {
  std::vector<float> result(diffusion.stride());
  parallel_ranges(diffusion.blocks.count(), [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      fill_block(medium, diffusion, block, result.data() + block * std::size_t{kVoxels});
    }
  });
  return result;
}

}  // namespace turbid
