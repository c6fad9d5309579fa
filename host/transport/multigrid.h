// SPDX-License-Identifier: Apache-2.0
// The levels of the multigrid preconditioner: the fine diffusion operator and its coarser kin, on blocks of 8^3 voxels.
#pragma once
#include <array>
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

/// One level's operator. Fields are [channel][block][place of the voxel, TURBID_PACKED] with one block of zeros at the
/// end of each channel.
struct MultigridLevel {
  BlockGrid blocks;
  /// Of the finest level only: [channel][axis][block][voxel], the face towards the upper neighbour, and
  /// [channel][block][voxel], absorption plus boundary losses.
  std::vector<float> conductance, loss;
  /// What the smoother takes (kernels/lib/rounded_operator.h): conductances and 1 / the diagonal (0 where nothing is).
  std::vector<std::uint32_t> rounded;
  std::vector<std::int32_t> neighbours;  ///< 6 per block
  std::vector<std::int32_t> children;    ///< 8 per block, x first: of the next finer level; its block of zeros for none
  /// Per block and for the block of zeros: where it lies in the next coarser level.
  std::vector<std::int32_t> parent, octant;

  std::size_t stride() const { return (static_cast<std::size_t>(blocks.count()) + 1) * 512; }
};

/// Place of each voxel (x fastest) of a block: TURBID_PACKED.
const std::array<std::int16_t, 512>& packed_places();

/// Piecewise-constant coarsening by two per level, down to one voxel. A coarse conductance is the sum over the fine
/// lines that cross the face of 1 / (1/T + 1/2/T_left + 1/2/T_right), a coarse boundary loss 1 / (1/T_b + 1/2/T_n)
/// (numerics section 5): the series of what lies between the coarse centres.
std::vector<MultigridLevel> build_multigrid(const DiffusionMedium&);

}  // namespace turbid
