// SPDX-License-Identifier: Apache-2.0
// Reads a mesh file with Assimp: every mesh of the file, placed by its nodes, as one list of triangles that
// require_closed_surface (mesh_check.cpp) then welds, checks and repairs.
//
// Assimp's readers go on after some errors (an OFF index out of range is clamped, an OBJ face that cannot be parsed is
// left out) and only log them; here each logged error about geometry is an InputError.
#include "volumes/mesh.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <mutex>
#include <string_view>
#include <utility>

#include "host/base/errors.h"
#include "volumes/mesh_file.h"
#include "volumes/mesh_text.h"

namespace turbid {
namespace {

/// Collects what Assimp logs as errors while it lives. Assimp's logger is one for the whole process, hence the lock.
class LoggedErrors {
 public:
  LoggedErrors() : lock_(mutex()) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(messages_), Assimp::Logger::Err);  // owned by the logger
  }
  ~LoggedErrors() { Assimp::DefaultLogger::kill(); }
  LoggedErrors(const LoggedErrors&) = delete;
  LoggedErrors& operator=(const LoggedErrors&) = delete;

  /// The first error that is about geometry, or nothing. Materials are not used, and an object or face statement
  /// without content leaves nothing out.
  std::string first_about_geometry() const {
    for (const std::string& message : messages_) {
      const auto harmless = {"aterial", "exture", "MTL", "No object detected", "Ignoring empty face"};
      if (std::none_of(harmless.begin(), harmless.end(),
                       [&](auto* part) { return message.find(part) != message.npos; }))
        return message;
    }
    return {};
  }

 private:
  struct Stream : Assimp::LogStream {
    explicit Stream(std::vector<std::string>& messages) : messages_(messages) {}
    void write(const char* message) override { messages_.emplace_back(message); }
    std::vector<std::string>& messages_;
  };
  static std::mutex& mutex() {
    static std::mutex the_one;
    return the_one;
  }

  std::lock_guard<std::mutex> lock_;
  std::vector<std::string> messages_;
};

/// Keeps Assimp from material files: they are not used, so a broken one must not spoil a mesh.
struct GeometryFiles : Assimp::DefaultIOSystem {
  Assimp::IOStream* Open(const char* file, const char* mode = "rb") override {
    return std::string_view(file).ends_with(".mtl") ? nullptr : DefaultIOSystem::Open(file, mode);
  }
};

/// Assimp's own words as the end of one line of ours: "Error, T0: OBJ: bad index\n" -> "OBJ: bad index".
std::string tidy(std::string message) {
  if (message.starts_with("Error,")) {
    const std::size_t colon = message.find(": ");
    if (colon != std::string::npos) message.erase(0, colon + 2);
  }
  while (!message.empty() && message.back() == '\n') message.pop_back();
  message = printable(message);
  if (message.size() > 160) message = message.substr(0, 157) + "...";
  return message;
}

[[noreturn]] void refuse_as_assimp(const std::string& path, const std::string& message) {
  std::string text = tidy(message);
  for (const char* phrase : {"index out of range", "index is out of range", "bad vertex index", "nvalid face index"})
    if (text.find(phrase) != std::string::npos)
      throw InputError(path + ": a face names a vertex that does not exist (" + text +
                       "); expected indices within the file's vertices");
  throw InputError(path + ": not a readable mesh (" + text + "); expected a complete OBJ, PLY, STL, OFF or glTF file");
}

/// Refuses what would make the triangulation read astray or abort.
void require_sound_faces(const std::string& path, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices == 0)
        throw InputError(path + ": face " + std::to_string(f) + " has no corners; expected a complete, undamaged file");
      for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k)
        if (mesh.mFaces[f].mIndices[k] >= mesh.mNumVertices)
          throw InputError(path + ": face " + std::to_string(f) + " names vertex " +
                           std::to_string(static_cast<int>(mesh.mFaces[f].mIndices[k])) +
                           ", which does not exist; expected indices below " + std::to_string(mesh.mNumVertices));
    }
  }
}

void append(TriangleMesh& mesh, const std::string& path, const aiMesh& part, const aiMatrix4x4& to_scene) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const bool in_place = to_scene == aiMatrix4x4();  // then an infinite x does not make y a NaN
  for (unsigned v = 0; v < part.mNumVertices; ++v) {
    const aiVector3D p = in_place ? part.mVertices[v] : to_scene * part.mVertices[v];
    mesh.positions.emplace_back(p.x, p.y, p.z);
  }
  const bool mirrored = to_scene.Determinant() < 0;
  for (unsigned f = 0; f < part.mNumFaces; ++f) {
    const aiFace& face = part.mFaces[f];
    if (face.mNumIndices < 3) continue;  // points and lines
    if (face.mNumIndices > 3)
      throw InputError(path + ": a polygon could not be triangulated; expected simple polygons");
    glm::uvec3 corners(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
    if (mirrored) std::swap(corners.y, corners.z);
    mesh.triangles.push_back(corners + first);
  }
}

/// The scene, owned by the importer, with valid indices and polygons cut into triangles.
const aiScene& load(Assimp::Importer& importer, const std::string& path) {
  const LoggedErrors logged;
  const aiScene* scene = nullptr;
  std::string error;
  try {
    if (lower_case_extension(path) == ".off") {
      const std::string obj = off_as_obj(path);
      scene = importer.ReadFileFromMemory(obj.data(), obj.size(), 0, "obj");
    } else {
      if (lower_case_extension(path) == ".obj") require_sound_obj_vertices(path);
      importer.SetIOHandler(new GeometryFiles);  // owned by the importer
      scene = importer.ReadFile(path, 0);
    }
    if (scene && scene->mRootNode) {
      require_sound_faces(path, *scene);
      scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& e) {
    refuse_as_assimp(path, e.what());
  }
  if (!scene || !scene->mRootNode) error = *importer.GetErrorString() ? importer.GetErrorString() : "no content";
  if (error.empty()) error = logged.first_about_geometry();
  if (!error.empty()) refuse_as_assimp(path, error);
  return *scene;
}

}  // namespace

TriangleMesh read_mesh(const std::string& path, std::vector<std::string>& warnings) {
  require_plausible_mesh_file(path);
  Assimp::Importer importer;
  const aiScene& scene = load(importer, path);

  TriangleMesh mesh;
  mesh.name = path;
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> open = {{scene.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const auto [node, parent_to_scene] = open.back();
    open.pop_back();
    const aiMatrix4x4 to_scene = parent_to_scene * node->mTransformation;
    for (unsigned m = 0; m < node->mNumMeshes; ++m) append(mesh, path, *scene.mMeshes[node->mMeshes[m]], to_scene);
    for (unsigned c = node->mNumChildren; c-- > 0;) open.emplace_back(node->mChildren[c], to_scene);
  }
  if (mesh.triangles.empty())
    throw InputError(path + ": no triangles; expected a closed surface of triangles or polygons");
  require_closed_surface(mesh, warnings);
  return mesh;
}

}  // namespace turbid
