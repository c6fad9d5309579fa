// SPDX-License-Identifier: Apache-2.0
// Edges of a triangle list by sorting the half-edges; O(n log n).
#include "volumes/mesh_topology.h"

#include <algorithm>

namespace turbid {
namespace {

struct EdgeUse {
  std::uint64_t key;
  std::uint32_t half_edge;
  bool operator<(const EdgeUse& other) const {
    return key != other.key ? key < other.key : half_edge < other.half_edge;
  }
};

/// Calls visit(first use, number of uses) for every edge.
template <typename Visit>
void for_each_edge(const std::vector<glm::uvec3>& triangles, Visit visit) {
  std::vector<EdgeUse> uses(3 * triangles.size());
  for (std::uint32_t h = 0; h < uses.size(); ++h) uses[h] = {edge_key(start_of(triangles, h), end_of(triangles, h)), h};
  std::sort(uses.begin(), uses.end());
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i + 1;
    while (end < uses.size() && uses[end].key == uses[i].key) ++end;
    visit(&uses[i], end - i);
    i = end;
  }
}

}  // namespace

std::vector<std::uint32_t> twin_half_edges(const std::vector<glm::uvec3>& triangles) {
  std::vector<std::uint32_t> twins(3 * triangles.size(), no_twin);
  for_each_edge(triangles, [&](const EdgeUse* uses, std::size_t count) {
    if (count != 2) return;
    twins[uses[0].half_edge] = uses[1].half_edge;
    twins[uses[1].half_edge] = uses[0].half_edge;
  });
  return twins;
}

EdgeDefects edge_defects(const std::vector<glm::uvec3>& triangles) {
  EdgeDefects defects;
  for_each_edge(triangles, [&](const EdgeUse* uses, std::size_t count) {
    if (count == 1) {
      ++defects.open;
      defects.first_open = std::min(defects.first_open, uses[0].half_edge);
    } else if (count > 2) {
      ++defects.crowded;
      defects.first_crowded = std::min(defects.first_crowded, uses[0].half_edge);
    }
  });
  return defects;
}

Components connected_components(const std::vector<std::uint32_t>& twins) {
  constexpr std::uint32_t unseen = UINT32_MAX;
  Components components{std::vector<std::uint32_t>(twins.size() / 3, unseen), 0};
  std::vector<std::uint32_t> open;
  for (std::uint32_t seed = 0; seed < components.of_triangle.size(); ++seed) {
    if (components.of_triangle[seed] != unseen) continue;
    components.of_triangle[seed] = components.count;
    open.push_back(seed);
    while (!open.empty()) {
      const std::uint32_t t = open.back();
      open.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t twin = twins[h];
        if (twin == no_twin || components.of_triangle[twin / 3] != unseen) continue;
        components.of_triangle[twin / 3] = components.count;
        open.push_back(twin / 3);
      }
    }
    ++components.count;
  }
  return components;
}

}  // namespace turbid
