// SPDX-License-Identifier: Apache-2.0
// Follows single paths of light through a medium, for comparison with exact optics: the tracing of march.cl without power.
// rays[10 i]: position, velocity, region, arc length, surfaces met, face that stopped the ray (-1: none).
#include "lib/trace.h"

kernel void follow_path(MEDIUM_ARGUMENTS, global float* rays, float step_size, int steps, int count) {
  const int index = get_global_id(0);
  if (index >= count) return;
  const Medium medium = MEDIUM_FROM_ARGUMENTS;
  global float* data = rays + 10 * index;
  Ray ray;
  ray.x = vload3(0, data);
  ray.v = vload3(1, data);
  ray.region = (int)data[6];
  ray.grace = 0.0f;
  float arc = data[7];
  int surfaces = (int)data[8], face = -1;
  const float end = arc + step_size * steps;
  for (int i = 0; i < steps && arc < end; ++i) {
    const int region = ray.region;
    const Step step = advance(&medium, &ray, step_size, 0.0f);
    arc += step.length;
    if (step.event == EVENT_FACE) {
      face = step.face;
      break;
    }
    if (step.event != EVENT_SURFACE) continue;
    if (regions[region].smooth_group && regions[step.next_region].smooth_group) {
      ray.x = step.beyond;
      ray.region = step.next_region;
      continue;
    }
    ++surfaces;
    const float eta_from = length(ray.v), eta_to = eta_at(&medium, step.next_region, locate(step.beyond));
    const Interface surface = meet_interface(ray.v / eta_from, step.normal, eta_from, eta_to);
    if (surface.reflectance < 1.0f) {
      ray.x = step.beyond;
      ray.v = eta_to * surface.refracted;
      ray.region = step.next_region;
    } else {
      ray.v = eta_from * surface.reflected;
    }
  }
  vstore3(ray.x, 0, data);
  vstore3(ray.v, 1, data);
  data[6] = ray.region;
  data[7] = arc;
  data[8] = surfaces;
  data[9] = face;
}
