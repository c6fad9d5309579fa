// SPDX-License-Identifier: Apache-2.0
// Lights and emission as one list of sources.
#include "host/transport/photon_sources.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace turbid {
namespace {

void copy(glm::vec3 from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

/// Region of the medium that a light stands in, or -1 if its light comes in from outside.
int region_around(const Light& light, const MediumVolume& medium, const EntrySurfaces& surfaces) {
  if (light.kind == LightKind::directional) return -1;
  const GridFrame& frame = medium.frame();
  std::array<int, 1> owner{};
  medium.read_owner(glm::ivec3(glm::floor((light.position - frame.origin) / frame.voxel_size)), glm::ivec3(1), owner);
  const bool nothing_to_enter = surfaces.meshes.empty();
  return owner[0] > 0 || (owner[0] == 0 && (surfaces.ambient || nothing_to_enter)) ? owner[0] : -1;
}

void add_inside(PhotonSources& out, const Light& light, int region, const GridFrame& frame,
                const SceneFeatures& features) {
  PhotonSource source{};
  copy((light.position - frame.origin) / frame.voxel_size, source.position);
  source.region = region;
  source.grace = 1.5f;
  source.kind = TURBID_SOURCE_CONE;
  const bool spot = light.kind == LightKind::spot;
  copy(spot ? glm::normalize(light.direction) : glm::vec3(0, 0, 1), source.direction);
  source.cos_half_angle = spot ? std::cos(glm::radians(0.5f * light.cone_angle)) : -1.0f;
  const glm::dvec3 power(features.to_channels(light.power));
  out.emitted += power;
  out.add(source, power);
}

void add_rays(PhotonSources& out, const LightRays& rays) {
  glm::dvec3 carried(0);
  for (const RayState& ray : rays.rays) {
    PhotonSource source{};
    std::copy_n(ray.position, 3, source.position);
    std::copy_n(ray.normal, 3, source.normal);
    copy(glm::normalize(glm::vec3(ray.velocity[0], ray.velocity[1], ray.velocity[2])), source.direction);
    source.region = ray.region;
    source.grace = ray.grace;
    source.kind = ray.entering ? TURBID_SOURCE_ENTERING : TURBID_SOURCE_RAY;
    const glm::dvec3 power(ray.power[0], ray.power[1], ray.power[2]);
    carried += power;
    out.add(source, power);
  }
  out.emitted += rays.emitted;
  out.missed += rays.emitted - carried - rays.absorbed_opaque;
  out.absorbed_opaque += rays.absorbed_opaque;
}

void add_emission(PhotonSources& out, const PhotonMedium& medium, const SceneFeatures& features) {
  const auto add = [&](glm::ivec3 voxel, int region, glm::vec3 inside, glm::vec3 watts) {
    PhotonSource source{};
    copy(glm::vec3(voxel), source.position);
    copy(inside, source.normal);
    source.region = region;
    source.kind = TURBID_SOURCE_VOXEL;
    const glm::dvec3 power(features.to_channels(watts));
    out.emitted += power;
    out.add(source, power);
  };
  for (std::size_t at = 0; at < medium.emission.size(); ++at) {
    if (medium.emission[at] == glm::vec3(0)) continue;
    const int v = static_cast<int>(at % 512);
    add(8 * medium.blocks.coordinates(static_cast<int>(at / 512)) + glm::ivec3(v % 8, v / 8 % 8, v / 64),
        medium.region[at], glm::vec3(0.5f), medium.emission[at]);
  }
  for (const EmittingPart& part : medium.emitting_parts)
    if (part.power != glm::vec3(0)) add(part.voxel, part.region, part.inside, part.power);
}

}  // namespace

void PhotonSources::add(const PhotonSource& source, glm::dvec3 watts) {
  sources.push_back(source);
  for (int c = 0; c < 3; ++c) power[c].push_back(watts[c]);
}

glm::dvec3 PhotonSources::carried() const {
  glm::dvec3 sum(0);
  for (int c = 0; c < 3; ++c) {
    for (const double watts : power[c]) sum[c] += watts;
  }
  return sum;
}

PhotonSources photon_sources(const LightList& lights, const MediumVolume& medium, const EntrySurfaces& surfaces,
                             const DeviceMedium& device, const PhotonMedium& photon_medium, const MarchSettings& march,
                             std::uint64_t seed) {
  PhotonSources out;
  for (const Light& light : lights) {
    if (const int region = region_around(light, medium, surfaces); region >= 0) {
      add_inside(out, light, region, device.frame, device.features);
      out.shadows.emplace_back();
      continue;
    }
    LightRays rays = start_rays({light}, medium, surfaces, device, march, seed);
    add_rays(out, rays);
    out.shadows.insert(out.shadows.end(), rays.shadows.begin(), rays.shadows.end());
  }
  add_emission(out, photon_medium, device.features);
  return out;
}

}  // namespace turbid
