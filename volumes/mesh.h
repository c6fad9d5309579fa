// SPDX-License-Identifier: Apache-2.0
// Triangle meshes: read with Assimp, checked to be closed surfaces that bound a volume, else refused with a sentence.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace turbid {

/// A closed, outward-oriented triangle surface (counter-clockwise seen from outside), in scene units.
struct TriangleMesh {
  std::string name;                          ///< the file or shape it came from, for messages
  std::vector<glm::vec3> positions;          ///< welded: one entry per distinct point
  std::vector<glm::uvec3> triangles;         ///< indices into positions
  std::vector<glm::vec3> corner_normals;     ///< 3 per triangle, unit, outward; smooth within the crease angle
};

struct Box3 {
  glm::vec3 lower{0}, upper{0};
  glm::vec3 size() const { return upper - lower; }
  glm::vec3 centre() const { return 0.5f * (lower + upper); }
};

Box3 bounds(const TriangleMesh&);

/// Reads OBJ, PLY, STL, OFF or glTF (all meshes of the file, with the node transforms, welded together).
/// `warnings` receives one sentence for each repair made (inside-out surface turned, degenerate triangles removed, ...).
/// Throws InputError naming the file when it is missing, unreadable, not a mesh, empty, has NaN or infinite
/// coordinates, or is open, non-manifold or flat.
TriangleMesh read_mesh(const std::string& path, std::vector<std::string>& warnings);

/// Checks and repairs a mesh in place as read_mesh does: welds equal points, drops degenerate triangles, makes the
/// orientation consistent and outward; throws InputError (prefixed by mesh.name) if it does not bound a volume.
void require_closed_surface(TriangleMesh& mesh, std::vector<std::string>& warnings);

/// Angle-weighted vertex normals (Thuermer and Wuethrich 1998), split where adjacent faces meet at more than
/// `crease_degrees`.
void compute_corner_normals(TriangleMesh& mesh, float crease_degrees = 40.0f);

/// x -> rotation * (scale * x) + translation, applied to positions (normals are recomputed).
void transform(TriangleMesh& mesh, const glm::mat3& rotation, float scale, glm::vec3 translation);

}  // namespace turbid
