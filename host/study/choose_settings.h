// SPDX-License-Identifier: Apache-2.0
// Settings that meet an asked error at the least cost, from the error estimate of a small run and how its parts scale.
#pragma once
#include <string>

#include "host/study/error_estimate.h"

namespace turbid {

/// What the estimate depends on.
struct Resolution {
  int voxels = 64;    ///< along the domain's longest side
  float step = 0.5f;  ///< [voxels]
  float rays = 4;     ///< per voxel face
  float tolerance = 1e-4f;
};

struct ChosenSettings {
  bool photon = false;   ///< the diffusion's own error is too large for the aim: Monte Carlo to a standard error of it
  Resolution with;       ///< of steady and lattice; voxels of photon, too
  double photons = 0;    ///< of photon
  ErrorParts predicted;  ///< of steady with these
  std::string reason;    ///< one sentence: what decided
};

inline constexpr int kMostVoxels = 256;
inline constexpr double kLeastPhotons = 1e5, kMostPhotons = 2e8;  ///< the most take some minutes

/// Grid ~ voxels^-1.5 (measured 1.4 to 1.9 where bodies are curved), steps ~ step^2, rays ~ 1/rays, solve ~ tolerance,
/// model constant. Half of what the model leaves is the grid's, a tenth each that of steps, rays and the solve. Of
/// photons half the aim is the grid's and half their scatter's, `scatter_of_one` / sqrt(photons) at the estimate's
/// voxels and in inverse proportion to their size. aim > 0.
ChosenSettings choose_settings(const ErrorParts& estimate, double scatter_of_one, const Resolution& of, double aim);

}  // namespace turbid
