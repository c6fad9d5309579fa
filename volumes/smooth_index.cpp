// SPDX-License-Identifier: Apache-2.0
// The refractive index of the ambient and all smooth bodies as one field, blurred so that rays bend through their
// surfaces instead of refracting at them [Bernabei et al., section III-A].
//
// Composition: at a surface the index steps from one side to the other over one voxel, by the share of the voxel that
// the body covers, so that the blur of a slanted face has no stairs. Blur: a separable Gaussian, cut at 4 standard
// deviations.
#include <cmath>

#include "volumes/medium_grids.h"

namespace turbid {
namespace {

using Content = BlockContent<openvdb::FloatGrid>;
using BlockValues = std::array<float, kBlockVoxels>;

std::vector<float> gaussian(float sigma) {
  const int reach = static_cast<int>(std::ceil(4.0f * sigma));
  std::vector<double> exact(2 * reach + 1);
  double sum = 0;
  for (int i = -reach; i <= reach; ++i)
    sum += exact[i + reach] = sigma > 0 ? std::exp(-0.5 * i * i / (double(sigma) * sigma)) : 1.0;
  std::vector<float> weights;
  for (double w : exact) weights.push_back(static_cast<float>(w / sum));
  return weights;
}

void read_block(const openvdb::FloatGrid& grid, const GridFrame& frame, glm::ivec3 block, BlockValues& values) {
  read_box(grid, frame, block * kBlockEdge, glm::ivec3(kBlockEdge), [&](std::size_t i, float v) { values[i] = v; });
}

void read_own_index(const MediumVolume::Grids& medium, int r, glm::ivec3 block, BlockValues& values) {
  if (medium.fields[r].eta)
    read_block(*medium.fields[r].eta, medium.frame, block, values);
  else
    values.fill(medium.regions[r].eta);
}

Content to_content(glm::ivec3 block, const BlockValues& values) {
  Content content;
  if (std::all_of(values.begin(), values.end(), [&](float v) { return v == values[0]; })) {
    content.tile = values[0];
  } else {
    content.leaf = make_leaf<openvdb::FloatGrid>(block, 1.0f, true);
    for_block_voxels([&](int voxel, int offset) { content.leaf->setValueOnly(offset, values[voxel]); });
  }
  return content;
}

std::vector<int> smooth_bodies(const MediumVolume::Grids& medium) {
  std::vector<int> bodies;
  for (int r = 1; r < static_cast<int>(medium.regions.size()); ++r)
    if (medium.regions[r].smooth_surface) bodies.push_back(r);
  return bodies;
}

openvdb::FloatGrid::Ptr composed_index(const MediumVolume::Grids& medium) {
  const std::vector<int> bodies = smooth_bodies(medium);
  return grid_from_blocks<openvdb::FloatGrid>(medium.frame, medium.regions[0].eta, [&](glm::ivec3 block) {
    BlockValues eta, own, distance;
    read_own_index(medium, 0, block, eta);
    for (int r : bodies) {
      const auto& tree = medium.fields[r].signed_distance->tree();
      if (!tree.probeConstLeaf(first_voxel(block)) && tree.getValue(first_voxel(block)) > 0) continue;
      read_block(*medium.fields[r].signed_distance, medium.frame, block, distance);
      read_own_index(medium, r, block, own);
      for (int i = 0; i < kBlockVoxels; ++i) {
        const float covered = std::clamp(0.5f - distance[i], 0.0f, 1.0f);
        if (covered > 0) eta[i] = covered == 1.0f ? own[i] : eta[i] + covered * (own[i] - eta[i]);
      }
    }
    return to_content(block, eta);
  });
}

/// Blocks inside a smooth body or within `reach` voxels of one.
std::vector<char> blocks_to_blur(const MediumVolume::Grids& medium, float reach) {
  const glm::ivec3 blocks = medium.frame.blocks();
  std::vector<char> wanted(block_count(blocks));
  for (int r : smooth_bodies(medium)) {
    const auto& tree = medium.fields[r].signed_distance->tree();
    for (int i = 0; i < block_count(blocks); ++i) {
      const auto at = first_voxel(block_at(blocks, i));
      if (tree.probeConstLeaf(at) || tree.getValue(at) < 0) wanted[i] = 1;
    }
  }
  const int steps = static_cast<int>(std::ceil(reach / kBlockEdge));
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<char> before = wanted;
    const int stride = axis == 0 ? 1 : axis == 1 ? blocks.x : blocks.x * blocks.y;
    for (int i = 0; i < block_count(blocks); ++i) {
      if (!before[i]) continue;
      const int place = block_at(blocks, i)[axis];
      for (int step = -steps; step <= steps; ++step) {
        int to = place + step;
        if (medium.periodic(axis)) to = ((to % blocks[axis]) + blocks[axis]) % blocks[axis];
        if (to >= 0 && to < blocks[axis]) wanted[i + (to - place) * stride] = 1;
      }
    }
  }
  return wanted;
}

/// out[o] = sum of weights[k] * in[o + k] along one axis of a box; the box shrinks by weights.size() - 1 there.
void blur_axis(const std::vector<float>& in, glm::ivec3& size, int axis, const std::vector<float>& weights,
               std::vector<float>& out) {
  const glm::ivec3 strides(1, size.x, size.x * size.y);
  glm::ivec3 smaller = size;
  smaller[axis] -= static_cast<int>(weights.size()) - 1;
  out.resize(static_cast<std::size_t>(smaller.x) * smaller.y * smaller.z);
  float* to = out.data();
  for (int z = 0; z < smaller.z; ++z)
    for (int y = 0; y < smaller.y; ++y, to += smaller.x) {
      const float* row = &in[z * strides.z + y * strides.y];
      std::fill_n(to, smaller.x, 0.0f);
      for (std::size_t k = 0; k < weights.size(); ++k)
        for (int x = 0; x < smaller.x; ++x) to[x] += weights[k] * row[k * strides[axis] + x];
    }
  size = smaller;
}

}  // namespace

