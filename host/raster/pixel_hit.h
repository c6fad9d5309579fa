// SPDX-License-Identifier: Apache-2.0
// The ray through a pixel's centre and where it meets a triangle, in double.
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

/// Rays through the centres of pixels.
class PixelRays {
 public:
  explicit PixelRays(const RasterView&);
  Ray at(int x, int y) const;  ///< (0, 0) is the top left pixel
  /// Where the ray leaves the view.
  glm::dvec3 far_point(int x, int y) const { return far_.at(x, y); }

 private:
  /// Points of a plane of constant depth: a projection maps its pixels to the world by an affine map.
  struct Plane {
    glm::dvec3 corner, right, down;  ///< pixel (0, 0), and from a pixel to the next
    glm::dvec3 at(int x, int y) const { return corner + double(x) * right + double(y) * down; }
  };
  Plane near_, far_;
};

/// Whether the ray comes from the triangle's outside.
bool faces(const Ray&, const Corners&);
/// Moeller and Trumbore 1997.
std::optional<Hit> intersect(const Ray&, const Corners&);
/// The point of the triangle's edges that the ray passes most closely.
Hit nearest_edge(const Ray&, const Corners&);

}  // namespace turbid
