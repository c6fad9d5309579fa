// SPDX-License-Identifier: Apache-2.0
// A body's geometry: its surface as triangles (for rasterising) and its signed distance (for voxels and rays).
#pragma once
#include <functional>
#include <glm/glm.hpp>

#include "volumes/mesh.h"

namespace turbid {

struct Solid {
  TriangleMesh mesh;
  /// Exact signed distance [scene units], negative inside; empty for meshes, whose distance OpenVDB computes.
  std::function<float(glm::vec3)> signed_distance;
};

/// Rigid motion and uniform scale that places a shape or mesh in the scene.
struct Placement {
  glm::mat3 rotation{1.0f};      ///< right-handed
  float scale = 1.0f;            ///< > 0
  glm::vec3 translation{0.0f};   ///< scene units
};

/// Primitives centred at the origin before placement; the triangles approximate curved ones finely (>= 96 segments).
Solid make_sphere(float radius, const Placement&);
Solid make_box(glm::vec3 size, const Placement&);
/// Axis along y.
Solid make_cylinder(float radius, float height, const Placement&);
Solid make_mesh_solid(TriangleMesh mesh, const Placement&);

}  // namespace turbid
