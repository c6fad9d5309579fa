// SPDX-License-Identifier: Apache-2.0
// Fields from OpenVDB files, on files that the tests write themselves.
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>

#include "host/base/errors.h"
#include "tests/unit/scene_files.h"
#include "volumes/procedural.h"

namespace turbid {
namespace {

using test::Folder;

glm::vec3 at(const FieldPtr& field, glm::vec3 x) {
  glm::vec3 value;
  field->evaluate({&x, 1}, {&value, 1});
  return value;
}

/// Value 10 i at voxel (i, j, k) of an 8^3 cube; background 0.5; voxels of 2 units, voxel (0,0,0) centred at (10, 0,
/// 0).
template <class Grid>
typename Grid::Ptr ramp(const std::string& name) {
  openvdb::initialize();
  auto grid = Grid::create(typename Grid::ValueType(0.5f));
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 8; ++k) grid->tree().setValue({i, j, k}, typename Grid::ValueType(10.0f * i));
  auto transform = openvdb::math::Transform::createLinearTransform(2.0);
  transform->postTranslate({10, 0, 0});
  grid->setTransform(transform);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

void write(const std::string& path, const openvdb::GridCPtrVec& grids) {
  openvdb::io::File(path).write(grids);
}

std::string error_of(const std::string& path, const std::string& grid = "") {
  try {
    vdb_field(path, grid, glm::vec3(1), glm::vec3(0));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(VdbField, is_trilinear_in_the_grids_own_transform) {
  const Folder folder;
  write(folder.file("a.vdb"), {ramp<openvdb::FloatGrid>("density")});
  const FieldPtr field = vdb_field(folder.file("a.vdb"), "density", glm::vec3(1), glm::vec3(0));
  EXPECT_FLOAT_EQ(at(field, {14, 4, 4}).x, 20.0f);
  EXPECT_FLOAT_EQ(at(field, {15, 4.5f, 4}).y, 25.0f);
}

TEST(VdbField, is_the_background_outside_the_grid) {
  const Folder folder;
  write(folder.file("a.vdb"), {ramp<openvdb::FloatGrid>("density")});
  const FieldPtr field = vdb_field(folder.file("a.vdb"), "density", glm::vec3(1), glm::vec3(0));
  EXPECT_FLOAT_EQ(at(field, {-100, 0, 0}).x, 0.5f);
  EXPECT_FLOAT_EQ(at(field, {1e6f, 1e6f, 1e6f}).x, 0.5f);
}

TEST(VdbField, scale_and_offset_are_per_colour) {
  const Folder folder;
  write(folder.file("a.vdb"), {ramp<openvdb::FloatGrid>("density")});
  const FieldPtr field = vdb_field(folder.file("a.vdb"), "", {1, 2, 0}, {0, 1, 5});
  EXPECT_EQ(at(field, {14, 4, 4}), glm::vec3(20, 41, 5));
}

TEST(VdbField, reads_vectors_and_doubles) {
  const Folder folder;
  auto colour = ramp<openvdb::Vec3SGrid>("colour");
  colour->tree().setValue({2, 2, 2}, {1, 2, 3});
  write(folder.file("a.vdb"), {colour});
  EXPECT_EQ(at(vdb_field(folder.file("a.vdb"), "", glm::vec3(1), glm::vec3(0)), {14, 4, 4}), glm::vec3(1, 2, 3));
  write(folder.file("b.vdb"), {ramp<openvdb::DoubleGrid>("d")});
  EXPECT_FLOAT_EQ(at(vdb_field(folder.file("b.vdb"), "d", glm::vec3(1), glm::vec3(0)), {14, 4, 4}).x, 20.0f);
}

TEST(VdbField, names_the_grids_there_are) {
  const Folder folder;
  const std::string path = folder.file("a.vdb");
  write(path, {ramp<openvdb::FloatGrid>("density"), ramp<openvdb::Vec3SGrid>("colour")});
  EXPECT_EQ(error_of(path, "smoke"),
            path + ": has no grid \"smoke\"; there are \"colour\" (vec3s), \"density\" (float)");
  EXPECT_EQ(error_of(path), path +
                                ": holds several densities, say which with the key grid; there are \"colour\" (vec3s), "
                                "\"density\" (float)");
}

TEST(VdbField, tells_grids_of_one_name_apart) {
  const Folder folder;
  const std::string path = folder.file("a.vdb");
  auto second = ramp<openvdb::FloatGrid>("density");
  second->tree().setValue({2, 2, 2}, 99);
  write(path, {ramp<openvdb::FloatGrid>("density"), second});
  EXPECT_EQ(error_of(path, "density"), path +
                                           ": holds several grids \"density\", say which with the key grid; there are "
                                           "\"density[0]\" (float), \"density[1]\" (float)");
  EXPECT_FLOAT_EQ(at(vdb_field(path, "density[1]", glm::vec3(1), glm::vec3(0)), {14, 4, 4}).x, 99.0f);
}

TEST(VdbField, refuses_level_sets) {
  const Folder folder;
  const std::string path = folder.file("a.vdb");
  auto grid = ramp<openvdb::FloatGrid>("ls");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  write(path, {grid});
  EXPECT_NE(error_of(path, "ls").find("grid \"ls\" is a level set (distances to a surface): expected a density"),
            std::string::npos);
  EXPECT_NE(error_of(path).find("holds no density"), std::string::npos);
}

TEST(VdbField, passes_over_a_level_set_if_the_file_has_one_density) {
  const Folder folder;
  auto other = ramp<openvdb::FloatGrid>("ls");
  other->setGridClass(openvdb::GRID_LEVEL_SET);
  write(folder.file("a.vdb"), {other, ramp<openvdb::FloatGrid>("density")});
  EXPECT_NE(vdb_field(folder.file("a.vdb"), "", glm::vec3(1), glm::vec3(0))->describe().find("\"density\""),
            std::string::npos);
}

TEST(VdbField, refuses_points_and_other_types) {
  const Folder folder;
  openvdb::initialize();
  auto transform = openvdb::math::Transform::createLinearTransform(1.0);
  const std::vector<openvdb::Vec3R> positions{{0, 0, 0}, {1, 2, 3}};
  auto points = openvdb::points::createPointDataGrid<openvdb::points::NullCodec, openvdb::points::PointDataGrid>(
      positions, *transform);
  points->setName("points");
  write(folder.file("p.vdb"), {points});
  EXPECT_NE(error_of(folder.file("p.vdb"), "points").find("grid \"points\" is points: expected a density"),
            std::string::npos)
      << error_of(folder.file("p.vdb"), "points");
  auto mask = openvdb::BoolGrid::create();
  mask->setName("mask");
  write(folder.file("m.vdb"), {mask});
  EXPECT_NE(error_of(folder.file("m.vdb"), "mask").find("of type bool"), std::string::npos);
}

TEST(VdbField, refuses_what_is_no_vdb_file) {
  const Folder folder;
  EXPECT_NE(error_of(folder.write("t.vdb", "version https://git-lfs.github.com/spec/v1\n"))
                .find("can't be read as an OpenVDB file"),
            std::string::npos);
  EXPECT_NE(error_of(folder.write("e.vdb", "")).find("can't be read as an OpenVDB file"), std::string::npos);
  EXPECT_NE(error_of(folder.file("none.vdb")).find("no such file"), std::string::npos);
}

TEST(VdbField, refuses_a_truncated_file) {
  const Folder folder;
  const std::string path = folder.file("a.vdb");
  write(path, {ramp<openvdb::FloatGrid>("density")});
  const auto size = std::filesystem::file_size(path);
  for (const auto kept : {size - 1, size * 9 / 10, size / 2, size / 10, std::uintmax_t(20)}) {
    std::filesystem::resize_file(path, kept);
    EXPECT_NE(error_of(path), "no error") << kept << " of " << size << " bytes";
  }
}

}  // namespace
}  // namespace turbid
