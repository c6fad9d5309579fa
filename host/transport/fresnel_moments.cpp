// SPDX-License-Identifier: Apache-2.0
// Moments by the midpoint rule, split at the critical angle, beyond which all is reflected.
#include "host/transport/fresnel_moments.h"

#include <cmath>

namespace turbid {

double fresnel_reflectance(double mu, double eta_from, double eta_to) {
  const double ratio = eta_from / eta_to;
  const double cos_t_squared = 1.0 - ratio * ratio * (1.0 - mu * mu);
  if (cos_t_squared <= 0.0) return 1.0;
  const double cos_t = std::sqrt(cos_t_squared);
  const double s = (eta_from * mu - eta_to * cos_t) / (eta_from * mu + eta_to * cos_t);
  const double p = (eta_to * mu - eta_from * cos_t) / (eta_to * mu + eta_from * cos_t);
  return 0.5 * (s * s + p * p);
}

FresnelMoments fresnel_moments(double eta_inside, double eta_outside) {
  FresnelMoments result;
  if (eta_inside == eta_outside) return result;
  // Below mu_c the reflection is total; there the integrals are mu_c^2 and mu_c^3.
  const double ratio = eta_outside / eta_inside;
  const double mu_c = ratio < 1.0 ? std::sqrt(1.0 - ratio * ratio) : 0.0;
  result.r_phi = mu_c * mu_c;
  result.r_j = mu_c * mu_c * mu_c;
  constexpr int kIntervals = 4000;
  for (int i = 0; i < kIntervals; ++i) {
    // mu = mu_c + (1 - mu_c) t^2 takes the square-root edge at the critical angle out of the integrand.
    const double t = (i + 0.5) / kIntervals;
    const double mu = mu_c + (1.0 - mu_c) * t * t, dmu = 2.0 * (1.0 - mu_c) * t / kIntervals;
    const double f = fresnel_reflectance(mu, eta_inside, eta_outside);
    result.r_phi += 2.0 * mu * f * dmu;
    result.r_j += 3.0 * mu * mu * f * dmu;
  }
  return result;
}

double interface_resistance(double eta1, double eta2) {
  if (eta1 == eta2) return 0.0;
  const FresnelMoments m12 = fresnel_moments(eta1, eta2), m21 = fresnel_moments(eta2, eta1);
  return (4.0 - 2.0 * (1.0 - m12.r_j) - 2.0 * (1.0 - m21.r_j)) / ((1.0 - m12.r_phi) * eta1 * eta1);
}

}  // namespace turbid
