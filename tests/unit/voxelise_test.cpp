// SPDX-License-Identifier: Apache-2.0
// Bodies and materials as voxels, against shapes whose distance, volume and blurred index are known.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "host/base/errors.h"
#include "volumes/medium_volume.h"

namespace turbid {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A field that varies, given by a function.
class Formula final : public Field {
 public:
  explicit Formula(std::function<glm::vec3(glm::vec3)> f) : f_(std::move(f)) {}
  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = f_(positions[i]);
  }
  std::string describe() const override { return "formula"; }

 private:
  std::function<glm::vec3(glm::vec3)> f_;
};
FieldPtr formula(std::function<glm::vec3(glm::vec3)> f) {
  return std::make_shared<Formula>(std::move(f));
}

Material material(const std::string& name, float eta, float sigma_s) {
  Material m;
  m.name = name;
  m.eta = constant_field(glm::vec3(eta));
  m.sigma_s = constant_field(glm::vec3(sigma_s));
  m.sigma_a = m.g = m.emission = constant_field(glm::vec3(0));
  return m;
}

/// A domain of n^3 voxels over the cube [-1, 1]^3 with one material.
MediumDescription scene(int n) {
  MediumDescription d;
  d.frame.voxels = glm::ivec3(n);
  d.frame.origin = glm::vec3(-1);
  d.frame.voxel_size = 2.0f / static_cast<float>(n);
  d.materials = {material("milk", 1.3f, 2.0f)};
  return d;
}

Body sphere(glm::vec3 centre, float radius, int material = 0) {
  Body body;
  body.name = "sphere";
  body.solid = make_sphere(radius, {glm::mat3(1), 1, centre});
  body.material = material;
  return body;
}

Body as_mesh(Body body) {
  body.solid.signed_distance = nullptr;
  return body;
}

std::vector<float> distances(const MediumVolume& medium, int r) {
  const glm::ivec3 n = medium.frame().voxels;
  std::vector<float> d(static_cast<std::size_t>(n.x) * n.y * n.z);
  medium.read_signed_distance(r, glm::ivec3(0), n, d);
  return d;
}

std::vector<int> owners(const MediumVolume& medium) {
  const glm::ivec3 n = medium.frame().voxels;
  std::vector<int> o(static_cast<std::size_t>(n.x) * n.y * n.z);
  medium.read_owner(glm::ivec3(0), n, o);
  return o;
}

int owner_at(const MediumVolume& medium, glm::ivec3 voxel) {
  int owner = -2;
  medium.read_owner(voxel, glm::ivec3(1), {&owner, 1});
  return owner;
}

glm::ivec3 voxel_of(const GridFrame& frame, std::size_t i) {
  const int v = static_cast<int>(i), nx = frame.voxels.x, ny = frame.voxels.y;
  return {v % nx, v / nx % ny, v / (nx * ny)};
}

