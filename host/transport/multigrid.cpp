// SPDX-License-Identifier: Apache-2.0
// Builds the operators of all levels on the host, each channel by itself.
#include "host/transport/multigrid.h"

#include <algorithm>
#include <array>
#include <bit>

#include "host/base/parallel.h"
#include "kernels/shared/lattice_params.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512;
constexpr int kStep[3] = {1, kEdge, kEdge* kEdge};

/// One channel of a level with boundary losses kept apart by face, as coarsening needs them.
struct Operator {
  std::array<std::vector<float>, 3> t;
  std::array<std::vector<float>, 6> boundary;
  std::vector<float> absorption;

  explicit Operator(std::size_t size) {
    for (auto& values : t) values.assign(size, 0.0f);
    for (auto& values : boundary) values.assign(size, 0.0f);
    absorption.assign(size, 0.0f);
  }
};

Operator fine_operator(const DiffusionMedium& medium, const std::vector<float>& conductance, int channel) {
  const std::size_t stride = medium.stride();
  Operator fine(stride);
  for (int axis = 0; axis < 3; ++axis) {
    const float* from = conductance.data() + (3 * channel + axis) * stride;
    fine.t[axis].assign(from, from + stride);
  }
  for (std::size_t i = 0; i < stride; ++i) {
    if (medium.region[i] >= 0) fine.absorption[i] = medium.s_a[channel * stride + i] * medium.eta_squared[i];
  }
  for (const BoundaryFace& face : medium.boundary) {
    const std::size_t i = face.block * std::size_t{kVoxels} + face.voxel;
    fine.boundary[face.face][i] =
        static_cast<float>(medium.boundary_conductance(face, channel) * medium.eta_squared[i]);
  }
  return fine;
}

BlockGrid coarse_blocks(const BlockGrid& fine) {
  const glm::ivec3 dimensions = (fine.dimensions() + 1) / 2;
  std::vector<char> active(dimensions.x * dimensions.y * dimensions.z, 0);
  for (int block = 0; block < fine.count(); ++block) {
    const glm::ivec3 at = fine.coordinates(block) / 2;
    active[at.x + dimensions.x * (at.y + dimensions.y * at.z)] = 1;
  }
  return BlockGrid(dimensions, kEdge,
                   [&](glm::ivec3 b) { return active[b.x + dimensions.x * (b.y + dimensions.y * b.z)] != 0; });
}

struct CoarseMap {
  const BlockGrid& fine;
  const BlockGrid& coarse;
  VoxelRef of(VoxelRef v) const {
    const glm::ivec3 block = fine.coordinates(v.block);
    const glm::ivec3 local(v.voxel % kEdge, (v.voxel / kEdge) % kEdge, v.voxel / (kEdge * kEdge));
    const glm::ivec3 voxel = (kEdge * block + local) / 2;
    const glm::ivec3 inside = voxel % kEdge;
    return {coarse.find(voxel / kEdge), inside.x + kEdge * (inside.y + kEdge * inside.z)};
  }
};

std::size_t flat(VoxelRef v) {
  return v.block * std::size_t{kVoxels} + v.voxel;
}

Operator coarsen(const Operator& fine, const BlockGrid& fine_blocks, const BlockGrid& coarse_blocks) {
  Operator coarse(static_cast<std::size_t>(coarse_blocks.count()) * kVoxels);
  const CoarseMap map{fine_blocks, coarse_blocks};
  auto conductance = [&](int axis, VoxelRef v) { return v.block < 0 ? 0.0f : fine.t[axis][flat(v)]; };
  for (int block = 0; block < fine_blocks.count(); ++block) {
    for (int voxel = 0; voxel < kVoxels; ++voxel) {
      const VoxelRef here{block, voxel};
      const std::size_t k = flat(here);
      const VoxelRef parent = map.of(here);
      const std::size_t parent_index = flat(parent);
      coarse.absorption[parent_index] += fine.absorption[k];
      for (int axis = 0; axis < 3; ++axis) {
        const bool upper_half = (voxel / kStep[axis]) % 2 == 1;
        const VoxelRef below = neighbour_over(fine_blocks, block, voxel, 2 * axis);
        const VoxelRef above = neighbour_over(fine_blocks, block, voxel, 2 * axis + 1);
        for (int side = 0; side < 2; ++side) {
          const float t_b = fine.boundary[2 * axis + side][k];
          if (t_b <= 0.0f) continue;
          const bool outer = (side == 1) == upper_half;
          const float t_n = outer ? (side == 1 ? conductance(axis, below) : fine.t[axis][k]) : 0.0f;
          coarse.boundary[2 * axis + side][parent_index] += t_n > 0.0f ? 1.0f / (1.0f / t_b + 0.5f / t_n) : t_b;
        }
        const float t = fine.t[axis][k];
        if (!upper_half || t <= 0.0f || above.block < 0) continue;
        const VoxelRef over = neighbour_over(coarse_blocks, parent.block, parent.voxel, 2 * axis + 1);
        const VoxelRef target = map.of(above);
        // A periodic seam may not line up on coarser levels; leaving it out there costs iterations, not correctness.
        if (over.block != target.block || over.voxel != target.voxel) continue;
        const float t_left = conductance(axis, below), t_right = conductance(axis, above);
        const float resistance =
            1.0f / t + (t_left > 0.0f ? 0.5f / t_left : 0.5f / t) + (t_right > 0.0f ? 0.5f / t_right : 0.5f / t);
        coarse.t[axis][parent_index] += 1.0f / resistance;
      }
    }
  }
  return coarse;
}

