// SPDX-License-Identifier: Apache-2.0
// A body's signed distance at the voxel centres, in voxels: from its formula, or for a mesh the distance of the nearest
// triangle with the sign of the winding number.
#include <cmath>

#include "volumes/medium_grids.h"
#include "volumes/triangle_tree.h"
#include "volumes/winding.h"

namespace turbid {
namespace {

constexpr float kBand = MediumVolume::band();
constexpr float kHalfDiagonal = 3.5f * 1.7320508f;  ///< from a block's centre to its outermost voxel centre [voxels]

/// Place of a voxel in its leaf.
int offset_of(glm::ivec3 voxel) {
  return ((voxel.x & 7) << 6) | ((voxel.y & 7) << 3) | (voxel.z & 7);
}

using Content = BlockContent<openvdb::FloatGrid>;

/// A block where the surface is farther than the band.
Content far_block(bool inside) {
  Content content;
  if (inside) content.tile = -kBand;
  return content;
}

openvdb::FloatGrid::Ptr formula_distance(const std::function<float(glm::vec3)>& distance, const GridFrame& frame) {
  return grid_from_blocks<openvdb::FloatGrid>(frame, kBand, [&](glm::ivec3 block) {
    const glm::vec3 centre = frame.origin + (glm::vec3(block) + 0.5f) * (kBlockEdge * frame.voxel_size);
    const float at_centre = distance(centre) / frame.voxel_size;
    if (std::abs(at_centre) > kBand + kHalfDiagonal + 0.01f) return far_block(at_centre < 0);
    Content content;
    content.leaf = make_leaf<openvdb::FloatGrid>(block, kBand);
    for_block_voxels([&, at = block * kBlockEdge](int voxel, int offset) {
      const glm::ivec3 local(voxel & 7, (voxel >> 3) & 7, voxel >> 6);
      const float d = std::clamp(distance(frame.centre_of(at + local)) / frame.voxel_size, -kBand, kBand);
      content.leaf->setValueOnly(offset, d);
      if (std::abs(d) < kBand) content.leaf->setValueOn(offset);
    });
    return content;
  });
}

/// The mesh in voxels: voxel centres lie at integers.
openvdb::FloatGrid::Ptr mesh_distance(const TriangleMesh& mesh, const GridFrame& frame) {
  std::vector<glm::dvec3> positions(mesh.positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = (glm::dvec3(mesh.positions[i]) - glm::dvec3(frame.origin)) / double(frame.voxel_size) - 0.5;
  const Winding winding(positions, mesh.triangles, frame.voxels);
  const TriangleTree tree(positions, mesh.triangles);

  return grid_from_blocks<openvdb::FloatGrid>(frame, kBand, [&](glm::ivec3 block) {
    const glm::ivec3 at = block * kBlockEdge;
    const float reach = kBand + kHalfDiagonal;
    if (tree.distance(glm::vec3(at) + 3.5f, reach) >= reach) return far_block(winding.inside_row(at.x, at.y, at.z)[0]);

    Content content;
    content.leaf = make_leaf<openvdb::FloatGrid>(block, kBand);
    float* d = content.leaf->buffer().data();
    // Octants of 4^3 first: many of them lie beyond the band as a whole, and for the others their centre's distance
    // bounds that of their voxels.
    constexpr float octant_half_diagonal = 1.5f * 1.7320508f + 1e-4f;
    for (int octant = 0; octant < 8; ++octant) {
      const glm::ivec3 corner = at + 4 * glm::ivec3(octant & 1, (octant >> 1) & 1, octant >> 2);
      const float centre = tree.distance(glm::vec3(corner) + 1.5f, kBand + octant_half_diagonal);
      if (centre >= kBand + octant_half_diagonal) continue;
      for (int i = 0; i < 64; ++i) {
        const glm::ivec3 voxel = corner + glm::ivec3(i & 3, (i >> 2) & 3, i >> 4);
        d[offset_of(voxel)] = tree.distance(glm::vec3(voxel), std::min(kBand, centre + octant_half_diagonal));
      }
    }
    for (int z = 0; z < kBlockEdge; ++z)
      for (int y = 0; y < kBlockEdge; ++y) {
        const auto inside = winding.inside_row(at.x, at.y + y, at.z + z);
        for (int x = 0; x < kBlockEdge; ++x) {
          const int offset = offset_of({x, y, z});
          if (d[offset] < kBand) content.leaf->setValueOn(offset);
          if (inside[x]) d[offset] = -d[offset];
        }
      }
    return content;
  });
}

}  // namespace

openvdb::FloatGrid::Ptr body_distance(const Solid& solid, const GridFrame& frame) {
  return solid.signed_distance ? formula_distance(solid.signed_distance, frame) : mesh_distance(solid.mesh, frame);
}

}  // namespace turbid
