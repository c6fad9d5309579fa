// SPDX-License-Identifier: Apache-2.0
// Orders blocks along x, gives every voxel its place, every side of a block its neighbour or wall, and lists the
// special faces.
#include "host/transport/global_rows.h"

#include <algorithm>
#include <numeric>

#include "host/transport/lattice_medium.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512, kRows = 64, kPad = 8;

/// Where a block stands in the order of places.
struct Standing {
  int first = 0;    ///< place of its voxel (0, 0, 0)
  int along_y = 0;  ///< places from one row to the next in y,
  int along_z = 0;  ///< and in z
};

/// Places run along x through neighbouring blocks, then along y through all blocks of a layer, then along z, as in one
/// array where the domain is a full box: long streams of memory. `sorted`: blocks in that order.
std::vector<Standing> lay_out(const BlockGrid& blocks, const std::vector<int>& sorted, GlobalRows& out) {
  std::vector<Standing> standing(blocks.count());
  const auto at = [&](int i) { return blocks.coordinates(sorted[i]); };
  const auto end_of = [&](int begin, const auto& together) {
    int end = begin + 1;
    while (end < blocks.count() && together(end)) ++end;
    return end;
  };
  for (int layer = 0; layer < blocks.count();) {
    const int layer_end = end_of(layer, [&](int i) { return at(i).z == at(layer).z; });
    int height = 0;
    for (int line = layer; line < layer_end;) {
      const int line_end = end_of(line, [&](int i) { return at(i).z == at(line).z && at(i).y == at(line).y; });
      int length = 0;
      for (int i = line; i < line_end; ++i) {
        const bool starts = i == line || at(i).x != at(i - 1).x + 1;
        if (starts && i > line) length += kPad;
        standing[sorted[i]].first = out.place_count + kPad + height + length;
        length += kEdge;
      }
      length += kPad;
      for (int i = line; i < line_end; ++i) standing[sorted[i]].along_y = length;
      height += kEdge * length;
      line = line_end;
    }
    for (int i = layer; i < layer_end; ++i) standing[sorted[i]].along_z = height;
    out.place_count += kEdge * height;
    layer = layer_end;
  }
  out.place_count += kPad;
  return standing;
}

void add_rows(const BlockGrid& blocks, const std::vector<int>& sorted, const std::vector<Standing>& standing,
              GlobalRows& out) {
  for (int begin = 0; begin < blocks.count();) {
    int end = begin + 1;
    while (end < blocks.count() &&
           blocks.coordinates(sorted[end]) == blocks.coordinates(sorted[end - 1]) + glm::ivec3(1, 0, 0)) {
      ++end;
    }
    const Standing& here = standing[sorted[begin]];
    for (int row = 0; row < kRows; ++row) {
      out.rows.push_back(
          {here.first + row % kEdge * here.along_y + row / kEdge * here.along_z, begin, end - begin, row});
    }
    begin = end;
  }
  std::sort(out.rows.begin(), out.rows.end());
}

using Links = std::vector<std::vector<Link>>;  // [channel][block and voxel of the diffusion medium]

/// What lies beyond the ends of every row.
void add_ends(const BlockGrid& blocks, const std::vector<int>& sorted, const std::vector<Standing>& standing,
              const Links& links, GlobalRows& out) {
  const std::size_t rows = out.rows.size();
  out.ends.resize(rows);
  out.end_walls.assign(rows * links.size(), {0.0f, 0.0f});
  for (std::size_t i = 0; i < rows; ++i) {
    const auto& row = out.rows[i];
    out.ends[i][2] = standing[sorted[row[1]]].along_y;
    out.ends[i][3] = standing[sorted[row[1]]].along_z;
    for (int side = 0; side < 2; ++side) {
      const int block = sorted[side ? row[1] + row[2] - 1 : row[1]], other = blocks.neighbours()[block][side];
      const int v = row[3] * kEdge, last = kEdge - 1;
      out.ends[i][side] =
          other >= blocks.count() ? -1 : out.places[other * std::size_t{kVoxels} + v + (side ? 0 : last)];
      for (std::size_t c = 0; out.ends[i][side] < 0 && c < links.size(); ++c) {
        out.end_walls[c * rows + i][side] = links[c][block * std::size_t{kVoxels} + v + (side ? last : 0)].own[side];
      }
    }
  }
}

