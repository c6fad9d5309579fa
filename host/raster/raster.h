// SPDX-License-Identifier: Apache-2.0
// First hits by rasterising with OSMesa: what a camera or a light sees of the meshes (the paper's Init pass).
#pragma once
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "volumes/mesh.h"

namespace turbid {

struct RasterMesh {
  const TriangleMesh* mesh = nullptr;
  int id = 0;                      ///< >= 0, comes back in RasterImage::id
};

/// world -> eye -> clip, OpenGL conventions (eye looks along -z, clip z in [-w, w]).
struct RasterView {
  glm::mat4 view{1}, projection{1};
  int width = 0, height = 0;
  bool operator==(const RasterView&) const = default;
};

/// Row 0 is the TOP row; pixel centres are sampled. Arrays have width * height entries, x fastest.
struct RasterImage {
  int width = 0, height = 0;
  std::vector<int> id;                ///< -1 where nothing is seen
  std::vector<glm::vec3> position;    ///< world position of the hit [scene units]
  std::vector<glm::vec3> normal;      ///< shading normal, unit, outward from its mesh; may point away from the eye
  std::vector<unsigned char> front;   ///< 1: the outside of the surface is seen, 0: its inside
};

/// Nearest hit per pixel. Deterministic. Images larger than OSMesa's limit are drawn in tiles.
/// Throws DeviceError if OSMesa can't make a context.
RasterImage rasterise(std::span<const RasterMesh> meshes, const RasterView& view);

/// Perspective view of a camera, near and far planes fitted to `scene_bounds`.
RasterView camera_view(glm::vec3 position, glm::vec3 target, glm::vec3 up, float fov_degrees, int width, int height,
                       const Box3& scene_bounds);
/// Perspective view from a point along `axis` with a full opening angle [degrees] (square image).
RasterView cone_view(glm::vec3 position, glm::vec3 axis, float full_angle_degrees, int size, const Box3& scene_bounds);
/// Parallel view along `direction` that covers the sphere about `centre` (square image).
RasterView parallel_view(glm::vec3 direction, glm::vec3 centre, float radius, int size);

}  // namespace turbid
