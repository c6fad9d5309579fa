// SPDX-License-Identifier: Apache-2.0
// The diffusion medium in the form the lattice kernels read: collision coefficients and links, on blocks of 4^3 or 8^3.
#pragma once
#include <array>
#include <vector>

#include "host/scene/settings.h"
#include "host/transport/diffusion_medium.h"

namespace turbid {

/// Relaxation probabilities of one voxel (numerics section 1).
struct Collision {
  double p0 = 0;      ///< absorbed share
  double p1 = 0;      ///< relaxation of the odd moments
  double p2 = 0;      ///< relaxation of the even moments; p1, but 2 - p1 with two relaxation times
  double source = 1;  ///< q0 / q
};
/// s: transport coefficient per voxel, >= 0; s_a: absorption per voxel, in [0, s].
Collision collision_coefficients(CollisionVariant variant, double s, double s_a);

/// Arrays as kernels/lattice.cl reads them.
struct LatticeMedium {
  BlockGrid blocks;                        ///< of `edge`^3 voxels
  std::vector<std::int32_t> neighbours;    ///< 6 per block
  std::vector<float> collision;            ///< [channel][block][p0, p1][voxel]; 1 in voxels without light
  std::vector<std::array<float, 2>> even;  ///< [channel][block]: p0, p1 of all its voxels, or -1
  std::vector<std::int32_t> wall_block;    ///< per block: its number among those with walls, or -1
  int wall_blocks = 0;
  std::vector<float> walls;                  ///< [channel][wall block][own, other][face][row]
  std::vector<std::int32_t> first_face;      ///< per block, and their number
  std::vector<std::int32_t> faces;           ///< within blocks: place of x | of y << 9 | axis << 18
  std::vector<std::int32_t> open_towards;    ///< [face]: 0..5 if only one side is active, else -1
  std::vector<std::array<float, 4>> shares;  ///< [channel][face]
  std::vector<std::uint32_t> origin;         ///< [block][voxel]: index in the diffusion medium's [block][voxel], or ~0
  std::vector<float> source_factor;          ///< [channel][block][voxel]: q0 / q

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
