// SPDX-License-Identifier: Apache-2.0
// Scattering directions: the phase function of Henyey and Greenstein (1941), and turning a direction by an angle.
#ifndef TURBID_LIB_PHASE_H
#define TURBID_LIB_PHASE_H

// Phase function of the cosine between the directions before and after [1/sr]; integral over the sphere 1, mean cosine g.
static float henyey_greenstein(float g, float cosine) {
  const float base = 1.0f + g * g - 2.0f * g * cosine;
  return 0.25f * M_1_PI_F * (1.0f - g * g) / (base * sqrt(base));
}

// Cosine of a scattering angle from a uniform number. The textbook's (1 + g^2 - ((1 - g^2) / (1 - g + 2 g u))^2) / (2 g) with
// 2 g divided out: without it small g cancel, and g = 0 needs no case of its own.
static float sample_henyey_greenstein(float g, float u) {
  const float s = 2.0f * u - 1.0f, g2 = g * g, base = 1.0f + g * s;
  const float cosine = (2.0f * s * (1.0f + g2) + g * (3.0f + s * s) - g * g2 * (1.0f - s * s)) / (2.0f * base * base);
  return clamp(cosine, -1.0f, 1.0f);
}

// The unit direction that makes an angle of the given cosine with a unit axis, at the azimuth 2 pi turn
// (frame of Duff et al., "Building an orthonormal basis, revisited", JCGT 2017).
static float3 turned(float3 axis, float cosine, float turn) {
  const float sign = copysign(1.0f, axis.z);
  const float a = -1.0f / (sign + axis.z), b = axis.x * axis.y * a;
  const float3 first = (float3)(1.0f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
  const float3 second = (float3)(b, sign + axis.y * axis.y * a, -axis.y);
  const float sine = sqrt(fmax(1.0f - cosine * cosine, 0.0f));
  float along_first;
  const float along_second = sincos(2.0f * M_PI_F * turn, &along_first);
  const float3 result = cosine * axis + sine * (along_first * first + along_second * second);
  return result * rsqrt(dot(result, result));
}

#endif
