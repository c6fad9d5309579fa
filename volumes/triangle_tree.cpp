// SPDX-License-Identifier: Apache-2.0
// A complete binary tree of boxes over triangles, halved at the median along the longest side of their centroids.
#include "volumes/triangle_tree.h"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace turbid {
namespace {

constexpr std::size_t kLeafTriangles = 4;

float rounded_down(double v) {
  return std::nextafter(static_cast<float>(v), -std::numeric_limits<float>::infinity());
}
float rounded_up(double v) {
  return std::nextafter(static_cast<float>(v), std::numeric_limits<float>::infinity());
}

/// Square of the distance between the origin and the triangle (a, b, c) [Ericson 2005, Real-Time Collision
/// Detection, 5.1.5].
double squared_distance(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
  const glm::dvec3 ab = b - a, ac = c - a;
  const double d1 = -dot(ab, a), d2 = -dot(ac, a);
  if (d1 <= 0 && d2 <= 0) return dot(a, a);
  const double d3 = -dot(ab, b), d4 = -dot(ac, b);
  if (d3 >= 0 && d4 <= d3) return dot(b, b);
  const double d5 = -dot(ab, c), d6 = -dot(ac, c);
  if (d6 >= 0 && d5 <= d6) return dot(c, c);
  glm::dvec3 nearest;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    nearest = a + ab * (d1 / (d1 - d3));
  } else if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    nearest = a + ac * (d2 / (d2 - d6));
  } else if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    nearest = b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  } else {
    nearest = a + (ab * vb + ac * vc) / (va + vb + vc);
  }
  return dot(nearest, nearest);
}

}  // namespace

TriangleTree::TriangleTree(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles) {
  triangles_.reserve(triangles.size());
  for (const glm::uvec3& t : triangles) triangles_.push_back({positions[t.x], positions[t.y], positions[t.z]});
  while (triangles_.size() > kLeafTriangles << levels_) ++levels_;
  boxes_.resize((std::size_t(2) << levels_) - 1);
  if (!triangles_.empty()) build(0, 0, triangles_.size(), 0);
}

void TriangleTree::build(std::size_t node, std::size_t begin, std::size_t end, int level) {
  if (level == levels_) {
    glm::dvec3 lower(std::numeric_limits<double>::max()), upper = -lower;
    for (std::size_t i = begin; i < end; ++i)
      for (const glm::dvec3& p : {triangles_[i].a, triangles_[i].b, triangles_[i].c}) {
        lower = min(lower, p);
        upper = max(upper, p);
      }
    for (int axis = 0; axis < 3; ++axis) {
      boxes_[node].lower[axis] = rounded_down(lower[axis]);
      boxes_[node].upper[axis] = rounded_up(upper[axis]);
    }
    return;
  }
  const auto centroid = [](const Triangle& t) { return t.a + t.b + t.c; };
  glm::dvec3 lower(std::numeric_limits<double>::max()), upper = -lower;
  for (std::size_t i = begin; i < end; ++i) {
    lower = min(lower, centroid(triangles_[i]));
    upper = max(upper, centroid(triangles_[i]));
  }
  const glm::dvec3 size = upper - lower;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = (begin + end) / 2;
  std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                   [&](const Triangle& s, const Triangle& t) { return centroid(s)[axis] < centroid(t)[axis]; });
  const auto left = [&] { build(2 * node + 1, begin, middle, level + 1); };
  const auto right = [&] { build(2 * node + 2, middle, end, level + 1); };
  if (end - begin > 4096) {
    tbb::parallel_invoke(left, right);
  } else {
    left();
    right();
  }
  const Box &l = boxes_[2 * node + 1], &r = boxes_[2 * node + 2];
  boxes_[node] = {min(l.lower, r.lower), max(l.upper, r.upper)};
}

float TriangleTree::distance(glm::vec3 point, float limit) const {
  if (triangles_.empty()) return limit;
  const auto squared_distance_to = [&](const Box& box) {
    const glm::vec3 outside = max(max(box.lower - point, point - box.upper), glm::vec3(0.0f));
    return dot(outside, outside);
  };
  const glm::dvec3 p(point);
  double best = double(limit) * limit;
  float prune = static_cast<float>(best) * 1.00001f;  // boxes are compared in float
  struct Pending {
    std::uint32_t node, begin, end;
    int level;
    float squared;
  };
  std::array<Pending, 64> stack;
  int depth = 0;
  stack[depth++] = {0, 0, static_cast<std::uint32_t>(triangles_.size()), 0, squared_distance_to(boxes_[0])};
  while (depth > 0) {
    const Pending at = stack[--depth];
    if (at.squared > prune) continue;
    if (at.level == levels_) {
      for (std::uint32_t i = at.begin; i < at.end; ++i) {
        const Triangle& t = triangles_[i];
        const double squared = squared_distance(t.a - p, t.b - p, t.c - p);
        if (squared < best) best = squared;
      }
      prune = static_cast<float>(best) * 1.00001f;
      continue;
    }
    const std::uint32_t middle = (at.begin + at.end) / 2, child = 2 * at.node + 1;
    const Pending left{child, at.begin, middle, at.level + 1, squared_distance_to(boxes_[child])};
    const Pending right{child + 1, middle, at.end, at.level + 1, squared_distance_to(boxes_[child + 1])};
    const bool left_first = left.squared <= right.squared;
    stack[depth++] = left_first ? right : left;
    stack[depth++] = left_first ? left : right;
  }
  return static_cast<float>(std::sqrt(best));
}

}  // namespace turbid