openvdb::FloatGrid::Ptr blurred_index(const MediumVolume::Grids& medium) {
  const auto composed = composed_index(medium);
  const std::vector<float> weights = gaussian(medium.smoothing_voxels);
  const int reach = static_cast<int>(weights.size()) / 2;
  const std::vector<char> wanted = blocks_to_blur(medium, 4.0f * medium.smoothing_voxels + 2.0f);
  const glm::ivec3 blocks = medium.frame.blocks();

  return grid_from_blocks<openvdb::FloatGrid>(medium.frame, medium.regions[0].eta, [&](glm::ivec3 block) {
    BlockValues result;
    if (!wanted[(block.z * blocks.y + block.y) * blocks.x + block.x]) {
      if (!medium.fields[0].eta) return Content{};
      read_own_index(medium, 0, block, result);
      return to_content(block, result);
    }
    glm::ivec3 size(kBlockEdge + 2 * reach);
    std::vector<float> box(static_cast<std::size_t>(size.x) * size.y * size.z), other;
    read_box(*composed, medium.frame, block * kBlockEdge - reach, size, [&](std::size_t i, float v) { box[i] = v; },
             {medium.periodic(0), medium.periodic(1), medium.periodic(2)});
    const auto [low, high] = std::minmax_element(box.begin(), box.end());
    if (*low == *high) {
      Content content;
      content.tile = box[0];
      return content;
    }
    const float lowest = *low, highest = *high;
    blur_axis(box, size, 2, weights, other);
    blur_axis(other, size, 1, weights, box);
    blur_axis(box, size, 0, weights, other);
    // Rounding of the weights must not push a value out of the range that it averages.
    for (int i = 0; i < kBlockVoxels; ++i) result[i] = std::clamp(other[i], lowest, highest);
    return to_content(block, result);
  });
}

}  // namespace turbid
