// SPDX-License-Identifier: Apache-2.0
// The ray through a pixel's centre and where it meets a triangle, in double. Internal to host/raster.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <optional>

#include "host/raster/raster.h"

namespace turbid {

using Corners = std::array<glm::dvec3, 3>;
Corners corners_of(const TriangleMesh&, std::size_t triangle);

struct Ray {
  glm::dvec3 origin, direction;  ///< from the near plane; direction unit
};

struct Hit {
  double distance = 0;  ///< along the ray [scene units]
  glm::dvec3 barycentric{0};
};

class PixelRays {
 public:
  explicit PixelRays(const RasterView&);
  Ray at(int x, int y) const;  ///< (0, 0) is the top left pixel

 private:
  glm::dmat4 to_world_;
  double width_, height_;
};

/// Whether the ray comes from the triangle's outside.
bool faces(const Ray&, const Corners&);
/// Moeller and Trumbore 1997.
std::optional<Hit> intersect(const Ray&, const Corners&);
/// The point of the triangle's edges that the ray passes most closely.
Hit nearest_edge(const Ray&, const Corners&);

}  // namespace turbid