std::string refusal(const MediumDescription& d) {
  try {
    voxelise(d);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

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

TEST(Voxelise, BlurredIndexOfAFlatFaceIsTheErrorFunction) {
  MediumDescription d = scene(32);
  d.smoothing_voxels = 1.5f;
  for (const float face : {0.0f, 0.4f}) {  // on a face between voxels, and within one [voxels]
    Body slab;
    slab.solid = make_box(glm::vec3(8), {glm::mat3(1), 1, {-4 + face * d.frame.voxel_size, 0, 0}});
    slab.surface = SurfaceKind::smooth;
    d.bodies = {slab};
    const MediumVolume medium = voxelise(d);
    EXPECT_TRUE(medium.region(0).smooth_surface && medium.region(1).smooth_surface && medium.region(1).graded_index);
    for (int r = 0; r < 2; ++r) {
      std::array<float, 32> eta;
      medium.read_eta(r, {0, 16, 16}, {32, 1, 1}, eta);
      for (int i = 0; i < 32; ++i) {
        const double distance = i - 15.5 - face;
        // Voxels widen the Gaussian's variance by 1/12, or 1/6 where the face cuts a voxel: at most 1 % of the step.
        EXPECT_NEAR(eta[i], 1 + 0.3 * 0.5 * std::erfc(distance / (1.5 * std::sqrt(2.0))), 0.01 * 0.3) << i;
        EXPECT_GE(eta[i], 1.0f);
        EXPECT_LE(eta[i], 1.3f);
        if (i > 0) {
          EXPECT_LE(eta[i], eta[i - 1]);
        }
      }
      EXPECT_EQ(eta[0], 1.3f);
      EXPECT_EQ(eta[31], 1.0f);
    }
  }
}

TEST(Voxelise, BlurredIndexWrapsOnPeriodicAxes) {
  MediumDescription d = scene(16);
  d.faces = {FaceBoundary::periodic, FaceBoundary::periodic};
  Body slab;
  slab.solid = make_box(glm::vec3(8), {glm::mat3(1), 1, {-4, 0, 0}});  // x < 0: a second face at the domain's ends
  slab.surface = SurfaceKind::smooth;
  d.bodies = {slab};
  std::array<float, 16> eta;
  voxelise(d).read_eta(0, {0, 8, 8}, {16, 1, 1}, eta);
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(eta[i], eta[7 - i], 1e-6f) << "both faces blur alike";
    EXPECT_NEAR(eta[i] - 1.15f, 1.15f - eta[15 - i], 1e-6f);
  }
  EXPECT_LT(eta[0], 1.29f);
}

TEST(Voxelise, SharpBodiesKeepTheirOwnIndex) {
  MediumDescription d = scene(32);
  d.materials.push_back(material("glass", 1.5f, 0.0f));
  d.bodies = {sphere({-0.5f, 0, 0}, 0.4f), sphere({0.5f, 0, 0}, 0.4f, 1)};
  d.bodies[0].surface = SurfaceKind::smooth;
  const MediumVolume medium = voxelise(d);
  EXPECT_FALSE(medium.region(2).graded_index);
  EXPECT_EQ(medium.region(2).eta, 1.5f);
  std::array<float, 32> own, group;
  medium.read_eta(2, {0, 16, 16}, {32, 1, 1}, own);
  medium.read_eta(1, {0, 16, 16}, {32, 1, 1}, group);
  for (const float eta : own) EXPECT_EQ(eta, 1.5f);
  EXPECT_EQ(group[24], 1.0f) << "the smooth group does not see the sharp body";
  EXPECT_NEAR(group[8], 1.3f, 1e-6f) << "rounding of the weights";
}

TEST(Voxelise, VaryingCoefficientsAreEvaluatedAtVoxelCentresAndTwoVoxelsBeyond) {
  MediumDescription d = scene(32);
  d.materials[0].sigma_s = formula([](glm::vec3 p) { return glm::vec3(3) + p; });
  d.materials[0].eta = formula([](glm::vec3 p) { return glm::vec3(1.4f + 0.1f * p.x); });
  d.materials.push_back(material("glass", 1.5f, 0.0f));
  d.bodies = {sphere(glm::vec3(0), 0.6f), sphere(glm::vec3(0), 0.3f, 1)};
  const MediumVolume medium = voxelise(d);
  EXPECT_TRUE(medium.region(1).heterogeneous && medium.region(1).graded_index && medium.region(1).scatters);
  EXPECT_FALSE(medium.region(1).emits || medium.region(1).absorbs || medium.region(2).scatters);
  EXPECT_NEAR(medium.region(1).eta, 1.4f, 1e-3f) << "mean of an odd function about the centre";
  std::vector<Coefficients> found(24 * 24 * 24);
  std::vector<float> eta(found.size());
  medium.read_coefficients(1, glm::ivec3(4), glm::ivec3(24), found);  // also inside the nested sphere
  medium.read_eta(1, glm::ivec3(4), glm::ivec3(24), eta);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const int v = static_cast<int>(i);
    const glm::vec3 p = d.frame.centre_of(glm::ivec3(4) + glm::ivec3(v % 24, v / 24 % 24, v / 576));
    ASSERT_EQ(found[i].sigma_s, glm::vec3(3) + p);
    ASSERT_EQ(eta[i], 1.4f + 0.1f * p.x);
  }
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
