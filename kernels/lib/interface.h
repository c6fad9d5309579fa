// SPDX-License-Identifier: Apache-2.0
// A sharp interface between two indices: Snell's law and Fresnel's equations for unpolarised light (Born and Wolf, Principles
// of Optics, section 1.5).
#ifndef TURBID_LIB_INTERFACE_H
#define TURBID_LIB_INTERFACE_H

typedef struct {
  float reflectance;  // in [0, 1]; 1: total internal reflection, `refracted` is then undefined
  float3 reflected;   // unit direction
  float3 refracted;   // unit direction
} Interface;

// `direction` is unit; `normal` is unit, of either sign.
static Interface meet_interface(float3 direction, float3 normal, float eta_from, float eta_to) {
  Interface result;
  float cos_i = -dot(direction, normal);
  if (cos_i < 0.0f) {
    cos_i = -cos_i;
    normal = -normal;
  }
  cos_i = fmin(cos_i, 1.0f);
  result.reflected = direction + 2.0f * cos_i * normal;
  const float ratio = eta_from / eta_to;
  const float cos_t_squared = 1.0f - ratio * ratio * (1.0f - cos_i * cos_i);
  if (cos_t_squared <= 0.0f) {
    result.reflectance = 1.0f;
    result.refracted = direction;
    return result;
  }
  const float cos_t = sqrt(cos_t_squared);
  const float3 refracted = ratio * direction + (ratio * cos_i - cos_t) * normal;
  result.refracted = refracted * rsqrt(dot(refracted, refracted));
  const float s = (eta_from * cos_i - eta_to * cos_t) / (eta_from * cos_i + eta_to * cos_t);
  const float p = (eta_to * cos_i - eta_from * cos_t) / (eta_to * cos_i + eta_from * cos_t);
  result.reflectance = 0.5f * (s * s + p * p);
  return result;
}

#endif
