// SPDX-License-Identifier: Apache-2.0
// Mesh files: what loads, what is repaired with a warning, and what is refused with which words. All files are written
// here.
#include "volumes/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "host/base/errors.h"
#include "tests/unit/mesh_shapes.h"

namespace turbid {
namespace {

// The corner (0,0,0), (1,0,0), (0,1,0), (0,0,1) of the unit cube has volume 1/6.
const char* const tetrahedron_points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string tetrahedron_obj = std::string(tetrahedron_points) + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

class MeshFile : public testing::Test {
 protected:
  MeshFile() {
    std::string pattern = (std::filesystem::temp_directory_path() / "turbid-mesh-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~MeshFile() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }
  TriangleMesh read(const std::string& name, const std::string& content) {
    return read_mesh(write(name, content), warnings_);
  }
  /// The message that refuses the file; empty if it loads.
  std::string refusal_of(const std::string& file) {
    try {
      read_mesh(file, warnings_);
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }
  void expect_refusal(const std::string& name, const std::string& content, const std::string& phrase) {
    const std::string message = refusal_of(write(name, content));
    EXPECT_TRUE(message.starts_with(path(name) + ":")) << "must name the file: " << message;
    EXPECT_NE(message.find(phrase), std::string::npos) << "must say \"" << phrase << "\": " << message;
    EXPECT_NE(message.find("; expected "), std::string::npos) << "must say what is expected: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "must be one line: " << message;
  }
  std::size_t warnings_that_say(const std::string& phrase) const {
    std::size_t count = 0;
    for (const std::string& w : warnings_) count += w.find(phrase) != std::string::npos;
    return count;
  }

  std::filesystem::path folder_;
  std::vector<std::string> warnings_;
};

template <typename Number>
void append_bytes(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

std::string binary_stl(const std::vector<std::vector<glm::vec3>>& triangles) {
  std::string bytes(80, ' ');
  append_bytes(bytes, static_cast<std::uint32_t>(triangles.size()));
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) append_bytes(bytes, 0.0f);  // the normal, which nobody trusts
    for (const glm::vec3& p : t)
      for (int k = 0; k < 3; ++k) append_bytes(bytes, p[k]);
    append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

const std::string ply_header =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(MeshFile, TheSameTetrahedronHasTheSameVolumeInEveryFormat) {
  const glm::vec3 o(0), x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  const std::vector<TriangleMesh> meshes = {
      read("a.obj", tetrahedron_obj),
      read("a.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"),
      read("a.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"),
      read("a.STL", binary_stl({{o, y, x}, {o, x, z}, {x, y, z}, {y, o, z}}))};
  for (const TriangleMesh& mesh : meshes) {
    EXPECT_EQ(mesh.positions.size(), 4u) << mesh.name;  // welded, also where the format repeats points
    EXPECT_EQ(mesh.triangles.size(), 4u) << mesh.name;
    EXPECT_EQ(mesh.corner_normals.size(), 12u) << mesh.name;
    EXPECT_DOUBLE_EQ(volume(mesh), 1.0 / 6) << mesh.name;  // coordinates 0 and 1: no rounding
  }
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(MeshFile, AMirroredGltfNodeIsScaledAndStaysOutward) {
  // 4 positions (float32) and 12 indices (uint16) of the tetrahedron; the node mirrors x and doubles all lengths.
  std::string bytes;
  for (const float c : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) append_bytes(bytes, c);
  for (const int i : {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3}) append_bytes(bytes, static_cast<std::uint16_t>(i));
  write("t.bin", bytes);
  const TriangleMesh mesh = read("t.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"children":[1],"translation":[5,0,0]},{"mesh":0,"scale":[-2,2,2]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "buffers":[{"byteLength":72,"uri":"t.bin"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},
                 {"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})");
  EXPECT_NEAR(volume(mesh), 8.0 / 6, 1e-5);  // the matrices are in single precision
  EXPECT_FLOAT_EQ(bounds(mesh).lower.x, 3);
  EXPECT_FLOAT_EQ(bounds(mesh).upper.x, 5);
  EXPECT_TRUE(warnings_.empty());  // the mirror is undone by the reader, not taken for a defect
}

TEST_F(MeshFile, PolygonsAreCutIntoTriangles) {
  const TriangleMesh mesh = read("cube.off",
                                 "OFF # a comment\n8 6 12\n# points\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n"
                                 "0 1 1\n# faces, the first with a colour\n4 0 3 2 1 0.5 0.5 0.5\n4 4 5 6 7\n"
                                 "4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n");
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NEAR(volume(mesh), 1, 1e-12);  // integers divided by 6
}

TEST_F(MeshFile, AMaterialFileThatIsMissingOrBrokenDoesNotMatter) {
  write("broken.mtl", std::string(100, '\xff'));
  EXPECT_NO_THROW(read("a.obj", "mtllib broken.mtl\nmtllib missing.mtl\nusemtl glass\n" + tetrahedron_obj));
}

TEST_F(MeshFile, WhatIsNotAMeshFileIsRefusedByName) {
  EXPECT_NE(refusal_of(path("nothing.obj")).find("nothing.obj: no such file"), std::string::npos);
  std::filesystem::create_directory(path("folder.obj"));
  EXPECT_NE(refusal_of(path("folder.obj")).find("folder.obj: a directory"), std::string::npos);
  EXPECT_NE(refusal_of("/dev/null").find("not a regular file"), std::string::npos);
  expect_refusal("a.txt", tetrahedron_obj, "unknown mesh format \".txt\"");
  expect_refusal("a", tetrahedron_obj, "a name without an extension");
  for (const char* name : {"a.obj", "a.ply", "a.stl", "a.off", "a.gltf", "a.glb"}) {
    expect_refusal(name, "", "an empty file (0 bytes)");
    expect_refusal(name, std::string("\x01\xfe\x00\x80 garbage \x00\x00 v f", 20) + std::string(200, '\x7f'), "");
  }
  expect_refusal("ply_named.obj", ply_header, "content of a .ply file");
  expect_refusal("utf16.obj", std::string("\xff\xfev\0 \0", 6), "UTF-16");
  expect_refusal("points.obj", tetrahedron_points, "no triangles");
  expect_refusal("lines.obj", std::string(tetrahedron_points) + "l 1 2 3\n", "no triangles");
}

TEST_F(MeshFile, AHeaderThatClaimsMoreThanTheFileHoldsIsRefusedWithoutAllocatingIt) {
  expect_refusal("a.off", "OFF\n353535235358 6 0\n0 0 0\n", "ends after 1 of 353535235358 vertices");
  expect_refusal("b.off", "OFF\n3 99999999999999999999 0\n0 0 0\n", "no counts");  // more than 64 bits
  std::string ply = ply_header;
  ply.replace(ply.find("vertex 4"), 8, "vertex 4000000000");
  expect_refusal("a.ply", ply + "0 0 0\n", "the header claims 4000000000 entries of \"vertex\"");
  std::string stl = binary_stl({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  stl.replace(80, 4, "\xff\xff\xff\xff");
  expect_refusal("a.stl", stl, "not a readable mesh");
}

TEST_F(MeshFile, AFileThatIsCutOffIsRefused) {
  const std::string off = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3";
  expect_refusal("a.off", off.substr(0, off.size() - 8), "ends after 3 of 4 faces");
  expect_refusal("a.ply", ply_header + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n", "");
  expect_refusal("b.ply", ply_header.substr(0, 60), "without \"end_header\"");
  expect_refusal("a.obj", tetrahedron_obj.substr(0, tetrahedron_obj.size() - 8), "open surface: 3 boundary edges");
}

TEST_F(MeshFile, NumbersThatAreNotFiniteAreRefusedWithTheirPlace) {
  expect_refusal("a.obj", "v nan 0 0\n" + tetrahedron_obj, "a.obj:1: coordinate \"nan\"");
  expect_refusal("b.obj", "# points\nv 0 1e60 0\n" + tetrahedron_obj, "b.obj:2: coordinate \"1e60\"");
  expect_refusal("c.obj", "v 0 0 3.1+e2\n" + tetrahedron_obj, "coordinate \"3.1+e2\"");
  expect_refusal("d.obj", "v 0 0\n" + tetrahedron_obj, "a vertex of 2 numbers");  // would shift every index
  expect_refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", "a.off:4: coordinate \"inf\"");
  expect_refusal("a.ply", ply_header + "0 nan 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n", "nan");
  expect_refusal("a.stl", binary_stl({{{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}}}), "nan");
}

TEST_F(MeshFile, IndicesOutOfRangeAreRefused) {
  const std::string points = tetrahedron_points;
  for (const char* face : {"f 1 2 5\n", "f 1 2 0\n", "f 1 2 -5\n", "f 1 2 2147483648\n"})
    expect_refusal("a.obj", points + "f 1 3 2\n" + face, "vertex that does not exist");
  expect_refusal("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "a.off:6: a face names vertex 3");
  expect_refusal("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "a face names vertex -1");
  const std::string ply_points = ply_header + "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n";
  expect_refusal("a.ply", ply_points + "3 2 0 9\n", "face 3 names vertex 9");
  expect_refusal("b.ply", ply_points + "5 2 0 3 1 -7\n", "face 3 names vertex -7");
}

TEST_F(MeshFile, SurfacesThatBoundNoVolumeAreRefusedByKind) {
  const std::string points = tetrahedron_points;
  expect_refusal("open.obj", points + "f 1 3 2\nf 1 2 4\nf 2 3 4\n",
                 "open surface: 3 boundary edges, first at (0, 0, 0)-(0, 1, 0)");
  expect_refusal("fin.obj", points + "v 2 2 2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 2 5\n",
                 "open surface: 2 boundary edges");
  // Two tetrahedra that share the edge 1-2 but no face: which sides are inside is not defined by the edges.
  expect_refusal("edge.obj",
                 points +
                     "v 0 -1 0\nv 0 0 -1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
                     "f 1 2 6\nf 1 5 2\nf 2 5 6\nf 5 1 6\n",
                 "non-manifold: 1 edge shared by more than two triangles, first at (1, 0, 0)-(0, 0, 0)");
  expect_refusal("plane.obj", points + "f 1 2 3\n", "flat: 1 triangle in one plane");
  expect_refusal("two-sided.obj", points + "f 1 2 3\nf 1 3 2\n", "flat: the surface closes but holds no volume");
  expect_refusal("dot.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "every triangle is degenerate");
  // The projective plane with six vertices: closed, but with one side only.
  expect_refusal("one-sided.obj",
                 "v 0 0 1\nv 1 0 0\nv 0.3 1 0\nv -0.8 0.6 0.1\nv -0.8 -0.6 0\nv 0.3 -1 0.2\n"
                 "f 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 6\nf 1 6 2\n"
                 "f 2 3 5\nf 3 4 6\nf 4 5 2\nf 5 6 3\nf 6 2 4\n",
                 "one-sided surface");
}

TEST_F(MeshFile, AnInsideOutTetrahedronIsTurnedAndSaidSo) {
  const TriangleMesh mesh = read("a.obj", std::string(tetrahedron_points) + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n");
  EXPECT_DOUBLE_EQ(volume(mesh), 1.0 / 6);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_EQ(warnings_[0], path("a.obj") + ": turned the inside-out surface outward");
}

TEST_F(MeshFile, FacesThatDisagreeAreTurnedTheFewest) {
  const TriangleMesh mesh = read("a.obj", std::string(tetrahedron_points) + "f 1 3 2\nf 1 4 2\nf 2 3 4\nf 3 1 4\n");
  EXPECT_DOUBLE_EQ(volume(mesh), 1.0 / 6);
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("turned 1 of 4 triangles"), std::string::npos);
}

TEST_F(MeshFile, TrianglesWithoutAreaAndPointsWithoutTrianglesAreDropped) {
  const TriangleMesh mesh =
      read("a.off",
           "OFF\n6 6 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n7 7 7\n-0.0 0 0\n3 0 2 1\n3 5 1 3\n3 1 2 3\n3 2 0 3\n3 1 1 2\n"
           "3 0 5 3\n");
  EXPECT_EQ(mesh.positions.size(), 4u);  // -0 is 0
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_EQ(warnings_that_say("removed 2 degenerate triangles"), 1u);
}

}  // namespace
}  // namespace turbid
