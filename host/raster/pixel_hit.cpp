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

PixelRays::PixelRays(const RasterView& view)
    : to_world_(glm::inverse(glm::dmat4(view.projection) * glm::dmat4(view.view))),
      width_(view.width),
      height_(view.height) {}

Ray PixelRays::at(int x, int y) const {
  const double cx = (2.0 * x + 1.0) / width_ - 1.0, cy = 1.0 - (2.0 * y + 1.0) / height_;
  const glm::dvec4 a = to_world_ * glm::dvec4(cx, cy, -1.0, 1.0), b = to_world_ * glm::dvec4(cx, cy, 1.0, 1.0);
  const glm::dvec3 from = glm::dvec3(a) / a.w;
  return {from, glm::normalize(glm::dvec3(b) / b.w - from)};
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
