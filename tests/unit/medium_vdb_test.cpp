// SPDX-License-Identifier: Apache-2.0
// OpenVDB files: what was written is read back, nothing is left half written, and damaged files are refused.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "host/base/errors.h"
#include "volumes/fluence_volume.h"
#include "volumes/medium_volume.h"
#include "volumes/procedural.h"

namespace turbid {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed at the end.
class MediumVdb : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("turbid_vdb_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + "_" +
               std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" + std::to_string(std::rand()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  fs::path folder_;
};

MediumVolume jelly() {
  MediumDescription d;
  d.frame.voxels = {24, 16, 32};
  d.frame.origin = {1, -2, 3};
  d.frame.voxel_size = 0.125f;
  Material m;
  m.name = "jelly";
  m.eta = constant_field(glm::vec3(1.35f));
  m.sigma_s = linear_index({0, 0, 0}, 20.0f, {1, 2, 3});  // any field that varies
  m.sigma_a = constant_field({0.1f, 0.2f, 0.3f});
  m.g = constant_field(glm::vec3(0.5f));
  m.emission = constant_field(glm::vec3(0));
  d.materials = {m};
  Body body;
  body.name = "ball";
  body.solid = make_sphere(0.8f, {glm::mat3(1), 1, {2.5f, -1, 5}});
  d.bodies = {body};
  return voxelise(d);
}

glm::vec3 value_at(const std::string& file, const std::string& grid, glm::vec3 position) {
  glm::vec3 value(-1);
  vdb_field(file, grid, glm::vec3(1), glm::vec3(0))->evaluate({&position, 1}, {&value, 1});
  return value;
}

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST_F(MediumVdb, HoldsTheNamedGridsWithClassUnitsAndTransform) {
  jelly().write_vdb(path("a.vdb"), "mm");
  const std::string text = describe_vdb(path("a.vdb"));
  const auto line = [&](const std::string& grid) {
    const std::size_t begin = text.find("\n" + grid + ": ") + 1;
    return begin == 0 && text.rfind(grid + ": ", 0) != 0 ? "" : text.substr(begin, text.find('\n', begin) - begin);
  };
  for (const char* grid : {"eta", "g", "occupancy"})
    EXPECT_NE(line(grid).find("float, fog volume"), std::string::npos) << text;
  for (const char* grid : {"sigma_s", "sigma_a"}) {
    EXPECT_NE(line(grid).find("vec3s, fog volume"), std::string::npos) << text;
    EXPECT_NE(line(grid).find("turbid:unit_of_values = 1/mm"), std::string::npos) << text;
  }
  EXPECT_NE(line("signed_distance").find("float, level set"), std::string::npos) << text;
  EXPECT_NE(line("region").find("int32"), std::string::npos) << text;
  EXPECT_NE(line("region").find("voxel size 0.125"), std::string::npos) << text;
  EXPECT_NE(line("region").find("unit = mm"), std::string::npos) << text;
  EXPECT_NE(line("region").find("creator = Turbid "), std::string::npos) << text;
  EXPECT_EQ(line("emission"), "") << "nothing emits";
}

TEST_F(MediumVdb, ValuesLieAtTheWorldPositionsOfVoxelCentres) {
  const MediumVolume medium = jelly();
  medium.write_vdb(path("a.vdb"), "mm");
  for (const glm::ivec3 voxel : {glm::ivec3(12, 8, 16), glm::ivec3(9, 5, 14), glm::ivec3(15, 9, 18)}) {
    Coefficients expected;
    medium.read_coefficients(1, voxel, glm::ivec3(1), {&expected, 1});
    const glm::vec3 position = medium.frame().centre_of(voxel);
    const glm::vec3 found = value_at(path("a.vdb"), "sigma_s", position);
    // Interpolation at a voxel centre has weights of 1 - 1e-6 or so on its voxel.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected.sigma_s[c], 1e-4f);
    EXPECT_NEAR(expected.sigma_s.x, 20 + position.x + 2 * position.y + 3 * position.z, 1e-4f);
    EXPECT_NEAR(value_at(path("a.vdb"), "occupancy", position).x, 1.0f, 1e-5f);
    EXPECT_NEAR(value_at(path("a.vdb"), "g", position).x, 0.5f, 1e-5f);
  }
  EXPECT_EQ(value_at(path("a.vdb"), "occupancy", medium.frame().centre_of({1, 1, 1})).x, 0.0f);
}

TEST_F(MediumVdb, OccupancySumsToTheVolumeOfTheBody) {
  const MediumVolume medium = jelly();
  medium.write_vdb(path("a.vdb"), "mm");
  const FieldPtr occupancy = vdb_field(path("a.vdb"), "occupancy", glm::vec3(1), glm::vec3(0));
  std::vector<glm::vec3> centres;
  const glm::ivec3 n = medium.frame().voxels;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) centres.push_back(medium.frame().centre_of({x, y, z}));
  std::vector<glm::vec3> shares(centres.size());
  occupancy->evaluate(centres, shares);
  double volume = 0;
  for (const glm::vec3 share : shares) volume += share.x * std::pow(0.125, 3);
  const double exact = 4.0 / 3.0 * M_PI * std::pow(0.8, 3);
  // Interpolation lifts the convex distance by up to h^2 / 8 * 2 / R, which shrinks the ball by 3 h^2 / (4 R^2) = 1.8
  // %.
  EXPECT_NEAR(volume, exact, 0.02 * exact);
}

