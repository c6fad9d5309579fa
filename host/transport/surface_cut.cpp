// SPDX-License-Identifier: Apache-2.0
// See surface_cut.h.
#include "host/transport/surface_cut.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

constexpr int kEdge = 12;  // of a block and two voxels on each side
/// Length of central differences of a distance: 1 but for edges and curvature^2.
constexpr float kSmoothGradient = 0.95f;

}  // namespace

float BlockDistances::at(int body, glm::ivec3 local) {
  auto& values = values_[body];
  if (values.empty()) {
    values.resize(kEdge * kEdge * kEdge);
    medium_.read_signed_distance(body, lower_, glm::ivec3(kEdge), values);
  }
  const glm::ivec3 i = local + 2;
  return values[i.x + kEdge * (i.y + kEdge * i.z)];
}

glm::vec3 BlockDistances::gradient(int body, glm::ivec3 local) {
  glm::vec3 g;
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 step(0);
    step[axis] = 1;
    g[axis] = 0.5f * (at(body, local + step) - at(body, local - step));
  }
  return g;
}

Cut cut_by(BlockDistances& distances, int body, glm::ivec3 voxel, int axis, int sign) {
  glm::ivec3 other = voxel;
  other[axis] += sign;
  const float here = distances.at(body, voxel), there = distances.at(body, other);
  const glm::vec3 slope_here = distances.gradient(body, voxel), slope_there = distances.gradient(body, other);
  Cut cut;
  if (here * there < 0.0f) {
    cut.distance = here / (here - there);
    // The distance to a curved surface bends along the axis, by (1 - n_a^2) / R: without that the crossing would be off
    // by an eighth of it. Not at edges, where differences are shorter than 1.
    const bool smooth = std::min(glm::length(slope_here), glm::length(slope_there)) > kSmoothGradient;
    const float bend = smooth ? static_cast<float>(sign) * (slope_there[axis] - slope_here[axis]) : 0.0f;
    cut.distance += 0.5f * cut.distance * (1.0f - cut.distance) * bend / (there - here);
    cut.distance = std::clamp(cut.distance, 0.0f, 1.0f);
  }
  const glm::vec3 gradient = (1.0f - cut.distance) * slope_here + cut.distance * slope_there;
  const float length = glm::length(gradient);
  // A face that is nearly parallel to the normal's plane carries almost nothing: keep it finite.
  cut.normal = length > 1e-6f ? std::max(std::abs(gradient[axis]) / length, 0.02f) : 1.0f;
  return cut;
}

}  // namespace turbid
