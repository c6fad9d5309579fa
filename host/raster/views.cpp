// SPDX-License-Identifier: Apache-2.0
// The views of cameras, spot and point lights (perspective) and of directional lights (parallel).
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/base/errors.h"
#include "host/raster/raster.h"

namespace turbid {
namespace {

// The smallest near / far. The projection is kept in 32-bit floats, whose rounding moves the far plane by about
// 6e-8 / (2 near / far) of its distance: 0.03 % here, inside the margin below.
constexpr float kNearest = 1e-4f;
constexpr float kMargin = 0.01f;

glm::vec3 unit(glm::vec3 v, const char* what) {
  const float length = glm::length(v);
  if (!(length > 0) || !std::isfinite(length))
    throw InputError(std::string(what) + " has no direction: it must be a finite vector other than 0");
  return v / length;
}

/// `up` if it is clearly not along `forward`, else the axis that is farthest from it.
glm::vec3 usable_up(glm::vec3 forward, glm::vec3 up) {
  const float length = glm::length(up);
  if (length > 0 && glm::length(glm::cross(forward, up / length)) > 1e-4f) return up / length;
  const glm::vec3 a = glm::abs(forward);
  if (a.y <= a.x && a.y <= a.z) return {0, 1, 0};
  return a.z <= a.x ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
}

glm::mat4 look(glm::vec3 eye, glm::vec3 forward, glm::vec3 up) {
  // In double: the translation is -rotation * eye, and lookAt's own eye + forward would round where eye is large.
  const glm::dvec3 e(eye);
  return glm::mat4(glm::lookAt(e, e + glm::dvec3(forward), glm::dvec3(usable_up(forward, up))));
}

RasterView perspective_view(glm::vec3 eye, glm::vec3 forward, glm::vec3 up, float fov_degrees, int width, int height,
                            const Box3& box) {
  if (!(fov_degrees > 0 && fov_degrees < 180)) throw InputError("a field of view must lie between 0 and 180 degrees");
  if (width <= 0 || height <= 0) throw InputError("a picture needs at least one pixel each way");
  float nearest = INFINITY, farthest = -INFINITY;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::vec3 p(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                      corner & 4 ? box.upper.z : box.lower.z);
    const float depth = glm::dot(p - eye, forward);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  // All of the scene behind the eye: nothing is seen, any valid planes do.
  const float far_plane = farthest > 0 ? (1 + kMargin) * farthest : 1.0f;
  const float near_plane = std::max((1 - kMargin) * nearest, kNearest * far_plane);
  RasterView view;
  view.view = look(eye, forward, up);
  view.projection = glm::mat4(glm::perspectiveRH_NO(glm::radians(double(fov_degrees)), double(width) / height,
                                                    double(near_plane), double(far_plane)));
  view.width = width;
  view.height = height;
  return view;
}

}  // namespace

RasterView camera_view(glm::vec3 position, glm::vec3 target, glm::vec3 up, float fov_degrees, int width, int height,
                       const Box3& scene_bounds) {
  const glm::vec3 forward = unit(target - position, "the camera (target - position)");
  return perspective_view(position, forward, up, fov_degrees, width, height, scene_bounds);
}

RasterView cone_view(glm::vec3 position, glm::vec3 axis, float full_angle_degrees, int size, const Box3& scene_bounds) {
  return perspective_view(position, unit(axis, "the cone's axis"), {0, 1, 0}, full_angle_degrees, size, size,
                          scene_bounds);
}

RasterView parallel_view(glm::vec3 direction, glm::vec3 centre, float radius, int size) {
  if (!(radius > 0)) throw InputError("a parallel view needs a radius > 0");
  if (size <= 0) throw InputError("a picture needs at least one pixel each way");
  const glm::vec3 forward = unit(direction, "the light's direction");
  const double r = radius;
  RasterView view;
  view.view = look(centre - 2.0f * radius * forward, forward, {0, 1, 0});
  view.projection = glm::mat4(glm::orthoRH_NO(-r, r, -r, r, (1 - kMargin) * r, (3 + kMargin) * r));
  view.width = view.height = size;
  return view;
}

}  // namespace turbid
