// SPDX-License-Identifier: Apache-2.0
// Gives a closed triangle mesh one orientation: neighbours agree, and normals point out of the body. What is inside is
// decided by parity: a component inside another one bounds a cavity, one inside that cavity a body again.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/base/errors.h"
#include "volumes/mesh_repair.h"
#include "volumes/mesh_topology.h"

namespace turbid {
namespace {

// A body thinner than this times its length has no volume in single precision.
constexpr double flat_thickness = 1e-6;

struct Component {
  std::vector<std::uint32_t> triangles;
  glm::dvec3 lower{INFINITY}, upper{-INFINITY};
  double volume = 0;  ///< signed: negative if inside out
  double area = 0;
  bool flat() const { return std::abs(volume) <= flat_thickness * area * glm::length(upper - lower); }
  bool box_contains(const Component& other) const {
    return glm::all(glm::lessThan(lower, other.lower)) && glm::all(glm::lessThan(other.upper, upper));
  }
};

std::vector<Component> measure(const TriangleMesh& mesh) {
  const Components labels = connected_components(twin_half_edges(mesh.triangles));
  std::vector<Component> components(labels.count);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Component& component = components[labels.of_triangle[t]];
    component.triangles.push_back(t);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p(mesh.positions[mesh.triangles[t][k]]);
      component.lower = glm::min(component.lower, p);
      component.upper = glm::max(component.upper, p);
    }
  }
  for (Component& component : components) {
    const glm::dvec3 centre = 0.5 * (component.lower + component.upper);  // keeps the sum of small terms accurate
    for (const std::uint32_t t : component.triangles) {
      const glm::dvec3 a = glm::dvec3(mesh.positions[mesh.triangles[t].x]) - centre;
      const glm::dvec3 b = glm::dvec3(mesh.positions[mesh.triangles[t].y]) - centre;
      const glm::dvec3 c = glm::dvec3(mesh.positions[mesh.triangles[t].z]) - centre;
      component.volume += glm::dot(a, glm::cross(b, c)) / 6;
      component.area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
  }
  return components;
}

/// Does edge ab, seen along z, pass the point on its side of larger x? Half-open in y, and the same for ab and ba, so
/// that neighbouring triangles neither both count a point nor both miss it.
bool passes(const glm::dvec3& p, glm::dvec3 a, glm::dvec3 b) {
  if ((a.y > p.y) == (b.y > p.y)) return false;
  if (a.y > b.y || (a.y == b.y && a.x > b.x)) std::swap(a, b);
  return a.x + (p.y - a.y) * ((b.x - a.x) / (b.y - a.y)) > p.x;
}

/// Parity of the surface's crossings with the ray from p along +z.
bool contains(const TriangleMesh& mesh, const Component& component, const glm::dvec3& p) {
  bool inside = false;
  for (const std::uint32_t t : component.triangles) {
    const glm::dvec3 a(mesh.positions[mesh.triangles[t].x]);
    const glm::dvec3 b(mesh.positions[mesh.triangles[t].y]);
    const glm::dvec3 c(mesh.positions[mesh.triangles[t].z]);
    if ((passes(p, a, b) != passes(p, b, c)) == passes(p, c, a)) continue;  // an even number of edges
    const glm::dvec3 n = glm::cross(b - a, c - a);
    if (n.z != 0 && a.z - (n.x * (p.x - a.x) + n.y * (p.y - a.y)) / n.z > p.z) inside = !inside;
  }
  return inside;
}

/// Inside at a few points spread over it. (Bodies that only overlap are then seldom taken as nested.)
bool is_nested(const TriangleMesh& mesh, const Component& inner, const Component& outer) {
  if (!outer.box_contains(inner)) return false;
  constexpr std::size_t samples = 8;
  for (std::size_t s = 0; s < samples; ++s) {
    const std::uint32_t t = inner.triangles[s * (inner.triangles.size() - 1) / (samples - 1)];
    glm::dvec3 centroid(0);
    for (int k = 0; k < 3; ++k) centroid += glm::dvec3(mesh.positions[mesh.triangles[t][k]]) / 3.0;
    if (!contains(mesh, outer, centroid)) return false;
  }
  return true;
}

void remove_flat_components(TriangleMesh& mesh, std::vector<std::string>& warnings) {
  const std::vector<Component> components = measure(mesh);
  std::vector<bool> keep(mesh.triangles.size(), true);
  std::size_t flat = 0;
  double area = 0;
  for (const Component& component : components) {
    area += component.area;
    if (!component.flat()) continue;
    ++flat;
    for (const std::uint32_t t : component.triangles) keep[t] = false;
  }
  if (flat == 0) return;
  if (flat == components.size()) {
    std::array<char, 64> number{};
    std::snprintf(number.data(), number.size(), "%.3g", area);
    throw InputError(mesh.name + ": flat: the surface closes but holds no volume (its area is " + number.data() +
                     "); expected a closed surface that bounds a volume");
  }
  std::vector<glm::uvec3> kept;
  for (std::size_t t = 0; t < keep.size(); ++t)
    if (keep[t]) kept.push_back(mesh.triangles[t]);
  warnings.push_back(mesh.name + ": removed " + counted(flat, "component") + " without volume (" +
                     counted(mesh.triangles.size() - kept.size(), "triangle") + ")");
  mesh.triangles = std::move(kept);
}

}  // namespace

