// SPDX-License-Identifier: Apache-2.0
// Collision coefficients per variant; boundary and index-jump links.
#include "host/transport/lattice_medium.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Diffusion-medium index of every voxel of the lattice's blocks.
std::vector<std::uint32_t> origins(const DiffusionMedium& medium, const BlockGrid& blocks) {
  const int edge = blocks.edge(), voxels = blocks.voxels_per_block();
  std::vector<std::uint32_t> origin(static_cast<std::size_t>(blocks.count()) * voxels, kNone);
  for (int block = 0; block < blocks.count(); ++block) {
    for (int v = 0; v < voxels; ++v) {
      const glm::ivec3 voxel =
          edge * blocks.coordinates(block) + glm::ivec3(v % edge, (v / edge) % edge, v / (edge * edge));
      const int from = medium.blocks.find(voxel / 8);
      if (from < 0) continue;
      const glm::ivec3 local = voxel % 8;
      const std::size_t index = from * std::size_t{512} + local.x + 8 * (local.y + 8 * local.z);
      if (medium.region[index] >= 0)
        origin[static_cast<std::size_t>(block) * voxels + v] = static_cast<std::uint32_t>(index);
    }
  }
  return origin;
}

}  // namespace

/// Index of population whose arrivals come over a face: faces -x, +x, ... bring populations +x, -x, ... which are
/// numbered 0, 1, ... alike.
std::vector<Link> voxel_links(const DiffusionMedium& medium, int channel) {
  const std::size_t stride = medium.stride();
  std::vector<Link> links(stride);
  for (const BoundaryFace& face : medium.boundary) {
    Link& link = links[face.block * std::size_t{512} + face.voxel];
    const float c = face.c[channel];
    link.own[face.face] = (c - 1.0f) / (c + 1.0f);
    link.other[face.face] = 0.0f;
  }
  std::vector<float> resistance;
  if (medium.index_varies) {
    resistance.assign(3 * stride, 0.0f);
    for (const JumpFace& jump : medium.jumps) {
      resistance[jump.axis * stride + jump.block * std::size_t{512} + jump.voxel] = jump.resistance;
    }
  }
  for (int block = 0; block < medium.blocks.count(); ++block) {
    for (int v = 0; v < 512; ++v) {
      const std::size_t here = block * std::size_t{512} + v;
      if (medium.region[here] < 0) {
        for (int i = 0; i < 6; ++i) links[here].other[i] = 0.0f;
        continue;
      }
      for (int face = 0; face < 6; ++face) {
        const VoxelRef ref = neighbour_over(medium.blocks, block, v, face);
        const std::size_t there = ref.block < 0 ? 0 : ref.block * std::size_t{512} + ref.voxel;
        Link& link = links[here];
        if (ref.block < 0 || medium.region[there] < 0) {
          // Neither an open boundary (set above) nor a neighbour: a mirror.
          if (link.other[face] != 0.0f) {
            link.own[face] = 1.0f;
            link.other[face] = 0.0f;
          }
          continue;
        }
        if (!medium.index_varies) continue;
        // J = 2 (f_out1 / eta1^2 - f_out2 / eta2^2) / (1/eta1^2 + 1/eta2^2 + r/3): fluence / eta^2 is continuous but
        // for r J, so that the steady state has the conductance 1 / (1.5 s1/eta1^2 + r + 1.5 s2/eta2^2).
        const double a = 1.0 / medium.eta_squared[here], b = 1.0 / medium.eta_squared[there];
        const double r = resistance[(face / 2) * stride + (face % 2 ? here : there)];
        const double sum = a + b + r / 3.0;
        link.own[face] = static_cast<float>(1.0 - 2.0 * a / sum);
        link.other[face] = static_cast<float>(2.0 * b / sum);
      }
    }
  }
  return links;
}

