// SPDX-License-Identifier: Apache-2.0
// Light sources. Positions and directions in scene units, right-handed axes.
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace turbid {

enum class LightKind { directional, point, spot };

struct Light {
  LightKind kind = LightKind::point;
  std::string name;                 ///< for messages: "light 1"
  glm::vec3 position{0};            ///< point, spot
  glm::vec3 direction{0, -1, 0};    ///< directional, spot: where the light goes, unit length
  float cone_angle = 60.0f;         ///< spot: full cone [degrees], in (0, 170]
  glm::vec3 power{1};               ///< point: into the sphere, spot: into the cone, evenly per solid angle [W]
  glm::vec3 irradiance{1};          ///< directional: on a surface that faces it [W/scene unit^2]
};
using LightList = std::vector<Light>;

}  // namespace turbid