TEST_F(MediumVdb, FluenceIsWrittenBesideTheMedium) {
  const MediumVolume medium = jelly();
  const BlockGrid blocks(medium.frame().blocks(), kBlockEdge, [](glm::ivec3 b) { return b == glm::ivec3(1, 1, 2); });
  FluenceVolume result{medium.frame(), blocks, std::vector<float>(3 * 512, 0.0f), std::vector<float>(3 * 512, 0.0f)};
  const glm::ivec3 voxel(12, 8, 16);  // voxel (4, 0, 0) of the block
  Coefficients own;
  medium.read_coefficients(1, voxel, glm::ivec3(1), {&own, 1});
  for (int c = 0; c < 3; ++c) {
    result.fluence[c * 512 + 4] = 1.0f + static_cast<float>(c);
    result.deposit[c * 512 + 4] = 8.0f;
  }
  write_fluence_vdb(result, medium, path("f.vdb"), "mm");
  const glm::vec3 fluence = value_at(path("f.vdb"), "fluence", medium.frame().centre_of(voxel));
  // The first flight counts the forward peak g^2 as not scattered.
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(fluence[c], 1.0f + static_cast<float>(c) + 8.0f / (own.sigma_s[c] * (1 - own.g * own.g)), 1e-4f);
  EXPECT_NEAR(value_at(path("f.vdb"), "deposit", medium.frame().centre_of(voxel)).y, 8.0f, 1e-4f);
  EXPECT_NE(describe_vdb(path("f.vdb")).find("W/mm^2"), std::string::npos);
  EXPECT_NE(describe_vdb(path("f.vdb")).find("sigma_a: "), std::string::npos);
}

TEST_F(MediumVdb, FailureToWriteLeavesNoFileAndSaysWhy) {
  const MediumVolume medium = jelly();
  const std::string nowhere = path("missing/a.vdb");
  EXPECT_EQ(refusal([&] { medium.write_vdb(nowhere, "mm"); }),
            nowhere + ": can't be written: No such file or directory");

  // A disk that is full: /dev/full accepts opening and refuses every byte.
  std::ofstream(path("a.vdb")) << "an older file";
  fs::create_symlink("/dev/full", path("a.vdb.part"));
  const std::string message = refusal([&] { medium.write_vdb(path("a.vdb"), "mm"); });
  EXPECT_EQ(message, path("a.vdb") + ": can't be written: No space left on device");
  EXPECT_FALSE(fs::exists(fs::symlink_status(path("a.vdb.part"))));
  EXPECT_EQ(fs::file_size(path("a.vdb")), 13u) << "the older file is untouched";

  fs::create_directory(path("b.vdb"));
  EXPECT_NE(refusal([&] { medium.write_vdb(path("b.vdb"), "mm"); }).find("it is a folder"), std::string::npos);
}

TEST_F(MediumVdb, WritesOverAnOlderFileAndLeavesNoPart) {
  std::ofstream(path("a.vdb")) << "an older file";
  jelly().write_vdb(path("a.vdb"), "mm");
  EXPECT_FALSE(fs::exists(path("a.vdb.part")));
  EXPECT_NE(describe_vdb(path("a.vdb")).find("eta: "), std::string::npos);
}

TEST_F(MediumVdb, FilesThatAreNoVdbAreRefused) {
  EXPECT_NE(refusal([&] { describe_vdb(path("none.vdb")); }).find("No such file"), std::string::npos);
  EXPECT_NE(refusal([&] { describe_vdb(folder_.string()); }).find("is a folder"), std::string::npos);
  std::ofstream(path("text.vdb")) << "version https://git-lfs.github.com/spec/v1\n";
  EXPECT_NE(refusal([&] { describe_vdb(path("text.vdb")); }).find("is not an OpenVDB file"), std::string::npos);
  std::ofstream(path("empty.vdb"));
  EXPECT_NE(refusal([&] { describe_vdb(path("empty.vdb")); }).find("is not an OpenVDB file"), std::string::npos);
}

TEST_F(MediumVdb, FilesCutShortAreRefused) {
  jelly().write_vdb(path("a.vdb"), "mm");
  const auto size = fs::file_size(path("a.vdb"));
  for (const double share : {0.0005, 0.005, 0.05, 0.3, 0.6, 0.9, 0.999}) {
    fs::copy_file(path("a.vdb"), path("cut.vdb"), fs::copy_options::overwrite_existing);
    fs::resize_file(path("cut.vdb"),
                    std::max<std::uintmax_t>(8, static_cast<std::uintmax_t>(share * static_cast<double>(size))));
    EXPECT_NE(refusal([&] { describe_vdb(path("cut.vdb")); }).find("cut.vdb: "), std::string::npos) << share;
  }
}

}  // namespace
}  // namespace turbid
