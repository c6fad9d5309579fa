// SPDX-License-Identifier: Apache-2.0
// The steady operator and its preconditioner: right values, symmetric, positive.
#include "host/transport/steady.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/transport/multigrid.h"
#include "tests/support/test_diffusion.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

MediumDescription mixed_scene(glm::ivec3 voxels = {24, 16, 16}) {
  MediumDescription scene = test::empty_domain(voxels, 1.0f);
  scene.faces = {FaceBoundary::open,   FaceBoundary::open,     FaceBoundary::mirror,
                 FaceBoundary::mirror, FaceBoundary::periodic, FaceBoundary::periodic};
  const glm::vec3 centre = 0.5f * glm::vec3(voxels);
  test::add_body(scene, make_box(glm::vec3(voxels) - glm::vec3(4, -9, -9), test::at(centre)),
                 test::make_material({.sigma_s = glm::vec3(1), .eta = 1.2f}));
  test::add_body(scene, make_sphere(5, test::at(centre)), test::make_material({.sigma_s = glm::vec3(1), .eta = 1.5f}));
  return scene;
}

/// The solver's own parts, in double precision on the outside.
class Device : public SteadySolve {
 public:
  explicit Device(const DiffusionMedium& medium) : SteadySolve(test::session(), medium, {}) {}
  std::size_t levels() const { return levels_.size() - 1 + tail_levels_; }

  std::vector<double> apply(const std::vector<double>& u) {
    return each_channel(u, [&] { SteadySolve::apply(levels_[0].b, levels_[0].y); });
  }
  std::vector<double> v_cycle(const std::vector<double>& r) {
    return each_channel(r, [&] { SteadySolve::v_cycle(0); });
  }
  /// b . y of the last V-cycle as the kernel summed it.
  double product() const { return product_; }

 private:
  /// What `work` makes of b is y.
  template <class Work>
  std::vector<double> each_channel(const std::vector<double>& values, const Work& work) {
    std::vector<double> result;
    for (int c = 0; c < channels_; ++c) {
      const std::vector<float> part(values.begin() + c * stride_, values.begin() + (c + 1) * stride_);
      std::vector<float> found(stride_);
      channel_ = c;
      write_field(levels_[0].b, part);
      work();
      product_ = block_sum();
      channel_ = 0;  // y holds one channel
      read_field(levels_[0].y, 0, found);
      session_.lattice_queue().finish();
      result.insert(result.end(), found.begin(), found.end());
    }
    return result;
  }

  double product_ = 0;
};

std::vector<double> random_field(const DiffusionMedium& medium, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<double> x(medium.stride() * medium.channels, 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (medium.region[i % medium.stride()] >= 0) x[i] = normal(random);
  }
  return x;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

TEST(SteadyOperator, IsTheFiniteVolumeDiffusion) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 1, 2);
  Device device(medium);
  const std::vector<double> x = random_field(medium, 2), found = device.apply(x);
  for (int c = 0; c < 2; ++c) {
    const std::vector<double> part(x.begin() + c * medium.stride(), x.begin() + (c + 1) * medium.stride());
    const std::vector<double> expected = test::DenseDiffusion(medium, c).apply(part);
    double largest = 0, worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      largest = std::max(largest, std::abs(expected[i]));
      worst = std::max(worst, std::abs(expected[i] - found[c * medium.stride() + i]));
    }
    EXPECT_LT(worst / largest, 1e-6);  // a dozen single-precision roundings of the largest term
  }
}

TEST(SteadyOperator, IsSymmetric) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 3);
  Device device(medium);
  const auto x = random_field(medium, 4), y = random_field(medium, 5);
  const auto ax = device.apply(x), ay = device.apply(y);
  // Both are sums of a thousand terms of random sign; rounding 1e-7 of sqrt(x.Ax y.Ay).
  EXPECT_NEAR(dot(x, ay), dot(y, ax), 1e-6 * std::sqrt(dot(x, ax) * dot(y, ay)));
  EXPECT_GT(std::abs(dot(x, ay)), 1e-4 * std::sqrt(dot(x, ax) * dot(y, ay)));  // not trivially
}

