// SPDX-License-Identifier: Apache-2.0
// Hand-written C++ of the blockwise lattice (kernels/lattice.cl with blocks of 8^3 and two relaxation times) on a cube
// whose six sides reflect alike: what the kernel's speed is held against. Compiled for the machine it runs on.
#pragma once
#include <cstddef>
#include <vector>

namespace turbid::reference {

/// Fields are [channel][block][voxel], blocks of 8^3 voxels and voxels within them x fastest.
struct LatticeCube {
  int n = 0;  ///< voxels along a side, a multiple of 8
  int channels = 1;
  float reflection = 0;       ///< R of its sides: f_in = R f_out
  std::vector<float> p0, p1;  ///< absorbed share, relaxation of the odd moments
  std::vector<float> q0;      ///< source per step
};

class BlockLattice {
 public:
  /// The cube must outlive it. Populations are zero at first.
  BlockLattice(const LatticeCube&, int threads);
  /// `count` exchanges of interfaces with `inner` (even) steps before each.
  void sweep(int count, int inner);
  /// After the last step: [channel][block][voxel].
  const std::vector<float>& fluence() const { return fluence_; }

 private:
  void block_steps(int channel, int block, int inner, bool last);

  const LatticeCube& cube_;
  int threads_, side_, blocks_;  // side_: blocks along a side
  int current_ = 0;              // which interfaces are read next
  std::vector<float> populations_, fluence_;
  std::vector<float> interfaces_[2];  // [channel][block and one of zeros][population][64]
};

}  // namespace turbid::reference
