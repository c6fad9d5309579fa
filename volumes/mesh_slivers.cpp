// SPDX-License-Identifier: Apache-2.0
// Replaces triangles without area by flipping their longest edges: a sliver (p, q, b) with b on the line pq and its
// neighbour (q, p, d) become (p, d, b) and (d, q, b), which cover the same surface.
#include <cstdint>
#include <unordered_set>

#include "volumes/mesh_repair.h"
#include "volumes/mesh_topology.h"

namespace turbid {
namespace {

// Height over longest edge below which single precision does not tell a triangle from a line.
constexpr double sliver_height = 2e-7;
constexpr int passes = 8;  // a row of slivers needs one each

/// The half-edge to flip, the longest, or no_twin if the triangle has area.
std::uint32_t sliver_edge(const TriangleMesh& mesh, std::uint32_t t) {
  std::uint32_t longest = no_twin;
  double length2 = -1;
  for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
    const glm::dvec3 e =
        glm::dvec3(mesh.positions[end_of(mesh.triangles, h)]) - glm::dvec3(mesh.positions[start_of(mesh.triangles, h)]);
    if (glm::dot(e, e) <= length2) continue;
    length2 = glm::dot(e, e);
    longest = h;
  }
  const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]);
  const glm::dvec3 n = glm::cross(glm::dvec3(mesh.positions[mesh.triangles[t].y]) - a,
                                  glm::dvec3(mesh.positions[mesh.triangles[t].z]) - a);
  return glm::length(n) <= sliver_height * length2 ? longest : no_twin;
}

}  // namespace

void flip_slivers(TriangleMesh& mesh, std::vector<std::string>& warnings) {
  std::size_t flipped = 0;
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<std::uint32_t> edges;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      if (const std::uint32_t h = sliver_edge(mesh, t); h != no_twin) edges.push_back(h);
    if (edges.empty()) break;

    const std::vector<std::uint32_t> twins = twin_half_edges(mesh.triangles);
    std::unordered_set<std::uint64_t> present;
    for (std::uint32_t h = 0; h < twins.size(); ++h)
      present.insert(edge_key(start_of(mesh.triangles, h), end_of(mesh.triangles, h)));
    std::vector<bool> changed(mesh.triangles.size(), false);  // its half-edges are stale until the next pass
    const std::size_t before = flipped;
    for (const std::uint32_t h : edges) {
      const std::uint32_t t = h / 3, u = twins[h] / 3;
      if (changed[t] || changed[u]) continue;
      const std::uint32_t p = start_of(mesh.triangles, h), q = end_of(mesh.triangles, h);
      const std::uint32_t b = end_of(mesh.triangles, next_half_edge(h));
      const std::uint32_t d = end_of(mesh.triangles, next_half_edge(twins[h]));
      if (b == d || !present.insert(edge_key(b, d)).second) continue;  // would put four triangles on an edge
      present.erase(edge_key(p, q));
      mesh.triangles[t] = {p, d, b};
      mesh.triangles[u] = {d, q, b};
      changed[t] = changed[u] = true;
      ++flipped;
    }
    if (flipped == before) break;
  }
  if (flipped > 0)
    warnings.push_back(mesh.name + ": flipped " + counted(flipped, "edge") + " at triangles without area");
}

}  // namespace turbid