TEST(SteadyOperator, AConstantLosesWhatIsAbsorbedAndEscapes) {
  // Differences of equal values vanish exactly: A 1 is the loss alone, with no rounding of the large conductances in
  // it.
  DiffusionMedium medium = test::random_medium(mixed_scene(), 1e-3, 2e-3, 6);
  for (float& s_a : medium.s_a) s_a *= 1e-6f;
  for (BoundaryFace& face : medium.boundary) face.c[0] = 1e6f;
  Device device(medium);
  std::vector<double> one(medium.stride(), 0.0);
  double expected = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    if (medium.region[i] < 0) continue;
    one[i] = 1;
    expected += static_cast<double>(medium.s_a[i]) * medium.eta_squared[i];
  }
  for (const BoundaryFace& face : medium.boundary)
    expected += medium.boundary_conductance(face, 0) * medium.eta_squared[face.block * std::size_t{512} + face.voxel];
  double found = 0;
  for (double value : device.apply(one)) found += value;
  EXPECT_NEAR(found / expected, 1, 1e-5);  // the losses' own rounding; conductances are 1e9 times larger
}

TEST(VCycle, ReducesTheEnergyOfAnyError) {
  // As an iteration of its own: x += V (b - A x). Contrast 100 in every voxel; conjugate gradients around it do better.
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 7);
  const test::DenseDiffusion dense(medium, 0);
  Device device(medium);
  auto error = random_field(medium, 8);
  auto energy = [&] { return dot(error, dense.apply(error)); };
  const double first = energy();
  double before = first;
  for (int cycle = 0; cycle < 4; ++cycle) {
    const auto correction = device.v_cycle(dense.apply(error));
    for (std::size_t i = 0; i < error.size(); ++i) error[i] -= correction[i];
    EXPECT_LT(energy(), 0.5 * before) << cycle;
    before = energy();
  }
  EXPECT_LT(before, 1e-3 * first);
}

TEST(VCycle, SumsResidualTimesCorrection) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 10);
  Device device(medium);
  const auto r = random_field(medium, 11), z = device.v_cycle(r);
  EXPECT_NEAR(device.product() / dot(r, z), 1, 1e-6);
}

TEST(VCycle, IsSymmetricAndPositive) {
  for (unsigned seed : {13u, 14u, 15u}) {
    const DiffusionMedium medium = test::random_medium(mixed_scene({32, 24, 16}), 0.1, 10, seed);
    Device device(medium);
    ASSERT_GE(device.levels(), 4u);
    const auto r1 = random_field(medium, 100 + seed), r2 = random_field(medium, 200 + seed);
    const auto z1 = device.v_cycle(r1), z2 = device.v_cycle(r2);
    const double scale = std::sqrt(dot(z1, r1) * dot(z2, r2));
    ASSERT_GT(dot(z1, r1), 0);
    ASSERT_GT(dot(z2, r2), 0);
    EXPECT_NEAR(dot(z1, r2), dot(z2, r1), 2e-6 * scale);  // rounding of five levels
    EXPECT_GT(std::abs(dot(z1, r2)), 1e-4 * scale);
  }
}

TEST(SteadySolve, FindsTheSolutionOfTheDenseOperator) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 16, 2);
  auto exact = random_field(medium, 17);
  for (double& value : exact) value = std::abs(value);
  std::vector<float> q(exact.size());
  for (int c = 0; c < 2; ++c) {
    const std::vector<double> part(exact.begin() + c * medium.stride(), exact.begin() + (c + 1) * medium.stride());
    const auto b = test::DenseDiffusion(medium, c).apply(part);
    for (std::size_t i = 0; i < b.size(); ++i) q[c * medium.stride() + i] = static_cast<float>(b[i]);
  }
  SteadySettings settings;
  settings.tolerance = 1e-6f;
  const SteadyResult result = SteadySolve(test::session(), medium, settings).solve(q);
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    difference += std::pow(result.u[i] - exact[i], 2);
    norm += exact[i] * exact[i];
  }
  EXPECT_LT(std::sqrt(difference / norm), 2e-5);  // energy-norm tolerance 1e-6 times the root of the contrast 100
  EXPECT_LE(result.residual_sum, 1e-6);
}

