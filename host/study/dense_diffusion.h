// SPDX-License-Identifier: Apache-2.0
// The diffusion's equations written out once more, in double precision and on the whole grid at once: what the device's
// blocks, halos and vectors are compared with, and where identities hold to 1e-12.
#pragma once
#include <array>
#include <vector>

#include "host/scene/settings.h"
#include "host/transport/diffusion_medium.h"

namespace turbid::study {

/// One channel of a diffusion medium, addressed by voxel coordinates.
class DenseDiffusion {
 public:
  DenseDiffusion(const DiffusionMedium&, int channel);

  /// Steady operator: (A u)_i = sum T (u_i - u_j) + (s_a + sum T_b) eta^2 u_i, in watts; u and the result as
  /// [block][voxel].
  std::vector<double> apply(const std::vector<double>& u) const;

  /// Lattice state: populations after collision, +x, -x, +y, -y, +z, -z per [block][voxel].
  using Populations = std::vector<std::array<double, 6>>;
  struct StepResult {
    std::vector<double> fluence;
    double absorbed = 0, escaped = 0;
  };
  /// One step of the whole lattice: stream, collide. q [W].
  StepResult step(Populations&, CollisionVariant, const std::vector<double>& q) const;

 private:
  enum class Kind { inner, boundary, mirror };
  struct Face {
    Kind kind = Kind::mirror;
    std::size_t other = 0;
    double c = 0;           ///< boundary
    double resistance = 0;  ///< jump
  };
  std::size_t size_ = 0;
  std::vector<char> active_;
  std::vector<double> s_, s_a_, eta_squared_;
  std::vector<std::array<Face, 6>> faces_;
};

}  // namespace turbid::study