Collision collision_coefficients(CollisionVariant variant, double s, double s_a) {
  Collision k;
  switch (variant) {
    case CollisionVariant::paper:
      k.p0 = s_a;
      k.p1 = k.p2 = s;
      break;
    case CollisionVariant::exponential: {
      const double p = -std::expm1(-s);
      k.p0 = s > 0 ? p * s_a / s : 0.0;
      k.p1 = k.p2 = p;
      break;
    }
    case CollisionVariant::trapezoid:
      k.p0 = s_a / (1 + 0.5 * s_a);
      k.p1 = k.p2 = s / (1 + 0.5 * s);
      k.source = 1 / (1 + 0.5 * s_a);
      break;
    case CollisionVariant::trt: {
      const double s_star = s_a / (1 + 0.25 * s_a * s);
      k.p0 = s_star / (1 + 0.5 * s_star);
      k.p1 = s / (1 + 0.5 * s);
      k.p2 = 4 / (s + 2);
      k.source = 1 / ((1 + 0.25 * s_a * s) * (1 + 0.5 * s_star));
      break;
    }
  }
  return k;
}

namespace {

using Links = std::vector<std::vector<Link>>;  // [channel][block and voxel of the diffusion medium]

bool plain(const Links& links, std::uint32_t voxel, int face) {
  return std::all_of(links.begin(), links.end(), [&](const std::vector<Link>& channel) {
    return channel[voxel].own[face] == 0.0f && channel[voxel].other[face] == 1.0f;
  });
}

void add_collision(const DiffusionMedium& medium, CollisionVariant variant, LatticeMedium& out) {
  const std::size_t blocks = out.blocks.count(), per_block = out.voxels(), stride = out.stride();
  // Where no active voxel is, everything that arrives vanishes.
  out.collision.assign(2 * stride * medium.channels, 1.0f);
  out.even.resize(blocks * medium.channels);
  out.source_factor.assign(stride * medium.channels, 0.0f);
  for (std::size_t i = 0; i < blocks * medium.channels; ++i) {
    const std::size_t c = i / blocks, block = i % blocks;
    float* p0 = out.collision.data() + i * 2 * per_block;
    float* p1 = p0 + per_block;
    for (std::size_t v = 0; v < per_block; ++v) {
      const std::uint32_t at = out.origin[block * per_block + v];
      if (at == kNone) continue;
      const Collision k =
          collision_coefficients(variant, medium.s[c * medium.stride() + at], medium.s_a[c * medium.stride() + at]);
      p0[v] = static_cast<float>(k.p0);
      p1[v] = static_cast<float>(k.p1);
      out.source_factor[i * per_block + v] = static_cast<float>(k.source);
    }
    const auto same = [&](const float* p) { return std::all_of(p, p + per_block, [&](float x) { return x == p[0]; }); };
    out.even[i] = {same(p0) && same(p1) ? p0[0] : -1.0f, p1[0]};
  }
}

/// Voxel of a block of `edge` in row `row` of a face.
int face_voxel(int edge, int face, int row) {
  const int layer = face % 2 ? edge - 1 : 0, a = row % edge, b = row / edge;
  if (face < 2) return layer + edge * row;
  return face < 4 ? a + edge * (layer + edge * b) : row + edge * edge * layer;
}

void add_walls(const Links& links, LatticeMedium& out) {
  const int edge = out.blocks.edge(), rows = edge * edge, per_block = out.voxels();
  out.wall_block.assign(out.blocks.count(), -1);
  for (int block = 0; block < out.blocks.count(); ++block) {
    for (int i = 0; i < 6 * rows; ++i) {
      const std::uint32_t at =
          out.origin[static_cast<std::size_t>(block) * per_block + face_voxel(edge, i / rows, i % rows)];
      if (at != kNone && plain(links, at, i / rows)) continue;
      out.wall_block[block] = out.wall_blocks++;
      break;
    }
  }
  const std::size_t size = static_cast<std::size_t>(out.wall_blocks) * 12 * rows;
  out.walls.assign(size * links.size(), 0.0f);
  for (int block = 0; block < out.blocks.count(); ++block) {
    if (out.wall_block[block] < 0) continue;
    for (std::size_t c = 0; c < links.size(); ++c) {
      float* own = out.walls.data() + c * size + static_cast<std::size_t>(out.wall_block[block]) * 12 * rows;
      for (int i = 0; i < 6 * rows; ++i) {
        const std::uint32_t at =
            out.origin[static_cast<std::size_t>(block) * per_block + face_voxel(edge, i / rows, i % rows)];
        if (at == kNone) continue;
        own[i] = links[c][at].own[i / rows];
        own[6 * rows + i] = links[c][at].other[i / rows];
      }
    }
  }
}

void add_faces(const Links& links, LatticeMedium& out) {
  const int edge = out.blocks.edge(), per_block = out.voxels(), steps[3] = {1, edge, edge * edge};
  std::vector<std::vector<std::array<float, 4>>> shares(links.size());
  for (int block = 0; block < out.blocks.count(); ++block) {
    out.first_face.push_back(static_cast<std::int32_t>(out.faces.size()));
    const std::uint32_t* origin = out.origin.data() + static_cast<std::size_t>(block) * per_block;
    for (int i = 0; i < 3 * per_block; ++i) {
      const int x = i / 3, axis = i % 3, y = x + steps[axis];
      if (x / steps[axis] % edge == edge - 1) continue;
      const bool below = origin[x] != kNone, above = origin[y] != kNone;
      if (!below && !above) continue;
      if (below && above && plain(links, origin[x], 2 * axis + 1) && plain(links, origin[y], 2 * axis)) continue;
      out.faces.push_back(x | y << 9 | axis << 18);
      out.open_towards.push_back(below && above ? -1 : 2 * axis + below);
      for (std::size_t c = 0; c < links.size(); ++c) {
        std::array<float, 4> share{0, 0, 0, 0};
        if (above) share[0] = links[c][origin[y]].own[2 * axis], share[1] = links[c][origin[y]].other[2 * axis];
        if (below) share[2] = links[c][origin[x]].own[2 * axis + 1], share[3] = links[c][origin[x]].other[2 * axis + 1];
        shares[c].push_back(share);
      }
    }
  }
  out.first_face.push_back(static_cast<std::int32_t>(out.faces.size()));
  for (const auto& channel : shares) out.shares.insert(out.shares.end(), channel.begin(), channel.end());
}

}  // namespace