void orient_consistently(TriangleMesh& mesh, std::vector<std::string>& warnings) {
  const std::vector<glm::uvec3>& triangles = mesh.triangles;
  const std::vector<std::uint32_t> twins = twin_half_edges(triangles);
  enum : std::uint8_t { unseen, as_is, turned };
  std::vector<std::uint8_t> state(triangles.size(), unseen);
  std::vector<std::uint32_t> members;
  std::size_t total_turned = 0;
  for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
    if (state[seed] != unseen) continue;
    state[seed] = as_is;
    members.assign(1, seed);
    std::size_t turned_here = 0;
    for (std::size_t next = 0; next < members.size(); ++next) {
      const std::uint32_t t = members[next];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const std::uint32_t other = twins[h] / 3;
        const bool disagree = start_of(triangles, h) == start_of(triangles, twins[h]);  // neighbours run opposite ways
        const std::uint8_t wanted = disagree == (state[t] == as_is) ? turned : as_is;
        if (state[other] == unseen) {
          state[other] = wanted;
          turned_here += wanted == turned;
          members.push_back(other);
        } else if (state[other] != wanted) {
          throw InputError(mesh.name + ": one-sided surface, seen at " +
                           to_text(mesh.positions[start_of(triangles, h)]) +
                           "; expected a surface with an inside and an outside");
        }
      }
    }
    if (2 * turned_here > members.size()) {  // turn the fewer
      turned_here = members.size() - turned_here;
      for (const std::uint32_t t : members) state[t] = state[t] == turned ? as_is : turned;
    }
    total_turned += turned_here;
  }
  if (total_turned == 0) return;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (state[t] == turned) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
  warnings.push_back(mesh.name + ": turned " + std::to_string(total_turned) + " of " +
                     counted(mesh.triangles.size(), "triangle") + " to agree with their neighbours");
}

void turn_outward(TriangleMesh& mesh, std::vector<std::string>& warnings) {
  remove_flat_components(mesh, warnings);
  const std::vector<Component> components = measure(mesh);
  std::size_t bodies = 0, cavities = 0;
  for (const Component& component : components) {
    bool is_cavity = false;
    for (const Component& outer : components)
      if (&outer != &component && is_nested(mesh, component, outer)) is_cavity = !is_cavity;
    if (is_cavity == (component.volume < 0)) continue;
    ++(is_cavity ? cavities : bodies);
    for (const std::uint32_t t : component.triangles) std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
  }
  if (bodies > 0)
    warnings.push_back(mesh.name + ": turned " +
                       (components.size() == 1 ? "the inside-out surface" : counted(bodies, "inside-out component")) +
                       " outward");
  if (cavities > 0)
    warnings.push_back(mesh.name + ": took " + counted(cavities, "component") + " inside another one as " +
                       (cavities == 1 ? "a cavity" : "cavities"));
}

}  // namespace turbid
