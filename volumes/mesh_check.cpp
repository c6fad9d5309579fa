// SPDX-License-Identifier: Apache-2.0
// Does a triangle mesh bound a volume? Every edge must have exactly two triangles (vertices where several sheets touch
// are accepted), and the components must have volume. Self-intersections are not looked for.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "host/base/errors.h"
#include "volumes/mesh.h"
#include "volumes/mesh_repair.h"
#include "volumes/mesh_topology.h"

namespace turbid {
namespace {

constexpr double weld_tolerance =
    1e-6;  // of the bounding box's diagonal: about ten roundings of a single-precision number

using Triangles = std::vector<glm::uvec3>;

double diagonal(const TriangleMesh& mesh) {
  const Box3 box = bounds(mesh);
  return glm::length(glm::dvec3(box.upper) - glm::dvec3(box.lower));
}

void require_sound_numbers(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw InputError(mesh.name + ": no triangles; expected a closed surface");
  for (const glm::uvec3& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      if (t[k] >= mesh.positions.size())
        throw InputError(mesh.name + ": a face names vertex " + std::to_string(t[k]) +
                         ", which does not exist; expected indices below " + std::to_string(mesh.positions.size()));
      const glm::vec3& p = mesh.positions[t[k]];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw InputError(mesh.name + ": a corner at " + to_text(p) + "; expected finite coordinates");
    }
}

/// Do all points lie in the plane of the largest triangle?
bool is_planar(const TriangleMesh& mesh) {
  glm::dvec3 normal(0), origin(0);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    if (glm::dot(n, n) <= glm::dot(normal, normal)) continue;
    normal = n;
    origin = a;
  }
  if (normal == glm::dvec3(0)) return true;
  normal = glm::normalize(normal);
  const double tolerance = weld_tolerance * diagonal(mesh);
  return std::all_of(mesh.positions.begin(), mesh.positions.end(), [&](const glm::vec3& p) {
    return std::abs(glm::dot(normal, glm::dvec3(p) - origin)) <= tolerance;
  });
}

/// Triangles with the same three corners in groups: keeps one of each group, or, if `in_pairs`, one of each odd group.
Triangles without_coincident(const Triangles& triangles, bool in_pairs) {
  const auto corners = [&](std::uint32_t t) {
    std::array<std::uint32_t, 3> sorted = {triangles[t].x, triangles[t].y, triangles[t].z};
    std::sort(sorted.begin(), sorted.end());
    return sorted;
  };
  std::vector<std::uint32_t> order(triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return corners(a) < corners(b); });
  std::vector<bool> keep(triangles.size(), false);
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i + 1;
    while (end < order.size() && corners(order[end]) == corners(order[i])) ++end;
    if (!in_pairs || (end - i) % 2 == 1) keep[order[i]] = true;
    i = end;
  }
  Triangles kept;
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (keep[t]) kept.push_back(triangles[t]);
  return kept;
}

std::string edge_text(const TriangleMesh& mesh, std::uint32_t half_edge) {
  return to_text(mesh.positions[start_of(mesh.triangles, half_edge)]) + "-" +
         to_text(mesh.positions[end_of(mesh.triangles, half_edge)]);
}

[[noreturn]] void refuse(const TriangleMesh& mesh, const EdgeDefects& defects) {
  if (is_planar(mesh))
    throw InputError(mesh.name + ": flat: " + counted(mesh.triangles.size(), "triangle") +
                     " in one plane; expected a closed surface that bounds a volume");
  if (defects.open > 0)
    throw InputError(mesh.name + ": open surface: " + counted(defects.open, "boundary edge") + ", first at " +
                     edge_text(mesh, defects.first_open) +
                     (defects.crowded > 0
                          ? ", and " + counted(defects.crowded, "edge") + " shared by more than two triangles"
                          : "") +
                     "; expected a watertight mesh");
  throw InputError(mesh.name + ": non-manifold: " + counted(defects.crowded, "edge") +
                   " shared by more than two triangles, first at " + edge_text(mesh, defects.first_crowded) +
                   "; expected exactly two triangles at each edge");
}

}  // namespace

std::string to_text(glm::dvec3 point) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "(%.6g, %.6g, %.6g)", point.x, point.y, point.z);
  return text.data();
}

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

void require_two_triangles_per_edge(TriangleMesh& mesh, std::vector<std::string>& warnings) {
  const EdgeDefects defects = edge_defects(mesh.triangles);
  if (defects.none()) return;
  if (defects.open > 0) {
    TriangleMesh welded = mesh;
    const std::size_t removed = weld(welded, weld_tolerance * diagonal(mesh));
    if (!welded.triangles.empty() && edge_defects(welded.triangles).none()) {
      warnings.push_back(mesh.name + ": " + counted(defects.open, "boundary edge") +
                         " closed by welding points within 1e-6 of the bounding box's diagonal" +
                         (removed > 0 ? ", which removed " + counted(removed, "triangle") : ""));
      mesh = std::move(welded);
      return;
    }
  }
  for (const bool in_pairs : {false, true}) {
    Triangles kept = without_coincident(mesh.triangles, in_pairs);
    if (kept.empty() || !edge_defects(kept).none()) continue;
    const std::size_t removed = mesh.triangles.size() - kept.size();
    warnings.push_back(mesh.name + ": removed " +
                       (in_pairs ? counted(removed, "triangle") + " that coincide in pairs (walls without thickness)"
                                 : counted(removed, "duplicate triangle")));
    mesh.triangles = std::move(kept);
    return;
  }
  refuse(mesh, defects);
}

void require_closed_surface(TriangleMesh& mesh, std::vector<std::string>& warnings) {
  require_sound_numbers(mesh);
  if (const std::size_t unused = drop_unused_positions(mesh); unused > 0)
    warnings.push_back(mesh.name + ": dropped " + counted(unused, "point") + " that no triangle uses");
  if (const std::size_t removed = weld(mesh, 0); removed > 0)
    warnings.push_back(mesh.name + ": removed " + counted(removed, "degenerate triangle") + " (two corners coincide)");
  if (mesh.triangles.empty())
    throw InputError(mesh.name + ": every triangle is degenerate; expected a closed surface that bounds a volume");
  require_two_triangles_per_edge(mesh, warnings);
  orient_consistently(mesh, warnings);
  flip_slivers(mesh, warnings);
  turn_outward(mesh, warnings);
  drop_unused_positions(mesh);
  compute_corner_normals(mesh);
}

}  // namespace turbid
