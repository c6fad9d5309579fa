// SPDX-License-Identifier: Apache-2.0
// The diffusion medium in the form the lattice kernels read: collision coefficients and links, on blocks of 4^3 or 8^3.
#pragma once
#include <vector>

#include "host/scene/settings.h"
#include "host/transport/diffusion_medium.h"

namespace turbid {

/// Relaxation probabilities of one voxel (numerics section 1).
struct Collision {
  double p0 = 0;      ///< absorbed share
  double p1 = 0;      ///< relaxation of the odd moments
  double p2 = 0;      ///< relaxation of the even moments
  double weight = 1;  ///< factor of the fluence
  double source = 1;  ///< q0 / q
};
/// s: transport coefficient per voxel, >= 0; s_a: absorption per voxel, in [0, s].
Collision collision_coefficients(CollisionVariant variant, double s, double s_a);

struct LatticeMedium {
  BlockGrid blocks;                        ///< of `edge`^3 voxels
  std::vector<std::int32_t> neighbours;    ///< 6 per block
  std::vector<std::int32_t> link_block;    ///< per block: its number among those with links, or -1
  int link_blocks = 0;
  std::vector<float> collision;            ///< [channel][block][p0, p1, p2, weight][voxel]
  std::vector<float> links;                ///< [channel][link block][own 0..5, other 0..5][voxel]
  std::vector<std::uint32_t> origin;       ///< [block][voxel]: index in the diffusion medium's [block][voxel], or ~0
  std::vector<float> source_factor;        ///< [channel][block][voxel]: q0 / q

  int voxels() const { return blocks.voxels_per_block(); }
  std::size_t stride() const { return static_cast<std::size_t>(blocks.count()) * voxels(); }
};

/// What crosses each of a voxel's six faces inwards: population i arrives over face i.
struct Link {
  float own[6] = {0, 0, 0, 0, 0, 0};    ///< share of what left through that face which comes back
  float other[6] = {1, 1, 1, 1, 1, 1};  ///< share of what the neighbour sent
};
/// Of one channel, [block][voxel] of the diffusion medium.
std::vector<Link> voxel_links(const DiffusionMedium&, int channel);

LatticeMedium make_lattice_medium(const DiffusionMedium&, const LatticeSettings&);

}  // namespace turbid
