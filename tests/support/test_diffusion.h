// SPDX-License-Identifier: Apache-2.0
// The diffusion's equations written out once more, in double precision and on the whole grid at once: what the device's
// blocks, halos and vectors are compared with.
#pragma once
#include <vector>

#include "host/transport/diffusion_medium.h"
#include "host/transport/lattice_medium.h"
#include "host/transport/marching_solver.h"
#include "tests/support/test_media.h"

namespace turbid::test {

/// A diffusion medium of voxelised geometry whose coefficients are then drawn at random: s in [s_low, s_high] evenly in
/// its logarithm, absorption a random share of it, boundary c in [0.05, 3].
DiffusionMedium random_medium(const MediumDescription&, double s_low, double s_high, unsigned seed, int channels = 1);

/// Cubic voxels of edge 1 filled with one medium: s and s_a per voxel exactly as given, also below the floor for voids.
DiffusionMedium uniform(glm::ivec3 voxels, const std::array<FaceBoundary, 6>& faces, double s, double s_a);

/// Coordinates of the voxel at an index of [block][voxel].
glm::ivec3 voxel_of(const DiffusionMedium&, std::size_t index);

struct SteadyAnswer {
  std::vector<float> fluence;
  DiffuseLight light;  ///< where the light went
  int iterations = 0;
};
/// The engine's steady solve of q [W per voxel].
SteadyAnswer solve_steady(const DiffusionMedium&, const std::vector<float>& q, float tolerance = 1e-6f);

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

}  // namespace turbid::test
