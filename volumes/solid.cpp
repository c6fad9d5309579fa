// SPDX-License-Identifier: Apache-2.0
// Primitive bodies: fine triangles with the exact normals of the shape, and the exact signed distance.
#include "volumes/solid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include "host/base/errors.h"

namespace turbid {
namespace {

constexpr int sphere_subdivisions = 5;  // icosahedron edges in 2^5 parts: 160 segments around, 20480 triangles
constexpr int cylinder_segments = 192;

void require_positive(float value, const std::string& what) {
  if (!(value > 0) || !std::isfinite(value))
    throw InputError(what + " = " + std::to_string(value) + ": must be > 0 and finite");
}

/// Distance in the shape's own frame -> distance in the scene: d(x) = s d0(R^T (x - t) / s), since the motion is rigid.
template <typename Distance>
std::function<float(glm::vec3)> place(Distance distance, const Placement& placement) {
  return [distance, to_shape = glm::transpose(placement.rotation), scale = placement.scale,
          translation = placement.translation](glm::vec3 x) {
    return scale * distance(to_shape * (x - translation) / scale);
  };
}

/// Icosahedron whose triangles are cut in four, again and again, with all vertices on the unit sphere.
TriangleMesh unit_icosphere() {
  TriangleMesh mesh;
  const float g = std::numbers::phi_v<float>;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (glm::vec3& p : mesh.positions) p = glm::normalize(p);
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < sphere_subdivisions; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> midpoints;
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, is_new] =
          midpoints.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
      return it->second;
    };
    std::vector<glm::uvec3> finer;
    finer.reserve(4 * mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
      const std::uint32_t ab = midpoint(t.x, t.y), bc = midpoint(t.y, t.z), ca = midpoint(t.z, t.x);
      finer.insert(finer.end(), {{t.x, ab, ca}, {t.y, bc, ab}, {t.z, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

}  // namespace

Solid make_sphere(float radius, const Placement& placement) {
  require_positive(radius, "sphere: radius");
  require_positive(placement.scale, "sphere: scale");
  TriangleMesh mesh = unit_icosphere();
  mesh.name = "sphere";
  std::vector<glm::vec3> normals;  // the sphere's, not the triangles'
  for (const glm::vec3& p : mesh.positions) normals.push_back(glm::normalize(placement.rotation * p));
  for (glm::vec3& p : mesh.positions) p *= radius;
  transform(mesh, placement.rotation, placement.scale, placement.translation);
  for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c)
    mesh.corner_normals[c] = normals[mesh.triangles[c / 3][static_cast<int>(c % 3)]];
  return {std::move(mesh), place([radius](glm::vec3 x) { return glm::length(x) - radius; }, placement)};
}

Solid make_box(glm::vec3 size, const Placement& placement) {
  for (int axis = 0; axis < 3; ++axis) require_positive(size[axis], std::string("box: size along ") + "xyz"[axis]);
  require_positive(placement.scale, "box: scale");
  const glm::vec3 half = 0.5f * size;
  TriangleMesh mesh;
  mesh.name = "box";
  for (int corner = 0; corner < 8; ++corner)  // bit 0, 1, 2 of the index: upper side in x, y, z
    mesh.positions.push_back(half * glm::vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},   // -x, +x
                    {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},   // -y, +y
                    {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};  // -z, +z
  transform(mesh, placement.rotation, placement.scale, placement.translation);
  const auto distance = [half](glm::vec3 x) {
    const glm::vec3 q = glm::abs(x) - half;
    return glm::length(glm::max(q, 0.0f)) + std::min(std::max({q.x, q.y, q.z}), 0.0f);
  };
  return {std::move(mesh), place(distance, placement)};
}

Solid make_cylinder(float radius, float height, const Placement& placement) {
  require_positive(radius, "cylinder: radius");
  require_positive(height, "cylinder: height");
  require_positive(placement.scale, "cylinder: scale");
  const float half_height = 0.5f * height;
  TriangleMesh mesh;
  mesh.name = "cylinder";
  mesh.positions = {{0, -half_height, 0}, {0, half_height, 0}};
  for (int i = 0; i < cylinder_segments; ++i) {
    const double angle = 2 * std::numbers::pi * i / cylinder_segments;
    const auto x = static_cast<float>(radius * std::cos(angle)), z = static_cast<float>(radius * std::sin(angle));
    mesh.positions.emplace_back(x, -half_height, z);
    mesh.positions.emplace_back(x, half_height, z);
  }
  for (std::uint32_t i = 0; i < cylinder_segments; ++i) {
    const std::uint32_t low = 2 + 2 * i, high = low + 1, next_low = 2 + 2 * ((i + 1) % cylinder_segments);
    const std::uint32_t next_high = next_low + 1;
    mesh.triangles.insert(mesh.triangles.end(), {{low, high, next_high},
                                                 {low, next_high, next_low},  // side
                                                 {0, low, next_low},
                                                 {1, next_high, high}});  // caps
  }
  transform(mesh, placement.rotation, placement.scale, placement.translation);  // the caps' rims are creases
  const auto distance = [radius, half_height](glm::vec3 x) {
    const glm::vec2 q(glm::length(glm::vec2(x.x, x.z)) - radius, std::abs(x.y) - half_height);
    return glm::length(glm::max(q, 0.0f)) + std::min(std::max(q.x, q.y), 0.0f);
  };
  return {std::move(mesh), place(distance, placement)};
}

Solid make_mesh_solid(TriangleMesh mesh, const Placement& placement) {
  require_positive(placement.scale, mesh.name + ": scale");
  transform(mesh, placement.rotation, placement.scale, placement.translation);
  return {std::move(mesh), nullptr};
}

}  // namespace turbid
