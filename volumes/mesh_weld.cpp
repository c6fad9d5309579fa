// SPDX-License-Identifier: Apache-2.0
// Welds the points of a triangle list through a hash of grid cells, and drops points without a triangle; O(n).
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "volumes/mesh_repair.h"

namespace turbid {
namespace {

using Cell = glm::i64vec3;

struct CellHash {
  std::size_t operator()(const Cell& c) const {
    std::uint64_t h = 0;
    for (const std::int64_t v : {c.x, c.y, c.z}) {
      h = (h ^ static_cast<std::uint64_t>(v)) * 0x9E3779B97F4A7C15ull;
      h ^= h >> 32;
    }
    return h;
  }
};

/// The cell of a point: its bits if the tolerance is 0, so that only equal points share one.
Cell cell_of(const glm::vec3& p, const glm::vec3& origin, double tolerance) {
  if (tolerance > 0) return Cell(glm::floor((glm::dvec3(p) - glm::dvec3(origin)) / tolerance));
  const glm::vec3 positive_zero = p + 0.0f;  // -0 + 0 = +0
  return Cell(glm::floatBitsToInt(positive_zero));
}

/// Earlier representatives in the cells around one.
class Representatives {
 public:
  Representatives(double tolerance, std::size_t count) : tolerance_(tolerance) { cells_.reserve(count); }

  /// Index of a representative within the tolerance of `p`; else `p` becomes the next one.
  std::uint32_t place(const glm::vec3& p, std::vector<glm::vec3>& points) {
    if (points.empty()) origin_ = p;
    const Cell cell = cell_of(p, origin_, tolerance_);
    const int reach = tolerance_ > 0 ? 1 : 0;
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        for (int z = -reach; z <= reach; ++z) {
          const auto [first, last] = cells_.equal_range(cell + Cell(x, y, z));
          for (auto it = first; it != last; ++it)
            if (glm::distance(glm::dvec3(points[it->second]), glm::dvec3(p)) <= tolerance_) return it->second;
        }
    const auto index = static_cast<std::uint32_t>(points.size());
    cells_.emplace(cell, index);
    points.push_back(p);
    return index;
  }

 private:
  double tolerance_;
  glm::vec3 origin_{0};
  std::unordered_multimap<Cell, std::uint32_t, CellHash> cells_;
};

}  // namespace

std::size_t weld(TriangleMesh& mesh, double tolerance) {
  std::vector<glm::vec3> points;
  std::vector<std::uint32_t> new_index;
  new_index.reserve(mesh.positions.size());
  Representatives representatives(tolerance, mesh.positions.size());
  for (const glm::vec3& p : mesh.positions) new_index.push_back(representatives.place(p, points));
  mesh.positions = std::move(points);
  for (glm::uvec3& t : mesh.triangles) t = {new_index[t.x], new_index[t.y], new_index[t.z]};
  mesh.corner_normals.clear();
  return std::erase_if(mesh.triangles, [](const glm::uvec3& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
}

std::size_t drop_unused_positions(TriangleMesh& mesh) {
  constexpr std::uint32_t unused = UINT32_MAX;
  std::vector<std::uint32_t> new_index(mesh.positions.size(), unused);
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) new_index[t[k]] = 0;
  std::vector<glm::vec3> kept;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    if (new_index[v] == unused) continue;
    new_index[v] = static_cast<std::uint32_t>(kept.size());
    kept.push_back(mesh.positions[v]);
  }
  for (glm::uvec3& t : mesh.triangles) t = {new_index[t.x], new_index[t.y], new_index[t.z]};
  const std::size_t dropped = mesh.positions.size() - kept.size();
  mesh.positions = std::move(kept);
  return dropped;
}

}  // namespace turbid