MultigridLevel empty_level(const BlockGrid& blocks, int channels) {
  MultigridLevel level{.blocks = blocks,
                       .conductance = {},
                       .loss = {},
                       .rounded = {},
                       .neighbours = {},
                       .children = {},
                       .parent = {},
                       .octant = {}};
  level.rounded.assign(level.stride() / 2 * 4 * channels, 0);
  for (const auto& around : blocks.neighbours())
    level.neighbours.insert(level.neighbours.end(), around.begin(), around.end());
  return level;
}

/// Of the face downwards; 0 where no voxel is below.
float conductance_below(const Operator& from, const MultigridLevel& level, std::size_t i, int axis) {
  const int voxel = static_cast<int>(i % kVoxels), step = kStep[axis];
  if (voxel / step % kEdge > 0) return from.t[axis][i - step];
  const std::size_t below = level.neighbours[6 * (i / kVoxels) + 2 * axis];
  return below < static_cast<std::size_t>(level.blocks.count())
             ? from.t[axis][below * kVoxels + voxel + (kEdge - 1) * step]
             : 0.0f;
}

/// Rounds to 16 bits, into one half of its word (kernels/lib/rounded_operator.h).
void put_rounded(std::uint32_t* words, std::size_t place, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t half = (bits + 0x7fff + (bits >> 16 & 1)) >> 16;
  words[place / 32 * 16 + place % 16] |= place / 16 % 2 == 0 ? half << 16 : half;
}

void store(MultigridLevel& level, const Operator& from, int channel) {
  const auto& place = packed_places();
  const std::size_t stride = level.stride();
  float* loss = level.loss.empty() ? nullptr : level.loss.data() + channel * stride;
  float* conductance = level.conductance.empty() ? nullptr : level.conductance.data() + 3 * channel * stride;
  std::uint32_t* rounded = level.rounded.data() + 4 * channel * (stride / 2);
  for (std::size_t i = 0; i < from.absorption.size(); ++i) {
    const std::size_t to = i - i % kVoxels + place[i % kVoxels];
    float sum = from.absorption[i];
    for (const auto& face : from.boundary) sum += face[i];
    if (loss) loss[to] = sum;
    for (int axis = 0; axis < 3; ++axis) {
      if (conductance) conductance[axis * stride + to] = from.t[axis][i];
      put_rounded(rounded + axis * (stride / 2), to, from.t[axis][i]);
      sum += from.t[axis][i] + conductance_below(from, level, i, axis);
    }
    if (sum > 0.0f) put_rounded(rounded + 3 * (stride / 2), to, 1.0f / sum);
  }
}

void link(MultigridLevel& fine, MultigridLevel& coarse) {
  coarse.children.assign(8 * static_cast<std::size_t>(coarse.blocks.count()), fine.blocks.count());
  for (int block = 0; block < fine.blocks.count(); ++block) {
    const glm::ivec3 at = fine.blocks.coordinates(block);
    fine.parent.push_back(coarse.blocks.find(at / 2));
    fine.octant.push_back((at.x & 1) + 2 * (at.y & 1) + 4 * (at.z & 1));
    coarse.children[8 * fine.parent.back() + fine.octant.back()] = block;
  }
  fine.parent.push_back(coarse.blocks.count());
  fine.octant.push_back(0);
}

}  // namespace

const std::array<std::int16_t, 512>& packed_places() {
  static const std::array<std::int16_t, 512> places = [] {
    std::array<std::int16_t, 512> out{};
    for (int v = 0; v < kVoxels; ++v) {
      out[v] = static_cast<std::int16_t>(TURBID_PACKED(v % kEdge, v / kEdge % kEdge, v / (kEdge * kEdge)));
    }
    return out;
  }();
  return places;
}

std::vector<MultigridLevel> build_multigrid(const DiffusionMedium& medium) {
  std::vector<MultigridLevel> levels;
  levels.push_back(empty_level(medium.blocks, medium.channels));
  levels[0].conductance.assign(levels[0].stride() * 3 * medium.channels, 0.0f);
  levels[0].loss.assign(levels[0].stride() * medium.channels, 0.0f);
  glm::ivec3 extent = medium.frame.voxels;
  while (std::max({extent.x, extent.y, extent.z}) > 1) {
    MultigridLevel next = empty_level(coarse_blocks(levels.back().blocks), medium.channels);
    link(levels.back(), next);
    levels.push_back(std::move(next));
    extent = (extent + 1) / 2;
  }
  const std::vector<float> conductance = face_conductances(medium);
  parallel_ranges(medium.channels, [&](int begin, int end) {
    for (int channel = begin; channel < end; ++channel) {
      Operator current = fine_operator(medium, conductance, channel);
      store(levels[0], current, channel);
      for (std::size_t level = 1; level < levels.size(); ++level) {
        current = coarsen(current, levels[level - 1].blocks, levels[level].blocks);
        store(levels[level], current, channel);
      }
    }
  });
  return levels;
}

}  // namespace turbid
