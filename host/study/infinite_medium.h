// SPDX-License-Identifier: Apache-2.0
// Exact transport of light around an isotropic point source in an infinite medium that scatters isotropically.
#pragma once

namespace turbid::study {

/// Attenuation per mean free path of the light far from its source: kappa with 1 = (w / kappa) artanh kappa.
/// `albedo` in (0, 1).
double transport_attenuation(double albedo);

/// Fluence [1 / mfp^2] at `r` mean free paths from a source of 1 W, what never scattered included (Case, de Hoffmann
/// and Placzek 1953).
double point_source_fluence(double albedo, double r);

}  // namespace turbid::study
