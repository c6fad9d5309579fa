// SPDX-License-Identifier: Apache-2.0
// The lattice of Bernabei et al. as printed (Eqs. 4 and 5), in double precision: seven populations per voxel, f_0 the
// one that absorption fills and that the next step empties again.
#pragma once
#include <array>
#include <vector>

namespace turbid::study {

using PrintedMatrix = std::array<std::array<double, 7>, 7>;

/// Theta of Eq. 5, rows i and columns j; sigmas per voxel edge.
PrintedMatrix printed_matrix(double sigma_s, double sigma_a);

/// A periodic cube of edge^3 voxels of one medium.
class PrintedLattice {
 public:
  PrintedLattice(int edge, double sigma_s, double sigma_a);
  std::vector<std::array<double, 7>>& populations() { return f_; }
  /// Collide by the matrix, stream f_1 .. f_6 to the neighbours along +x, -x, +y, -y, +z, -z; f_0 stays.
  void step();
  double total() const;

 private:
  int edge_;
  PrintedMatrix matrix_;
  std::vector<std::array<double, 7>> f_;
};

}  // namespace turbid::study
