// SPDX-License-Identifier: Apache-2.0
// Monte Carlo runs on small media: any medium, sources given one by one, results with their standard errors.
#pragma once
#include <vector>

#include "host/study/small_media.h"
#include "host/transport/photon_solver.h"

namespace turbid::study {

struct PhotonAnswer {
  LightSolution solution;
  std::vector<std::int16_t> region;  ///< [block][voxel], -1: not active
  std::vector<float> sigma_s;        ///< as the first flight sees it, colour 0 [1/scene unit]
  double seconds = 0;                ///< following photons

  const PhotonTallies& tallies() const { return *solution.report.photon; }
  /// Scattered and unscattered light of colour 0, and its standard error [W/scene unit^2].
  double fluence(std::size_t at) const;
  double error(std::size_t at) const { return solution.volume.standard_error[at]; }
  glm::ivec3 voxel(std::size_t at) const;
};

/// Settings of a run of so many photons.
SolverSettings photons(std::int64_t count, std::uint64_t seed = 0, int batches = 32);

/// One source of 1 W. Positions in voxels.
PhotonSource source(int kind, glm::vec3 position, glm::vec3 direction = {0, 0, 1}, int region = 0);

PhotonAnswer follow(cl::Session&, const MediumDescription&, const SolverSettings&, const std::vector<PhotonSource>&);
PhotonAnswer follow(cl::Session&, const MediumDescription&, const SolverSettings&, const LightList&,
                    const Surroundings& = {});

/// A domain of 8 x 8 x n voxels of edge `voxel`, open towards -z and +z, periodic else.
MediumDescription slab(int n, float voxel, const Material&);

/// Standard errors that lie between a value and what it should be.
inline double pull(const Estimate& estimate, double expected, int colour = 0) {
  return (estimate.value[colour] - expected) / estimate.error[colour];
}

}  // namespace turbid::study
