// SPDX-License-Identifier: Apache-2.0
// How diffuse light is held back by a surface: angular moments of the Fresnel reflectance.
#pragma once

namespace turbid {

/// For light that meets, from inside, a surface towards a medium of relative index eta_inside / eta_outside.
struct FresnelMoments {
  double r_phi = 0;  ///< integral over the hemisphere of 2 mu F(mu) dmu [1], in [0, 1)
  double r_j = 0;    ///< integral of 3 mu^2 F(mu) dmu [1], in [0, 1)
  /// Extrapolation factor A = (1 + r_j) / (1 - r_phi): the fluence vanishes 2 A D beyond the surface
  /// (Haskell et al. 1994; A(1) = 1, A(1.4) = 2.949).
  double extrapolation() const { return (1.0 + r_j) / (1.0 - r_phi); }
};

/// Unpolarised Fresnel reflectance for the cosine of incidence `mu` in (0, 1].
double fresnel_reflectance(double mu, double eta_from, double eta_to);
FresnelMoments fresnel_moments(double eta_inside, double eta_outside);

/// Jump of u = fluence / eta^2 per unit of net flux across a Fresnel interface from index eta1 to eta2 (numerics section 3):
/// r = [4 - 2 (1 - r_j12) - 2 (1 - r_j21)] / ((1 - r_phi12) eta1^2) [1].
double interface_resistance(double eta1, double eta2);

}  // namespace turbid