LatticeMedium make_lattice_medium(const DiffusionMedium& medium, const LatticeSettings& settings) {
  const int edge = settings.block_edge, per_block = edge * edge * edge;
  // A lattice block exists where any of its voxels is active.
  auto active = [&](glm::ivec3 block) {
    for (int v = 0; v < per_block; ++v) {
      const glm::ivec3 voxel = edge * block + glm::ivec3(v % edge, (v / edge) % edge, v / (edge * edge));
      const int from = medium.blocks.find(voxel / 8);
      if (from < 0) return false;
      const glm::ivec3 local = voxel % 8;
      if (medium.region[from * std::size_t{512} + local.x + 8 * (local.y + 8 * local.z)] >= 0) return true;
    }
    return false;
  };
  LatticeMedium out{.blocks = BlockGrid(medium.frame.voxels / edge, edge, active, medium.blocks.periodic()),
                    .neighbours = {},
                    .collision = {},
                    .even = {},
                    .wall_block = {},
                    .walls = {},
                    .first_face = {},
                    .faces = {},
                    .open_towards = {},
                    .shares = {},
                    .origin = {},
                    .source_factor = {}};
  for (const auto& around : out.blocks.neighbours())
    out.neighbours.insert(out.neighbours.end(), around.begin(), around.end());
  out.origin = origins(medium, out.blocks);
  Links links;
  for (int c = 0; c < medium.channels; ++c) links.push_back(voxel_links(medium, c));
  add_collision(medium, settings.collision, out);
  add_walls(links, out);
  add_faces(links, out);
  return out;
}

}  // namespace turbid
