// SPDX-License-Identifier: Apache-2.0
// Orders blocks along x, gives every voxel its place and every missing neighbour a place beyond, and lists the special faces.
#include "host/transport/global_rows.h"

#include <algorithm>
#include <numeric>

#include "host/transport/lattice_medium.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512, kRows = 64, kPad = 8;
constexpr int kStep[3] = {1, kEdge, kEdge * kEdge};

/// Where a block stands in its run.
struct Standing {
  int first = 0;   ///< place of its voxel (0, 0, 0)
  int length = 0;  ///< places from one row of the run to the next
  int order = 0;   ///< its number in row order
};

std::vector<Standing> lay_out(const BlockGrid& blocks, GlobalRows& out) {
  std::vector<int> order(blocks.count());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const glm::ivec3 p = blocks.coordinates(a), q = blocks.coordinates(b);
    return std::array{p.z, p.y, p.x} < std::array{q.z, q.y, q.x};
  });
  std::vector<Standing> standing(blocks.count());
  for (int begin = 0; begin < blocks.count();) {
    int end = begin + 1;
    while (end < blocks.count() &&
           blocks.coordinates(order[end]) == blocks.coordinates(order[end - 1]) + glm::ivec3(1, 0, 0)) {
      ++end;
    }
    const int count = end - begin, length = kEdge * count + kPad, first = out.place_count + kPad;
    for (int i = begin; i < end; ++i) standing[order[i]] = {first + kEdge * (i - begin), length, i};
    for (int row = 0; row < kRows; ++row) out.rows.push_back({first + row * length, begin, count, row});
    out.place_count += kRows * length;
    begin = end;
  }
  out.place_count += kPad;
  return standing;
}

}  // namespace

GlobalRows make_global_rows(const DiffusionMedium& medium) {
  GlobalRows out;
  const BlockGrid& blocks = medium.blocks;
  const std::vector<Standing> standing = lay_out(blocks, out);
  const std::size_t stride = medium.stride();
  out.places.resize(stride);
  out.near.resize(4 * static_cast<std::size_t>(blocks.count()));
  for (int block = 0; block < blocks.count(); ++block) {
    const Standing& here = standing[block];
    for (int v = 0; v < kVoxels; ++v) {
      out.places[block * std::size_t{kVoxels} + v] = here.first + v / kEdge * here.length + v % kEdge;
    }
    for (int face = 2; face < 6; ++face) {
      auto& near = out.near[4 * static_cast<std::size_t>(here.order) + face - 2];
      const int other = blocks.neighbours()[block][face];
      if (other >= blocks.count()) {
        near = {out.place_count, kEdge};
        out.place_count += kRows;
        continue;
      }
      const Standing& there = standing[other];
      const int facing = face % 2 ? 0 : kEdge - 1;  // its layer at the face
      near = face < 4 ? std::array{there.first + facing * there.length, kEdge * there.length}
                      : std::array{there.first + facing * kEdge * there.length, there.length};
    }
  }
  /// Place one step beyond a voxel's face.
  auto beyond = [&](int block, int v, int face) {
    const int axis = face / 2, at = (v / kStep[axis]) % kEdge, place = out.places[block * std::size_t{kVoxels} + v];
    const int sign = face % 2 ? 1 : -1;
    if (axis == 0) return place + sign;
    if (face % 2 ? at < kEdge - 1 : at > 0) return out.places[block * std::size_t{kVoxels} + v + sign * kStep[axis]];
    const auto& near = out.near[4 * static_cast<std::size_t>(standing[block].order) + face - 2];
    const int along = axis == 1 ? v / kStep[2] : v / kStep[1] % kEdge;
    return near[0] + along * near[1] + v % kEdge;
  };

  std::vector<std::vector<Link>> links;
  for (int c = 0; c < medium.channels; ++c) links.push_back(voxel_links(medium, c));
  std::vector<std::vector<std::array<float, 4>>> shares(medium.channels);
  auto plain = [&](std::size_t voxel, int face) {
    return std::all_of(links.begin(), links.end(), [&](const std::vector<Link>& channel) {
      return channel[voxel].own[face] == 0.0f && channel[voxel].other[face] == 1.0f;
    });
  };
  for (int block = 0; block < blocks.count(); ++block) {
    for (int v = 0; v < kVoxels; ++v) {
      const std::size_t here = block * std::size_t{kVoxels} + v;
      if (medium.region[here] < 0) continue;
      for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const VoxelRef ref = neighbour_over(blocks, block, v, face);
        const std::size_t there = ref.block < 0 ? 0 : ref.block * std::size_t{kVoxels} + ref.voxel;
        const bool active = ref.block >= 0 && medium.region[there] >= 0;
        const int own = out.places[here], next = beyond(block, v, face);
        if (active) {
          if (face % 2 == 0) continue;  // told by the voxel below
          const int above = out.places[there], below = beyond(ref.block, ref.voxel, face - 1);
          if (next == above && below == own && plain(here, face) && plain(there, face - 1)) continue;
          out.faces.push_back({{own, above, below, next}, axis, -1});
        } else if (face % 2) {
          out.faces.push_back({{own, next, own, next}, axis, static_cast<std::int8_t>(face)});
        } else {
          out.faces.push_back({{next, own, next, own}, axis, static_cast<std::int8_t>(face)});
        }
        for (int c = 0; c < medium.channels; ++c) {
          const Link& k = links[c][here];
          if (active) {
            const Link& up = links[c][there];
            shares[c].push_back({up.own[face - 1], up.other[face - 1], k.own[face], k.other[face]});
          } else if (face % 2) {
            shares[c].push_back({0, 0, k.own[face], 0});
          } else {
            shares[c].push_back({k.own[face], 0, 0, 0});
          }
        }
      }
    }
  }
  for (const auto& channel : shares) out.links.insert(out.links.end(), channel.begin(), channel.end());
  out.place_count = (out.place_count + kPad - 1) / kPad * kPad;
  return out;
}

}  // namespace turbid
