// SPDX-License-Identifier: Apache-2.0
// What diffusion gets wrong in a medium: a formula in albedo, optical thickness and anisotropy.
#pragma once
#include "host/study/companion.h"
#include "host/transport/solver.h"

namespace turbid {

/// What light sees of a medium, as means over its voxels weighted with the square of the fluence (the weight that
/// errors have in a relative L2 norm).
struct MediumCharacter {
  double diffuse_share = 0;  ///< ||diffuse fluence|| / ||total fluence|| [-]: only diffuse light can be wrong
  double albedo = 0;         ///< transport albedo (1 - g) sigma_s / ((1 - g) sigma_s + sigma_a) [-]
  double depth = 0;          ///< transport optical depth: sigma_tr times the mean chord [-]
  double chord = 0;          ///< 4 V / S [scene units]
  double g = 0;              ///< mean cosine [-]
  double eta = 1;            ///< refractive index [-]
};

MediumCharacter medium_character(const FluenceVolume& solution, const SampledFluence& total);

/// Relative L2 error of the total fluence by the diffusion model, as a bound that holds in 95 % of cases.
double model_error(const MediumCharacter&);

}  // namespace turbid