TEST(SteadySolve, HoldsAtMost64BytesPerActiveVoxelAndColour) {
  MediumDescription box = test::empty_domain({64, 64, 64}, 1.0f), ball = test::empty_domain({96, 96, 96}, 1.0f);
  const auto milk = test::make_material({.sigma_s = glm::vec3(1)});
  test::add_body(box, make_box({80, 80, 80}, test::at({32, 32, 32})), milk);
  test::add_body(ball, make_sphere(44, test::at({48, 48, 48})), milk);
  for (const MediumDescription* scene : {&box, &ball}) {
    const DiffusionMedium medium = test::random_medium(*scene, 0.1, 1, 7, 3);
    const SteadySolve solve(test::session(), medium, {});
    // A full block takes 37 bytes with the coarser levels; a ball's surface blocks are half empty.
    EXPECT_LE(static_cast<double>(solve.device_bytes()) / (3.0 * static_cast<double>(medium.active_voxels)), 64);
  }
}

TEST(SteadySolve, TheSecondSolveForgetsTheFirst) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 18);
  std::vector<float> q1(medium.stride(), 0.0f), q2 = q1;
  for (std::size_t i = 0; i < q1.size(); ++i) {
    if (medium.region[i] >= 0) q1[i] = 1.0f + i % 3, q2[i] = 1.0f + i % 5;
  }
  SteadySolve solve(test::session(), medium, {});
  const auto first = solve.solve(q1).u;
  solve.solve(q2);
  EXPECT_EQ(first, solve.solve(q1).u);
}

TEST(SteadySolve, AWarmStartKnowsTheLastAnswer) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 19, 3);
  std::vector<float> q(3 * medium.stride(), 0.0f), dimmed = q, moved = q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (medium.region[i % medium.stride()] < 0) continue;
    const float x = static_cast<float>(test::voxel_of(medium, i % medium.stride()).x);
    q[i] = std::exp(-0.3f * x);
    moved[i] = q[i] * (1 + 0.05f * std::sin(x));
  }
  const float colour[3] = {0.5f, 2.0f, 0.25f};
  for (std::size_t i = 0; i < q.size(); ++i) dimmed[i] = colour[i / medium.stride()] * q[i];
  SteadySettings deep;
  deep.tolerance = 1e-6f;
  const auto exact = SteadySolve(test::session(), medium, deep).solve(moved).u;
  SteadySolve solve(test::session(), medium, {});
  const SteadyResult cold = solve.solve(q);
  // An answer that just met the tolerance: it takes two gains to see that no more is missing.
  EXPECT_LE(solve.solve(q, true).iterations, 2);       // nothing changed
  EXPECT_LE(solve.solve(dimmed, true).iterations, 2);  // each colour in its own proportion
  const SteadyResult warm = solve.solve(moved, true);
  EXPECT_LT(warm.iterations, cold.iterations);
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    difference += std::pow(warm.u[i] - exact[i], 2);
    norm += std::pow(exact[i], 2);
  }
  // The tolerance is 1e-4 in the energy norm, and the estimate is that of the iterate before the last.
  EXPECT_LT(std::sqrt(difference / norm), 1e-4);
  EXPECT_LT(warm.residual_sum, 1e-4);   // and was then scaled away: verify's cases look at the balance
  EXPECT_EQ(solve.solve(q).u, cold.u);  // a cold start forgets
}

}  // namespace
}  // namespace turbid
