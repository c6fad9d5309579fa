// SPDX-License-Identifier: Apache-2.0
// Pixel rays and ray-triangle intersection in double.
#include "host/raster/pixel_hit.h"

#include <algorithm>
#include <limits>

namespace turbid {

Corners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const glm::uvec3 t = mesh.triangles[triangle];
  return {glm::dvec3(mesh.positions[t.x]), glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z])};
}

PixelRays::PixelRays(const RasterView& view) {
  const glm::dmat4 to_world = glm::inverse(glm::dmat4(view.projection) * glm::dmat4(view.view));
  const auto plane_at = [&](double depth) {
    const auto point = [&](double x, double y) {
      const glm::dvec4 p = to_world * glm::dvec4(2.0 * x / view.width - 1.0, 1.0 - 2.0 * y / view.height, depth, 1.0);
      return glm::dvec3(p) / p.w;
    };
    const glm::dvec3 left_top = point(0, 0), right = (point(view.width, 0) - left_top) / double(view.width),
                     down = (point(0, view.height) - left_top) / double(view.height);
    return Plane{left_top + 0.5 * (right + down), right, down};
  };
  near_ = plane_at(-1.0);
  far_ = plane_at(1.0);
}

Ray PixelRays::at(int x, int y) const {
  const glm::dvec3 from = near_.at(x, y);
  return {from, glm::normalize(far_.at(x, y) - from)};
}

bool faces(const Ray& ray, const Corners& p) {
  return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), ray.direction) < 0;
}

std::optional<Hit> intersect(const Ray& ray, const Corners& p) {
  const glm::dvec3 e1 = p[1] - p[0], e2 = p[2] - p[0], s = ray.origin - p[0];
  const glm::dvec3 h = glm::cross(ray.direction, e2), q = glm::cross(s, e1);
  const double det = glm::dot(e1, h);
  if (det == 0) return std::nullopt;
  const double u = glm::dot(s, h) / det, v = glm::dot(ray.direction, q) / det;
  if (!(u >= 0 && v >= 0 && u + v <= 1)) return std::nullopt;
  return Hit{glm::dot(e2, q) / det, {1 - u - v, u, v}};
}

Hit nearest_edge(const Ray& ray, const Corners& p) {
  // Seen along the ray, an edge is a segment in a plane and the ray its origin.
  const auto across = [&](glm::dvec3 v) { return v - glm::dot(v, ray.direction) * ray.direction; };
  Hit best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const int j = (k + 1) % 3;
    const glm::dvec3 from = across(p[k] - ray.origin), edge = across(p[j] - p[k]);
    const double length2 = glm::dot(edge, edge);
    const double s = length2 > 0 ? std::clamp(-glm::dot(from, edge) / length2, 0.0, 1.0) : 0.0;
    const double distance = glm::length(from + s * edge);
    if (distance >= best_distance) continue;
    best_distance = distance;
    best.distance = glm::dot(p[k] + s * (p[j] - p[k]) - ray.origin, ray.direction);
    best.barycentric = glm::dvec3(0);
    best.barycentric[k] = 1 - s;
    best.barycentric[j] = s;
  }
  return best;
}

}  // namespace turbid
