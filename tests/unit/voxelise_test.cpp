// SPDX-License-Identifier: Apache-2.0
// Bodies and materials as voxels, against shapes whose distance and volume are known.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numeric>

#include "tests/unit/voxel_scenes.h"

namespace turbid {
namespace {

TEST(Voxelise, OwnedVolumeOfASphereConvergesToItsVolume) {
  const float radius = 0.7f;
  const double exact = 4.0 / 3.0 * M_PI * std::pow(radius, 3);
  const auto mean_error = [&](int n) {
    double sum = 0;
    for (int shift = 0; shift < 8;
         ++shift) {  // the count of lattice points in one ball jumps about; its mean is smooth
      MediumDescription d = scene(n);
      d.bodies = {sphere(0.01f * glm::vec3(shift, 1.7f * shift, 2.9f * shift), radius)};
      const std::vector<int> owner = owners(voxelise(d));
      const double h = d.frame.voxel_size;
      sum += std::abs(static_cast<double>(std::count(owner.begin(), owner.end(), 1)) * h * h * h - exact);
    }
    return sum / 8;
  };
  const double order = std::log(mean_error(16) / mean_error(64)) / std::log(4.0);
  // The surface passes through O(1/h^2) voxels of volume h^3: an error of O(h) at worst, less as they average out.
  EXPECT_GE(order, 1.0);
}

TEST(Voxelise, DistanceOfAFormulaIsExactAtVoxelCentres) {
  MediumDescription d = scene(32);
  d.bodies = {sphere({0.1f, -0.05f, 0.02f}, 0.6f)};
  const MediumVolume medium = voxelise(d);
  const std::vector<float> found = distances(medium, 1);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float exact =
        (glm::distance(d.frame.centre_of(voxel_of(d.frame, i)), {0.1f, -0.05f, 0.02f}) - 0.6f) / d.frame.voxel_size;
    // Lengths of about 1 in float have errors of 1e-7; one voxel is 1/16.
    ASSERT_NEAR(found[i], std::clamp(exact, -4.0f, 4.0f), 1e-5f);
  }
}

TEST(Voxelise, DistanceOfATessellatedSphereIsWithinItsTessellationError) {
  MediumDescription d = scene(48);
  const float radius = 0.8f;
  d.bodies = {as_mesh(sphere(glm::vec3(0), radius))};
  const TriangleMesh& mesh = d.bodies[0].solid.mesh;
  float tessellation = 0;  // a facet with its corners on the sphere comes as near to the centre as its plane does
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const double plane = std::abs(dot(normalize(cross(b - a, c - a)), a));
    tessellation = std::max(tessellation, static_cast<float>(radius - plane));
  }
  const std::vector<float> found = distances(voxelise(d), 1);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const float exact =
        std::clamp((glm::length(d.frame.centre_of(voxel_of(d.frame, i))) - radius) / d.frame.voxel_size, -4.0f, 4.0f);
    ASSERT_NEAR(found[i], exact, tessellation / d.frame.voxel_size + 1e-4f);
  }
}

TEST(Voxelise, MeshAndFormulaOfABoxAgree) {
  const Placement tilted{glm::mat3(0.6f, 0.8f, 0, -0.8f, 0.6f, 0, 0, 0, 1), 1, {0.1f, 0, 0}};
  MediumDescription d = scene(32);
  Body box;
  box.solid = make_box({0.9f, 0.7f, 1.1f}, tilted);
  d.bodies = {box, as_mesh(box)};
  const MediumVolume medium = voxelise(d);
  const std::vector<float> formula = distances(medium, 1), mesh = distances(medium, 2);
  for (std::size_t i = 0; i < formula.size(); ++i) ASSERT_NEAR(formula[i], mesh[i], 1e-4f);  // rounding of the corners
}

TEST(Voxelise, CavityOfAMeshIsOutside) {
  MediumDescription d = scene(32);
  Body shell = as_mesh(sphere(glm::vec3(0), 0.8f));
  const TriangleMesh hole = make_sphere(0.5f, {}).mesh;
  const auto offset = static_cast<unsigned>(shell.solid.mesh.positions.size());
  auto& mesh = shell.solid.mesh;
  mesh.positions.insert(mesh.positions.end(), hole.positions.begin(), hole.positions.end());
  for (const glm::uvec3& t : hole.triangles) mesh.triangles.emplace_back(t.x + offset, t.z + offset, t.y + offset);
  d.bodies = {shell};
  const MediumVolume medium = voxelise(d);
  EXPECT_EQ(owner_at(medium, {16, 16, 16}), 0);
  EXPECT_EQ(owner_at(medium, {26, 16, 16}), 1) << "x = 0.66";
  EXPECT_EQ(owner_at(medium, {31, 16, 16}), 0);
}

TEST(Voxelise, FacesThroughVoxelCentresLeaveNoHoles) {
  MediumDescription d = scene(32);  // centres at odd multiples of 1/32: every face and edge passes through some exactly
  Body box;
  box.solid = make_box(glm::vec3(1.0625f), {});
  d.bodies = {as_mesh(box)};
  const MediumVolume medium = voxelise(d);
  const std::vector<int> owner = owners(medium);
  for (std::size_t i = 0; i < owner.size(); ++i) {
    const glm::vec3 p = glm::abs(d.frame.centre_of(voxel_of(d.frame, i)));
    ASSERT_EQ(owner[i], std::max(p.x, std::max(p.y, p.z)) < 0.53125f);
  }
}

