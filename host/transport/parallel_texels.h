// SPDX-License-Identifier: Apache-2.0
// Parallel light cut into texels: which part of each falls inside the domain, so that the parts add up to what the
// domain's faces let in. A texel's light is a square column; a plane cuts it, the domain's faces clip the cut.
#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "host/raster/raster.h"
#include "volumes/frame.h"

namespace turbid {

using Faces = std::array<FaceBoundary, 6>;  ///< -x, +x, -y, +y, -z, +z

/// Projected area of the open faces that look towards the light [scene unit^2]: what irradiance times this comes in.
/// Mirrored copies of the domain are lit by mirrored light, periodic ones by the same.
double lit_area(glm::vec3 direction, const GridFrame&, const Faces&);

struct FacePart {
  std::ptrdiff_t texel;  ///< of the map; -1: beside it
  double share;          ///< of the texel's power, in (0, 1]
  glm::vec3 centre;      ///< of the part
};
/// All light of a parallel view that enters a domain filled by its ambient medium: shares add up to lit_area() over a
/// texel's area, to rounding.
std::vector<FacePart> parts_on_faces(const RasterView&, glm::vec3 direction, const GridFrame&, const Faces&);

struct BodyPart {
  std::size_t texel;
  std::size_t surface;  ///< texel of the image whose hit tells the surface
  double share;         ///< of the texel's power, in (0, 1]
  glm::vec3 centre;     ///< of the part
};
/// Light that meets bodies inside a domain with mirror or periodic faces: clipped at those where the bodies go on
/// beyond them or end on them with a flat surface; whole texels by their centres elsewhere.
std::vector<BodyPart> parts_on_bodies(const RasterImage&, const RasterView&, glm::vec3 direction, const GridFrame&,
                                      const Faces&);

}  // namespace turbid
