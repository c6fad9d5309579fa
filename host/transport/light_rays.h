// SPDX-License-Identifier: Apache-2.0
// Where light rays start: on the first surface that a light sees (Bernabei et al. III-A), or at the light if it is inside.
#pragma once
#include <vector>

#include "host/raster/raster.h"
#include "host/scene/light.h"
#include "host/scene/settings.h"
#include "host/transport/device_medium.h"
#include "host/transport/solver.h"
#include "kernels/shared/march_params.h"

namespace turbid {

struct LightRays {
  std::vector<RayState> rays;        ///< powers [W] in the channels of the scene's features
  std::vector<ShadowMap> shadows;    ///< one per light
  std::vector<glm::dvec3> texel_power;  ///< power that starts at each texel of all shadow maps, in their order [W]
  glm::dvec3 emitted{0};             ///< aimed at the medium or its surroundings [W], per channel
  glm::dvec3 missed{0};              ///< of it, not carried by any ray
  glm::dvec3 absorbed_opaque{0};     ///< of it, met an opaque surface first
};

/// Surfaces that first hits are rasterised from: the bodies, or the domain's open faces where the ambient takes part.
struct EntrySurfaces {
  std::vector<TriangleMesh> own;     ///< the domain's faces, if needed
  std::vector<RasterMesh> meshes;    ///< id = region entered
  Box3 bounds;                       ///< of what is rasterised, within the domain
  bool ambient = false;              ///< the domain's faces are the surface
};
/// Light comes in through open faces only; a camera looks through all of them (`all_faces`).
EntrySurfaces entry_surfaces(const MediumDescription&, const MediumVolume&, bool all_faces);

LightRays start_rays(const LightList&, const MediumVolume&, const EntrySurfaces&, const DeviceMedium&,
                     const MarchSettings&, std::uint64_t seed);

}  // namespace turbid
