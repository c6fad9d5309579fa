// SPDX-License-Identifier: Apache-2.0
// See printed_lattice.h.
#include "host/study/printed_lattice.h"

namespace turbid::study {

PrintedMatrix printed_matrix(double sigma_s, double sigma_a) {
  PrintedMatrix theta{};
  for (int j = 0; j < 7; ++j) {
    theta[0][j] = j == 0 ? 0 : sigma_a;
    for (int i = 1; i < 7; ++i) {
      theta[i][j] = j == 0 ? 1.0 / 6 : sigma_s / 6;
      if (i == j) theta[i][j] += 1 - sigma_s - sigma_a;
    }
  }
  return theta;
}

PrintedLattice::PrintedLattice(int edge, double sigma_s, double sigma_a)
    : edge_(edge), matrix_(printed_matrix(sigma_s, sigma_a)), f_(static_cast<std::size_t>(edge) * edge * edge) {}

void PrintedLattice::step() {
  std::vector<std::array<double, 7>> next(f_.size());
  const auto index = [&](int x, int y, int z) {
    const int n = edge_;
    return static_cast<std::size_t>((x + n) % n + n * ((y + n) % n + n * ((z + n) % n)));
  };
  for (int z = 0; z < edge_; ++z)
    for (int y = 0; y < edge_; ++y)
      for (int x = 0; x < edge_; ++x) {
        const std::array<double, 7>& here = f_[index(x, y, z)];
        const std::size_t to[7] = {index(x, y, z),     index(x + 1, y, z), index(x - 1, y, z), index(x, y + 1, z),
                                   index(x, y - 1, z), index(x, y, z + 1), index(x, y, z - 1)};
        for (int i = 0; i < 7; ++i)
          for (int j = 0; j < 7; ++j) next[to[i]][i] += matrix_[i][j] * here[j];
      }
  f_ = std::move(next);
}

double PrintedLattice::total() const {
  double sum = 0;
  for (const auto& voxel : f_)
    for (const double f : voxel) sum += f;
  return sum;
}

}  // namespace turbid::study
