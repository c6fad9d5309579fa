// SPDX-License-Identifier: Apache-2.0
//     4 pi r phi(r) = 2 k^2 (1 - k^2) / (w (k^2 - 1 + w)) e^-kr + integral_0^1 g(mu) e^(-r/mu) dmu / mu^2
//     g(mu) = 1 / ((1 - w mu artanh mu)^2 + (pi w mu / 2)^2),   1 = (w / k) artanh k
#include "host/study/infinite_medium.h"

#include <cmath>
#include <numbers>

namespace turbid::study {

double transport_attenuation(double albedo) {
  double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const double k = 0.5 * (low + high);
    // artanh(k) / k rises with k.
    (albedo * std::atanh(k) < k ? low : high) = k;
  }
  return 0.5 * (low + high);
}

double point_source_fluence(double albedo, double r) {
  const double pi = std::numbers::pi, k = transport_attenuation(albedo), k2 = k * k;
  double sum = 2 * k2 * (1 - k2) / (albedo * (k2 - 1 + albedo)) * std::exp(-k * r);
  // With t = 1 / mu - 1 from 0 on, dmu / mu^2 = dt: the integrand falls as e^-rt. Simpson's rule in t = v^2, which
  // takes out the steep begin near mu = 1.
  const double end = std::sqrt(45 / r);
  constexpr int kParts = 2000;
  for (int i = 0; i <= kParts; ++i) {
    const double v = end * i / kParts, mu = 1 / (1 + v * v);
    if (i == 0) continue;  // g = 0 at mu = 1, and dt = 2 v dv
    const double a = 1 - albedo * mu * std::atanh(mu), b = 0.5 * pi * albedo * mu;
    const double weight = (i == kParts ? 1 : i % 2 ? 4 : 2) * end / kParts / 3;
    sum += weight * 2 * v / (a * a + b * b) * std::exp(-r / mu);
  }
  return sum / (4 * pi * r);
}

}  // namespace turbid::study
