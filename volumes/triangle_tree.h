// SPDX-License-Identifier: Apache-2.0
// Distance from a point to the nearest of many triangles: a bounding volume hierarchy, exact and the same on every run.
// (OpenVDB's mesh-to-volume conversion is slower here, and two voxels from the surface it is off by up to 0.2 voxel.)
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace turbid {

class TriangleTree {
 public:
  TriangleTree(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles);

  /// Distance of the nearest triangle, or `limit` if none is nearer. Safe to call from several threads at once.
  float distance(glm::vec3 point, float limit) const;

 private:
  struct Triangle {
    glm::dvec3 a, b, c;
  };
  struct Box {
    glm::vec3 lower, upper;
  };
  void build(std::size_t node, std::size_t begin, std::size_t end, int level);

  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;  ///< a complete binary tree: the children of node i are 2i + 1 and 2i + 2
  int levels_ = 0;          ///< below the root; the nodes of the last one are leaves
};

}  // namespace turbid