/// What lies beyond the sides of every block across y and z.
void add_sides(const BlockGrid& blocks, const std::vector<Standing>& standing, const Links& links, GlobalRows& out) {
  out.near.resize(4 * static_cast<std::size_t>(blocks.count()));
  std::vector<std::vector<float>> walls(links.size());
  for (int block = 0; block < blocks.count(); ++block) {
    for (int face = 2; face < 6; ++face) {
      auto& near = out.near[4 * static_cast<std::size_t>(out.order[block]) + face - 2];
      const int other = blocks.neighbours()[block][face];
      if (other < blocks.count()) {
        const Standing& there = standing[other];
        const int facing = face % 2 ? 0 : kEdge - 1;  // its layer at the face
        near = face < 4 ? std::array{there.first + facing * there.along_y, there.along_z}
                        : std::array{there.first + facing * there.along_z, there.along_y};
        continue;
      }
      near = {-1 - out.wall_count++, 0};
      const int layer = face % 2 ? kEdge - 1 : 0;
      for (std::size_t c = 0; c < links.size(); ++c) {
        for (int i = 0; i < kEdge * kEdge; ++i) {
          const int x = i % kEdge, along = i / kEdge;
          const int v = x + kEdge * (face < 4 ? layer + kEdge * along : along + kEdge * layer);
          walls[c].push_back(links[c][block * std::size_t{kVoxels} + v].own[face]);
        }
      }
    }
  }
  for (const auto& channel : walls) out.walls.insert(out.walls.end(), channel.begin(), channel.end());
}

void add_faces(const DiffusionMedium& medium, const Links& links, GlobalRows& out) {
  std::vector<std::vector<std::array<float, 4>>> shares(links.size());
  auto plain = [&](std::size_t voxel, int face) {
    return std::all_of(links.begin(), links.end(), [&](const std::vector<Link>& channel) {
      return channel[voxel].own[face] == 0.0f && channel[voxel].other[face] == 1.0f;
    });
  };
  for (int block = 0; block < medium.blocks.count(); ++block) {
    for (int v = 0; v < kVoxels; ++v) {
      const std::size_t here = block * std::size_t{kVoxels} + v;
      if (medium.region[here] < 0) continue;
      for (int face = 0; face < 6; ++face) {
        const VoxelRef ref = neighbour_over(medium.blocks, block, v, face);
        if (ref.block < 0) continue;  // a wall
        const std::size_t there = ref.block * std::size_t{kVoxels} + ref.voxel;
        const bool active = medium.region[there] >= 0, upper = face % 2;
        if (active && (!upper || (plain(here, face) && plain(there, face - 1)))) continue;  // told by the voxel below
        const int own = out.places[here], next = out.places[there], axis = face / 2;
        out.faces.push_back({upper ? std::array{own, next, axis, 0} : std::array{next, own, axis, 0},
                             static_cast<std::int8_t>(active ? -1 : face)});
        for (std::size_t c = 0; c < links.size(); ++c) {
          const Link& k = links[c][here];
          if (active) {
            const Link& above = links[c][there];
            shares[c].push_back({above.own[face - 1], above.other[face - 1], k.own[face], k.other[face]});
          } else if (upper) {
            shares[c].push_back({0, 0, k.own[face], 0});
          } else {
            shares[c].push_back({k.own[face], 0, 0, 0});
          }
        }
      }
    }
  }
  for (const auto& channel : shares) out.links.insert(out.links.end(), channel.begin(), channel.end());
}

}  // namespace

GlobalRows make_global_rows(const DiffusionMedium& medium) {
  GlobalRows out;
  const BlockGrid& blocks = medium.blocks;
  std::vector<int> sorted(blocks.count());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(), [&](int a, int b) {
    const glm::ivec3 p = blocks.coordinates(a), q = blocks.coordinates(b);
    return std::array{p.z, p.y, p.x} < std::array{q.z, q.y, q.x};
  });
  out.order.resize(blocks.count());
  for (int i = 0; i < blocks.count(); ++i) out.order[sorted[i]] = i;
  const std::vector<Standing> standing = lay_out(blocks, sorted, out);
  add_rows(blocks, sorted, standing, out);
  out.places.resize(medium.stride());
  for (int block = 0; block < blocks.count(); ++block) {
    const Standing& here = standing[block];
    for (int v = 0; v < kVoxels; ++v) {
      const int x = v % kEdge, y = v / kEdge % kEdge, z = v / (kEdge * kEdge);
      out.places[block * std::size_t{kVoxels} + v] = here.first + z * here.along_z + y * here.along_y + x;
    }
  }
  Links links;
  for (int c = 0; c < medium.channels; ++c) links.push_back(voxel_links(medium, c));
  add_ends(blocks, sorted, standing, links, out);
  add_sides(blocks, standing, links, out);
  add_faces(medium, links, out);
  out.place_count = (out.place_count + kPad - 1) / kPad * kPad;
  return out;
}

}  // namespace turbid
