// SPDX-License-Identifier: Apache-2.0
// What stands around the media: Lambertian ground and opaque surfaces under the scene's lights, shadows, background.
#ifndef TURBID_LIB_SURROUNDINGS_H
#define TURBID_LIB_SURROUNDINGS_H
#include "shared/view_params.h"

#ifndef TURBID_LIGHTS
#error "TURBID_LIGHTS (the sum of TURBID_LIGHT_BIT of the kinds of lights, 0 without lights) must be defined"
#endif

// The kind of a light: known to the compiler where a scene has one kind only, so that the others' code goes.
static int kind_of(const global LightParams* light) {
#if TURBID_LIGHTS == TURBID_LIGHT_BIT(TURBID_LIGHT_DIRECTIONAL)
  return TURBID_LIGHT_DIRECTIONAL;
#elif TURBID_LIGHTS == TURBID_LIGHT_BIT(TURBID_LIGHT_POINT)
  return TURBID_LIGHT_POINT;
#elif TURBID_LIGHTS == TURBID_LIGHT_BIT(TURBID_LIGHT_SPOT)
  return TURBID_LIGHT_SPOT;
#else
  return light->kind;
#endif
}

typedef struct {
  const global LightParams* lights;
  const global float* shadow_depths;  // all maps, row 0 = top
  const global float* transmittance;  // [texel][3]: what passes the media in shadow
  const global float* ground_map;     // [texel][3]: light that came through the media [W/unit^2]
} Surroundings;

// Share of the shadow map around a point that the light reaches (Reeves, Salesin and Cook 1987).
static float3 visibility(const Surroundings* s, const ViewParams* p, const global LightParams* light, float3 x, float bias) {
  if (light->map_size == 0) return (float3)(1.0f);
  const global float* m = light->voxel_to_clip;
  const float w = m[3] * x.x + m[7] * x.y + m[11] * x.z + m[15];
  if (w <= 0.0f) return (float3)(1.0f);
  const float u = (m[0] * x.x + m[4] * x.y + m[8] * x.z + m[12]) / w;
  const float v = (m[1] * x.x + m[5] * x.y + m[9] * x.z + m[13]) / w;
  const float size = (float)light->map_size;
  const float column = (0.5f * u + 0.5f) * size - 0.5f, row = (0.5f - 0.5f * v) * size - 0.5f;
  const int c0 = (int)floor(column), r0 = (int)floor(row);
  if (c0 < 1 || r0 < 1 || c0 + 2 >= light->map_size || r0 + 2 >= light->map_size) return (float3)(1.0f);
  const float3 from = x - vload3(0, light->map_origin);
  const float depth =
      kind_of(light) == TURBID_LIGHT_DIRECTIONAL ? dot(from, vload3(0, light->direction)) : length(from);
  const global float* map = s->shadow_depths + light->map_offset;
  // 4 x 4 texels under a 3 x 3 box that slides with the point: edges one texel soft, without steps.
  const float fu = column - c0, fv = row - r0;
  const float wu[4] = {1.0f - fu, 1.0f, 1.0f, fu}, wv[4] = {1.0f - fv, 1.0f, 1.0f, fv};
  float3 lit = (float3)(0.0f);
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const int texel = (r0 - 1 + j) * light->map_size + c0 - 1 + i;
      const float weight = wu[i] * wv[j];
      if (depth <= map[texel] + bias) {
        lit += weight;
      } else if (p->transmittance) {
        lit += weight * vload3(light->map_offset + texel, s->transmittance);
      }
    }
  }
  return lit * (1.0f / 9.0f);
}

// Direct irradiance of a surface with unit normal n [W/unit^2].
static float3 direct_irradiance(const Surroundings* s, const ViewParams* p, float3 x, float3 n, float bias) {
  float3 sum = (float3)(0.0f);
  for (int i = 0; i < p->light_count; ++i) {
    const global LightParams* light = s->lights + i;
    float3 from = vload3(0, light->direction);
    float fall_off = 1.0f;
    if (kind_of(light) != TURBID_LIGHT_DIRECTIONAL) {
      const float3 path = x - vload3(0, light->position);
      const float d2 = fmax(dot(path, path), 1e-6f);
      from = path * rsqrt(d2);
      fall_off = 1.0f / d2;
      if (kind_of(light) == TURBID_LIGHT_SPOT && dot(from, vload3(0, light->direction)) < light->cos_half_angle) continue;
    }
    const float cosine = -dot(from, n);
    if (cosine <= 0.0f) continue;
    sum += vload3(0, light->intensity) * (cosine * fall_off) * visibility(s, p, light, x, bias);
  }
  return sum;
}

static float3 light_through_media(const Surroundings* s, const ViewParams* p, float3 x) {
  const float u = (x.x - p->ground_map_origin[0]) / p->ground_map_texel - 0.5f;
  const float v = (x.z - p->ground_map_origin[1]) / p->ground_map_texel - 0.5f;
  if (!(u >= 0.0f && v >= 0.0f && u < p->ground_map_size - 1 && v < p->ground_map_size - 1)) return (float3)(0.0f);
  const int iu = (int)u, iv = (int)v;
  const float fu = u - iu, fv = v - iv;
  const global float* at = s->ground_map + 3 * (iv * p->ground_map_size + iu);
  const float3 low = mix(vload3(0, at), vload3(1, at), fu);
  const float3 high = mix(vload3(0, at + 3 * p->ground_map_size), vload3(1, at + 3 * p->ground_map_size), fu);
  return mix(low, high, fv);
}

// Distance along the unit direction to the ground, or a huge number. A downward path that stands on the ground, as on a
// domain face that coincides with it, has reached it.
static float distance_to_ground(const ViewParams* p, float3 x, float3 direction) {
  if (!p->ground || fabs(direction.y) < 1e-6f) return 1e30f;
  const float height = x.y - p->ground_height;
  if (direction.y < 0.0f && fabs(height) < 1e-2f) return 0.0f;
  const float t = -height / direction.y;
  return t > 1e-3f ? t : 1e30f;
}

// Lambert: radiance = reflectance / pi * irradiance.
static float3 ground_radiance(const Surroundings* s, const ViewParams* p, float3 x, float3 direction) {
  float3 reflectance = vload3(0, p->ground_colour);
  if (p->checker_size > 0.0f) {
    const int square = (int)floor((x.x + p->origin[0]) / p->checker_size) + (int)floor((x.z + p->origin[2]) / p->checker_size);
    if (square & 1) reflectance = vload3(0, p->ground_colour2);
  }
  const float3 n = (float3)(0.0f, direction.y < 0.0f ? 1.0f : -1.0f, 0.0f);
  float3 irradiance = direct_irradiance(s, p, x, n, 0.5f);
  if (p->ground_map_size > 0 && direction.y < 0.0f) irradiance += light_through_media(s, p, x);
  return reflectance * irradiance * M_1_PI_F;
}

// Radiance that arrives along -direction from outside the domain.
static float3 surroundings_radiance(const Surroundings* s, const ViewParams* p, float3 x, float3 direction) {
  const float t = distance_to_ground(p, x, direction);
  if (t < 1e29f) return ground_radiance(s, p, x + t * direction, direction);
  return vload3(0, p->background);
}

#endif
