// SPDX-License-Identifier: Apache-2.0
// The medium as diffuse light sees it: coefficients of active voxels in voxel units and what joins or bounds them.
//
// In voxel units (lengths in voxels, powers in watts) with s the reduced scattering plus absorption per voxel:
//     sum over faces T_ij (u_i - u_j) + (s_a eta^2 + sum of T_b eta^2) u_i = q_i,   u = fluence / eta^2, q in watts
//     T_ij = 1 / (1.5 s_i / eta_i^2 + r_ij + 1.5 s_j / eta_j^2)         (numerics sections 1 and 3)
// and at a boundary face, with n_a the component of the surface normal along the face's axis and d_a the distance from
// the cell centre to the surface along it [voxels]:
//     c = (2 A / 3) / |n_a| + s (d_a - 1/2),   T_b = 1 / (3 (s / 2 + c)),   f_in = (c - 1) / (c + 1) f_out.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "volumes/block_grid.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// A face of an active voxel through which light leaves for good.
struct BoundaryFace {
  std::int32_t block;
  std::int16_t voxel;  ///< within the block, x fastest
  std::int8_t face;    ///< 0..5: -x, +x, -y, +y, -z, +z
  bool opaque;         ///< towards an opaque body, which absorbs what comes
  float distance;      ///< d_a, from the voxel's centre to the surface along the axis [voxels], in [0, 1]
  float c[3];          ///< per channel, >= 0.02
};

/// A face between two active voxels with a Fresnel interface in it.
struct JumpFace {
  std::int32_t block;
  std::int16_t voxel;
  std::int8_t axis;  ///< the face towards the upper neighbour along this axis
  float resistance;  ///< r_ij / |n_a|, for u
};

struct DiffusionMedium {
  DiffusionMedium(const GridFrame& grid_frame, BlockGrid active, int colours)
      : frame(grid_frame), blocks(std::move(active)), channels(colours) {}

  GridFrame frame;
  BlockGrid blocks;
  int channels = 3;
  bool index_varies = false;
  std::vector<std::int16_t> region;  ///< [block][voxel]; -1: not active
  std::vector<float> hat_volume;  ///< [block][voxel]: integral of the voxel's trilinear weight over its region [voxels]
  std::vector<float> eta_squared;       ///< [block][voxel]
  std::vector<float> g_star;            ///< [block][voxel]: scaled_g(g), what delta-Eddington leaves; empty: all 0
  std::vector<float> s, s_a, emission;  ///< [channel][block][voxel]; s floored for voids; emission [W/voxel]
  std::vector<BoundaryFace> boundary;
  std::vector<JumpFace> jumps;
  std::size_t active_voxels = 0;

  std::size_t stride() const { return static_cast<std::size_t>(blocks.count()) * 512; }
  std::size_t index(int channel, int block, int voxel) const {
    return channel * stride() + block * std::size_t{512} + voxel;
  }
  double boundary_conductance(const BoundaryFace& f, int channel) const {
    return 1.0 / (3.0 * (0.5 * s[index(channel, f.block, f.voxel)] + f.c[channel]));
  }
};

/// Conductances T[channel][axis][block][voxel] between active voxels, 0 elsewhere.
std::vector<float> face_conductances(const DiffusionMedium&);

/// For each region the smallest s per voxel that diffusion is computed with; < 0: the region takes no part.
std::vector<float> floors_of_s(const MediumVolume&);
/// Blocks that hold a voxel of a region that takes part.
BlockGrid active_blocks(const MediumVolume&, const std::vector<float>& floors);

/// With one channel, coefficients and emission are those of `first_colour` (a grey scene's brightest).
/// A clear region that only scattering regions enclose takes part as a void, with s floored at 0.1 or one mean free
/// path per crossing, whichever is more (numerics section 4): the light that diffuses into it comes out again.
DiffusionMedium make_diffusion_medium(const MediumVolume&, int channels, int first_colour = 0);

/// Block and voxel of the neighbour over a face, or block -1.
struct VoxelRef {
  int block, voxel;
};
VoxelRef neighbour_over(const BlockGrid& blocks, int block, int voxel, int face);

}  // namespace turbid
