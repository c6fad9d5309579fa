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
      if (medium.region[index] >= 0) origin[static_cast<std::size_t>(block) * voxels + v] = static_cast<std::uint32_t>(index);
    }
  }
  return origin;
}

bool plain(const Link& link) {
  for (int i = 0; i < 6; ++i) {
    if (link.own[i] != 0.0f || link.other[i] != 1.0f) return false;
  }
  return true;
}

}  // namespace

/// Index of population whose arrivals come over a face: faces -x, +x, ... bring populations +x, -x, ... which are numbered
/// 0, 1, ... alike.
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
        // J = 2 (f_out1 / eta1^2 - f_out2 / eta2^2) / (1/eta1^2 + 1/eta2^2 + r/3): fluence / eta^2 is continuous but for r J,
        // so that the steady state has the conductance 1 / (1.5 s1/eta1^2 + r + 1.5 s2/eta2^2).
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
      k.weight = s > 0 ? p / s : 1.0;
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
      k.weight = 1 - 0.25 * s_star * s;
      break;
    }
  }
  return k;
}

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
                    .neighbours = {}, .link_block = {}, .collision = {}, .links = {}, .origin = {}, .source_factor = {}};
  for (const auto& around : out.blocks.neighbours()) out.neighbours.insert(out.neighbours.end(), around.begin(), around.end());
  out.origin = origins(medium, out.blocks);
  const std::size_t blocks = out.blocks.count(), stride = out.stride(), source_stride = medium.stride();
  out.collision.assign(4 * stride * medium.channels, 0.0f);
  out.source_factor.assign(stride * medium.channels, 0.0f);
  out.link_block.assign(blocks, -1);
  for (int c = 0; c < medium.channels; ++c) {
    const std::vector<Link> links = voxel_links(medium, c);
    if (c == 0) {
      for (std::size_t block = 0; block < blocks; ++block) {
        for (int v = 0; v < per_block; ++v) {
          const std::uint32_t at = out.origin[block * per_block + v];
          if (at != kNone && plain(links[at])) continue;
          out.link_block[block] = out.link_blocks++;
          break;
        }
      }
      out.links.assign(static_cast<std::size_t>(out.link_blocks) * 12 * per_block * medium.channels, 0.0f);
    }
    for (std::size_t block = 0; block < blocks; ++block) {
      float* collision = out.collision.data() + (c * blocks + block) * 4 * per_block;
      float* link_data = out.link_block[block] < 0
                             ? nullptr
                             : out.links.data() + (static_cast<std::size_t>(c) * out.link_blocks + out.link_block[block]) * 12 * per_block;
      for (int v = 0; v < per_block; ++v) {
        const std::uint32_t at = out.origin[block * per_block + v];
        if (at == kNone) continue;
        const Collision k = collision_coefficients(settings.collision, medium.s[c * source_stride + at],
                                                   medium.s_a[c * source_stride + at]);
        collision[v] = static_cast<float>(k.p0);
        collision[per_block + v] = static_cast<float>(k.p1);
        collision[2 * per_block + v] = static_cast<float>(k.p2);
        collision[3 * per_block + v] = static_cast<float>(k.weight);
        out.source_factor[(c * blocks + block) * per_block + v] = static_cast<float>(k.source);
        for (int i = 0; link_data && i < 6; ++i) {
          link_data[i * per_block + v] = links[at].own[i];
          link_data[(6 + i) * per_block + v] = links[at].other[i];
        }
      }
    }
  }
  return out;
}

}  // namespace turbid
