// SPDX-License-Identifier: Apache-2.0
// Looks at a mesh file before Assimp does (for read_mesh only).
#pragma once
#include <string>

namespace turbid {

/// Throws InputError unless `path` is a regular, readable file whose name ends in .obj, .ply, .stl, .off, .gltf or
/// .glb, whose first bytes agree with that, and whose header does not claim more than the file can hold.
void require_plausible_mesh_file(const std::string& path);

/// ".obj" for "a/b.OBJ"
std::string lower_case_extension(const std::string& path);

}  // namespace turbid
