// SPDX-License-Identifier: Apache-2.0
// Where the voxels lie: the axis-aligned domain, cut into cubes of one size.
#pragma once
#include <glm/glm.hpp>

namespace turbid {

inline constexpr int kBlockEdge = 8;  ///< voxels along a block's edge: OpenVDB's leaf size

/// The centre of voxel (i, j, k) lies at origin + (i + 1/2, j + 1/2, k + 1/2) * voxel_size [scene units].
struct GridFrame {
  glm::ivec3 voxels{0};        ///< each a multiple of kBlockEdge
  glm::vec3 origin{0.0f};      ///< lower corner of the domain [scene units]
  float voxel_size = 1.0f;     ///< [scene units]

  glm::ivec3 blocks() const { return voxels / kBlockEdge; }
  glm::vec3 size() const { return glm::vec3(voxels) * voxel_size; }
  glm::vec3 upper() const { return origin + size(); }
  glm::vec3 centre_of(glm::ivec3 voxel) const { return origin + (glm::vec3(voxel) + 0.5f) * voxel_size; }
};

/// What happens at a face of the domain, to rays and to diffuse light alike.
enum class FaceBoundary { open, mirror, periodic };

}  // namespace turbid
