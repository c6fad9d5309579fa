// SPDX-License-Identifier: Apache-2.0
// Where photons start: lights and emitting voxels, with the power of each.
#pragma once
#include <array>
#include <vector>

#include "host/transport/light_rays.h"
#include "host/transport/photon_medium.h"

namespace turbid {

struct PhotonSources {
  std::vector<PhotonSource> sources;
  std::array<std::vector<double>, 3> power;              ///< [channel][source] [W]
  std::vector<ShadowMap> shadows;                        ///< one per light
  glm::dvec3 emitted{0}, missed{0}, absorbed_opaque{0};  ///< see LightRays; emission of media included

  void add(const PhotonSource& source, glm::dvec3 watts);
  glm::dvec3 carried() const;  ///< by all sources [W]
};

/// Light from outside comes as the rays that the other solvers march, one per texel of a map that the light sees: the
/// sources share their discretisation (MarchSettings::rays_per_face), so that differences between solvers are those of
/// transport. Lights inside a medium send photons into continuous directions.
PhotonSources photon_sources(const LightList&, const MediumVolume&, const EntrySurfaces&, const DeviceMedium&,
                             const PhotonMedium&, const MarchSettings&, std::uint64_t seed);

}  // namespace turbid
