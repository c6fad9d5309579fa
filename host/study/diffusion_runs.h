// SPDX-License-Identifier: Apache-2.0
// Diffusion alone, without rays: media in voxel units, sources given in watts per voxel, solved by either solver.
#pragma once
#include <vector>

#include "host/study/small_media.h"
#include "host/transport/diffusion_medium.h"
#include "host/transport/lattice_medium.h"
#include "host/transport/marching_solver.h"

namespace turbid::study {

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
  double imbalance = 0;  ///< |emitted - absorbed - escaped| / emitted of channel 0
};
/// The engine's steady solve of q [W per voxel].
SteadyAnswer solve_steady(cl::Session&, const DiffusionMedium&, const std::vector<float>& q, float tolerance = 1e-6f);

/// The engine's lattice relaxed to an estimated error of `tolerance`; the fluence.
std::vector<float> solve_lattice(cl::Session&, const DiffusionMedium&, const std::vector<float>& q, CollisionVariant,
                                 float tolerance = 1e-5f);

}  // namespace turbid::study
