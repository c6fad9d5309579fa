// SPDX-License-Identifier: Apache-2.0
// The camera, and what stands around the medium: ground plane and background.
#pragma once
#include <glm/glm.hpp>
#include <optional>

namespace turbid {

struct Camera {
  glm::vec3 position{0, 0, 10};     ///< scene units
  glm::vec3 target{0};              ///< scene units
  glm::vec3 up{0, 1, 0};
  float fov = 35.0f;                ///< vertical field of view [degrees], in (0, 170]
  int width = 512, height = 512;    ///< pixels
  int samples = 4;                  ///< samples per pixel: a square number, on a regular sub-grid
};

/// Opaque Lambertian plane y = height, lit directly by the lights, with shadows.
struct Ground {
  float height = 0;                 ///< scene units
  glm::vec3 colour{0.5f};           ///< diffuse reflectance, in [0, 1]
  glm::vec3 colour2{0.5f};          ///< reflectance of every second square
  float checker_size = 0;           ///< edge of a square [scene units]; 0: plain colour
};

struct Surroundings {
  std::optional<Ground> ground;
  glm::vec3 background{0};          ///< radiance of what lies behind everything [W/(scene unit^2 sr)]; lights nothing
};

}  // namespace turbid