TEST(Voxelise, LaterBodyWinsWhereBodiesOverlap) {
  MediumDescription d = scene(32);
  d.bodies = {sphere(glm::vec3(0), 0.8f), sphere(glm::vec3(0), 0.3f)};
  EXPECT_EQ(owner_at(voxelise(d), {16, 16, 16}), 2);
  EXPECT_EQ(owner_at(voxelise(d), {24, 16, 16}), 1);
  std::swap(d.bodies[0], d.bodies[1]);
  EXPECT_EQ(owner_at(voxelise(d), {16, 16, 16}), 2) << "the small one is hidden now";
  EXPECT_EQ(owner_at(voxelise(d), {0, 0, 0}), 0);
}

TEST(Voxelise, BodiesReachBeyondTheDomain) {
  for (const bool mesh : {false, true}) {
    MediumDescription d = scene(16);
    Body large;
    large.solid = make_box(glm::vec3(1000.0f), {glm::mat3(1), 1, {500.0f, 0, 0}});  // the domain's half x > 0, and more
    d.bodies = {mesh ? as_mesh(large) : large};
    const MediumVolume medium = voxelise(d);
    std::array<int, 20> line;
    medium.read_owner({-2, 3, 5}, {20, 1, 1}, line);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(line[i], i < 2 || i >= 18 ? -1 : i < 10 ? 0 : 1) << i;
    std::array<float, 20> distance;
    medium.read_signed_distance(1, {-2, 3, 5}, {20, 1, 1}, distance);
    for (int i = 0; i < 20; ++i) {
      const float x = static_cast<float>(std::clamp(i - 2, 0, 15));
      EXPECT_NEAR(distance[i], std::clamp(7.5f - x, -4.0f, 4.0f), 1e-3f) << "coordinates of 1000 in float";
    }
  }
}

TEST(Voxelise, DomainInsideABodyIsAllInside) {
  MediumDescription d = scene(16);
  d.bodies = {as_mesh(sphere(glm::vec3(0), 50.0f))};
  const MediumVolume medium = voxelise(d);
  for (const int owner : owners(medium)) ASSERT_EQ(owner, 1);
  for (const float distance : distances(medium, 1)) ASSERT_EQ(distance, -4.0f);
}

TEST(Voxelise, ResultDoesNotDependOnTheNumberOfThreads) {
  MediumDescription d = scene(48);
  d.materials[0].sigma_s = formula([](glm::vec3 p) { return glm::vec3(1) + glm::abs(glm::sin(9.0f * p)); });
  d.materials[0].eta = formula([](glm::vec3 p) { return glm::vec3(1.3f + 0.1f * std::sin(7 * p.y)); });
  d.bodies = {as_mesh(sphere({0.1f, 0, 0}, 0.7f))};
  d.bodies[0].surface = SurfaceKind::smooth;
  const auto values = [&](const MediumVolume& medium) {
    std::vector<float> all = distances(medium, 1);
    std::vector<float> eta(all.size());
    medium.read_eta(1, glm::ivec3(0), d.frame.voxels, eta);
    all.insert(all.end(), eta.begin(), eta.end());
    all.insert(all.end(), {medium.region(1).eta, medium.region(1).sigma_s.x});
    return all;
  };
  const std::vector<float> several = values(voxelise(d));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(values(voxelise(d)), several);
}

TEST(Voxelise, RefusesUnphysicalConstants) {
  const auto with = [](FieldPtr Material::*coefficient, float value) {
    MediumDescription d = scene(8);
    d.materials[0].*coefficient = constant_field(glm::vec3(value));
    d.bodies = {sphere(glm::vec3(0), 0.5f)};
    return refusal(d);
  };
  EXPECT_EQ(with(&Material::sigma_s, -3),
            "material \"milk\": sigma_s = -3: must be a finite number >= 0 [1/scene unit]");
  EXPECT_NE(with(&Material::sigma_a, kNan).find("sigma_a = nan"), std::string::npos);
  EXPECT_NE(with(&Material::eta, 0.9f).find("eta = 0.9: must be a finite number >= 1"), std::string::npos);
  EXPECT_NE(with(&Material::g, 1.0f).find("(-1, 1)"), std::string::npos);
  EXPECT_NE(with(&Material::emission, std::numeric_limits<float>::infinity()).find("emission"), std::string::npos);
  EXPECT_EQ(with(&Material::eta, 1.0f), "accepted");
}

TEST(Voxelise, RefusesUnphysicalValuesOfAFormulaInsideTheBodyOnly) {
  MediumDescription d = scene(32);
  d.bodies = {sphere(glm::vec3(0), 0.5f)};
  d.materials[0].sigma_s = formula([](glm::vec3 p) { return glm::vec3(1, p.x > 0.4f ? -1.0f : 1.0f, 1); });
  const std::string message = refusal(d);
  EXPECT_NE(message.find("material \"milk\": sigma_s = (1, -1, 1) at (0.40625, "), std::string::npos) << message;
  d.materials[0].sigma_s = formula([](glm::vec3 p) { return glm::vec3(1 - dot(p, p) / 0.25f); });  // 0 at the surface
  d.materials[0].eta = formula([](glm::vec3 p) { return glm::vec3(std::sqrt(2 - dot(p, p) / 0.25f)); });  // Luneburg
  EXPECT_EQ(refusal(d), "accepted");
}

TEST(Voxelise, StopsWhenProgressThrows) {
  MediumDescription d = scene(16);
  d.bodies = {sphere(glm::vec3(0), 0.5f)};
  double last = -1;
  voxelise(d, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW(voxelise(d,
                        [](double fraction) {
                          if (fraction > 0.3) throw Interrupted("stopped");
                        }),
               Interrupted);
}

}  // namespace
}  // namespace turbid
