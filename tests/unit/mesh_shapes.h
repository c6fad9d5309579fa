// SPDX-License-Identifier: Apache-2.0
// Cubes to build test meshes from, and the volume and area that a mesh encloses.
#pragma once
#include <vector>

#include "volumes/mesh.h"

namespace turbid {

/// Appends an axis-aligned cube of 8 points and 12 triangles.
inline void add_cube(TriangleMesh& mesh, float half_edge, bool outward, glm::vec3 centre = glm::vec3(0)) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(centre + half_edge * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  const std::vector<glm::uvec3> faces = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                                         {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  for (const glm::uvec3& f : faces) mesh.triangles.push_back(first + (outward ? f : glm::uvec3(f.x, f.z, f.y)));
}

inline TriangleMesh cube(float half_edge, bool outward = true) {
  TriangleMesh mesh;
  mesh.name = "cube";
  add_cube(mesh, half_edge, outward);
  return mesh;
}

/// Signed volume by the divergence theorem, negative for an inside-out surface.
inline double volume(const TriangleMesh& mesh) {
  const glm::dvec3 origin(bounds(mesh).centre());
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a = glm::dvec3(mesh.positions[t.x]) - origin, b = glm::dvec3(mesh.positions[t.y]) - origin;
    sum += glm::dot(a, glm::cross(b, glm::dvec3(mesh.positions[t.z]) - origin)) / 6;
  }
  return sum;
}

inline double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    sum += glm::length(glm::cross(b - a, c - a)) / 2;
  }
  return sum;
}

}  // namespace turbid
