// SPDX-License-Identifier: Apache-2.0
// Beer and Lambert along a segment with constant coefficients.
#ifndef TURBID_LIB_ATTENUATION_H
#define TURBID_LIB_ATTENUATION_H
#include "lib/colour.h"

// The transmittance's mean over a segment of optical depth x, (1 - exp(-x)) / x: what the segment scatters and absorbs is
// power * sigma * length times this. Series for the depths of nearly all steps, to 2e-7.
#define MEAN_TRANSMITTANCE_SERIES(x)                                                                          \
  (1.0f - (x) * (0.5f - (x) * (1.0f / 6.0f - (x) * (1.0f / 24.0f - (x) * (1.0f / 120.0f - (x) *               \
          (1.0f / 720.0f - (x) * (1.0f / 5040.0f - (x) * (1.0f / 40320.0f))))))))

// The same up to a depth of THIN_DEPTH, to half a unit in the last place.
#define THIN_DEPTH 0.05f
#define THIN_MEAN_TRANSMITTANCE(x) (1.0f - (x) * (0.5f - (x) * (1.0f / 6.0f - (x) * (1.0f / 24.0f))))

static ALWAYS_INLINE Colour mean_transmittance(Colour depth) {
  Colour mean = MEAN_TRANSMITTANCE_SERIES(depth);
  if (colour_max(depth) > 0.5f) mean = depth > 0.5f ? -expm1(-depth) / fmax(depth, 0.5f) : mean;
  return mean;
}

#endif
