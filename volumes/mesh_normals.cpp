// SPDX-License-Identifier: Apache-2.0
// Corner normals of a closed triangle mesh, its bounds, and its placement.
//
// The normal of a vertex is the mean of its triangles' normals, each weighted by the angle that the triangle has at the
// vertex: the weight that does not depend on how the surface is cut into triangles [Thuermer and Wuethrich 1998].
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "volumes/mesh.h"
#include "volumes/mesh_topology.h"

namespace turbid {
namespace {

/// Union-find over corners, with path halving.
class CornerSets {
 public:
  explicit CornerSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t find(std::uint32_t corner) {
    while (parent_[corner] != corner) corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// Unit face normal; zero for a triangle without area.
glm::dvec3 face_normal(const TriangleMesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double length = glm::length(n);
  return length > 0 ? n / length : glm::dvec3(0);
}

double corner_angle(const TriangleMesh& mesh, const glm::uvec3& t, int k) {
  const glm::dvec3 p(mesh.positions[t[k]]);
  const glm::dvec3 u = glm::dvec3(mesh.positions[t[(k + 1) % 3]]) - p,
                   v = glm::dvec3(mesh.positions[t[(k + 2) % 3]]) - p;
  return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

}  // namespace

void compute_corner_normals(TriangleMesh& mesh, float crease_degrees) {
  const double cos_crease = std::cos(glm::radians(static_cast<double>(crease_degrees)));
  std::vector<glm::dvec3> normals;
  normals.reserve(mesh.triangles.size());
  for (const glm::uvec3& t : mesh.triangles) normals.push_back(face_normal(mesh, t));

  // Corners share a normal when their triangles share an edge at the vertex that is not a crease.
  CornerSets sets(3 * mesh.triangles.size());
  const std::vector<std::uint32_t> twins = twin_half_edges(mesh.triangles);
  for (std::uint32_t h = 0; h < twins.size(); ++h) {
    const std::uint32_t twin = twins[h];
    if (twin == no_twin || twin < h) continue;
    const glm::dvec3 n = normals[h / 3], m = normals[twin / 3];
    const bool sliver = n == glm::dvec3(0) || m == glm::dvec3(0);
    if (!sliver && glm::dot(n, m) < cos_crease) continue;
    sets.unite(h, next_half_edge(twin));  // h runs from its corner to the next; its twin runs back
    sets.unite(next_half_edge(h), twin);
  }

  std::vector<glm::dvec3> sums(3 * mesh.triangles.size(), glm::dvec3(0));
  for (std::uint32_t c = 0; c < sums.size(); ++c)
    sums[sets.find(c)] += corner_angle(mesh, mesh.triangles[c / 3], static_cast<int>(c % 3)) * normals[c / 3];
  mesh.corner_normals.resize(sums.size());
  for (std::uint32_t c = 0; c < sums.size(); ++c) {
    glm::dvec3 n = sums[sets.find(c)];
    if (glm::length(n) < 1e-12) n = normals[c / 3];   // the faces cancel: a spike of no width
    if (n == glm::dvec3(0)) n = glm::dvec3(0, 1, 0);  // nothing defines it; unit all the same
    mesh.corner_normals[c] = glm::vec3(glm::normalize(n));
  }
}

Box3 bounds(const TriangleMesh& mesh) {
  if (mesh.positions.empty()) return {};
  Box3 box{mesh.positions.front(), mesh.positions.front()};
  for (const glm::vec3& p : mesh.positions) {
    box.lower = glm::min(box.lower, p);
    box.upper = glm::max(box.upper, p);
  }
  return box;
}

void transform(TriangleMesh& mesh, const glm::mat3& rotation, float scale, glm::vec3 translation) {
  for (glm::vec3& p : mesh.positions) p = rotation * (scale * p) + translation;
  if (glm::determinant(rotation) * scale < 0)  // a reflection turns the surface inside out
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  compute_corner_normals(mesh);
}

}  // namespace turbid
