// SPDX-License-Identifier: Apache-2.0
// Edges of a triangle list. Half-edge h = 3 t + k runs from corner k of triangle t to the next corner.
#pragma once
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace turbid {

inline constexpr std::uint32_t no_twin = UINT32_MAX;

inline std::uint32_t next_half_edge(std::uint32_t h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
inline std::uint32_t start_of(const std::vector<glm::uvec3>& triangles, std::uint32_t h) {
  return triangles[h / 3][static_cast<int>(h % 3)];
}
inline std::uint32_t end_of(const std::vector<glm::uvec3>& triangles, std::uint32_t h) {
  return start_of(triangles, next_half_edge(h));
}
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
}

/// For every half-edge the other one on its edge (in either direction); no_twin where an edge has not exactly two.
std::vector<std::uint32_t> twin_half_edges(const std::vector<glm::uvec3>& triangles);

/// Edges that a closed manifold surface does not have.
struct EdgeDefects {
  std::size_t open = 0;                ///< used by one triangle
  std::size_t crowded = 0;             ///< used by more than two
  std::uint32_t first_open = no_twin;  ///< a half-edge, lowest index
  std::uint32_t first_crowded = no_twin;
  bool none() const { return open == 0 && crowded == 0; }
};
EdgeDefects edge_defects(const std::vector<glm::uvec3>& triangles);

/// Triangles connected over edges with a twin: a label for each, and how many labels there are.
struct Components {
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 0;
};
Components connected_components(const std::vector<std::uint32_t>& twins);

}  // namespace turbid
