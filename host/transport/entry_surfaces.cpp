// SPDX-License-Identifier: Apache-2.0
// Chooses what lights and cameras see first: the bodies' meshes, or the faces of a domain that is filled by a medium.
#include <algorithm>

#include "host/transport/light_rays.h"

namespace turbid {
namespace {

/// The domain's faces, or the open ones, as two triangles each, outward.
TriangleMesh domain_faces(const GridFrame& frame, const std::array<FaceBoundary, 6>& faces, bool all) {
  TriangleMesh mesh;
  mesh.name = "domain";
  const glm::vec3 low = frame.origin, high = frame.upper();
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
  }
  static constexpr unsigned kCorners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (int face = 0; face < 6; ++face) {
    if (!all && faces[face] != FaceBoundary::open) continue;
    const unsigned* c = kCorners[face];
    glm::vec3 normal(0);
    normal[face / 2] = face % 2 ? 1.0f : -1.0f;
    mesh.triangles.emplace_back(c[0], c[1], c[2]);
    mesh.triangles.emplace_back(c[0], c[2], c[3]);
    mesh.corner_normals.insert(mesh.corner_normals.end(), 6, normal);
  }
  return mesh;
}

}  // namespace

EntrySurfaces entry_surfaces(const MediumDescription& description, const MediumVolume& medium, bool all_faces) {
  EntrySurfaces surfaces;
  const Region& ambient = medium.region(0);
  surfaces.ambient = ambient.scatters || ambient.absorbs || ambient.emits ||
                     (ambient.graded_index && !ambient.smooth_surface);
  const GridFrame& frame = medium.frame();
  if (surfaces.ambient) {
    surfaces.own.push_back(domain_faces(frame, medium.faces(), all_faces));
    surfaces.bounds = {frame.origin, frame.upper()};
    if (!surfaces.own.back().triangles.empty()) surfaces.meshes.push_back({&surfaces.own.back(), 0});
    return surfaces;
  }
  surfaces.bounds = {frame.upper(), frame.origin};
  for (std::size_t i = 0; i < description.bodies.size(); ++i) {
    const TriangleMesh& mesh = description.bodies[i].solid.mesh;
    surfaces.meshes.push_back({&mesh, static_cast<int>(i) + 1});
    const Box3 box = bounds(mesh);
    surfaces.bounds.lower = glm::min(surfaces.bounds.lower, glm::max(box.lower, frame.origin));
    surfaces.bounds.upper = glm::max(surfaces.bounds.upper, glm::min(box.upper, frame.upper()));
  }
  return surfaces;
}

}  // namespace turbid
