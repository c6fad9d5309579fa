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

using F = cl::Buffer<float>;
using I = cl::Buffer<std::int32_t>;

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

/// The kernels on all levels, as SteadySolve strings them together.
class Device {
 public:
  Device(const DiffusionMedium& medium) : channels_(medium.channels), stride_(medium.stride()) {
    program_ = session_.build("steady.cl", {});
    smooth_ = {program_, "smooth"};
    restrict_ = {program_, "restrict_residual"};
    prolong_ = {program_, "prolong"};
    apply_ = {program_, "apply"};
    for (const MultigridLevel& from : build_multigrid(medium)) {
      Level level;
      level.blocks = from.blocks.count();
      level.t = session_.upload(from.conductance);
      level.loss = session_.upload(from.loss);
      level.neighbours = session_.upload(from.neighbours);
      level.parent = session_.upload(from.parent);
      level.octant = session_.upload(from.octant);
      level.b = session_.zeros<float>(from.stride() * channels_);
      level.x = session_.zeros<float>(from.stride() * channels_);
      level.y = session_.zeros<float>(from.stride() * channels_);
      levels_.push_back(std::move(level));
    }
    sums_ = session_.zeros<float>(levels_[0].blocks * channels_);
  }
  std::size_t levels() const { return levels_.size(); }

  std::vector<double> apply(const std::vector<double>& u) {
    Level& level = levels_[0];
    put(level.x, u);
    apply_.enqueue(queue_, global(level), {1, 1}, level.t, level.loss, level.neighbours, level.x, level.y, sums_,
                   level.blocks, channels_);
    return take(level.y);
  }
  /// x after `sweeps` of the smoother.
  std::vector<double> smooth(const std::vector<double>& b, const std::vector<double>& x, int sweeps, int reverse,
                             int from_zero) {
    Level& level = levels_[0];
    put(level.b, b);
    put(level.x, x);
    smooth_.enqueue(queue_, global(level), {1, 1}, level.t, level.loss, level.neighbours, level.b, level.x, level.y,
                    level.blocks, channels_, sweeps, reverse, from_zero);
    return take(level.y);
  }
  std::vector<double> v_cycle(const std::vector<double>& r) {
    put(levels_[0].b, r);
    v_cycle(0);
    return take(levels_[0].y);
  }

 private:
  struct Level {
    int blocks = 0;
    F t, loss, b, x, y;
    I neighbours, parent, octant;
  };
  cl::Range global(const Level& level) const {
    return {static_cast<std::size_t>(level.blocks), static_cast<std::size_t>(channels_)};
  }
  void put(F& buffer, const std::vector<double>& values) {
    std::vector<float> padded((stride_ + 512) * channels_, 0.0f);
    for (int c = 0; c < channels_; ++c) {
      for (std::size_t i = 0; i < stride_; ++i)
        padded[c * (stride_ + 512) + i] = static_cast<float>(values[c * stride_ + i]);
    }
    session_.write(queue_, buffer, std::span<const float>(padded));
  }
  std::vector<double> take(const F& buffer) {
    const std::vector<float> padded = session_.read(queue_, buffer);
    std::vector<double> values(stride_ * channels_);
    for (int c = 0; c < channels_; ++c) {
      for (std::size_t i = 0; i < stride_; ++i) values[c * stride_ + i] = padded[c * (stride_ + 512) + i];
    }
    return values;
  }
  void v_cycle(std::size_t index) {
    Level& level = levels_[index];
    if (index + 1 == levels_.size()) {
      smooth_.enqueue(queue_, global(level), {1, 1}, level.t, level.loss, level.neighbours, level.b, level.x, level.y,
                      level.blocks, channels_, 2, 0, 1);
      return;
    }
    Level& coarse = levels_[index + 1];
    smooth_.enqueue(queue_, global(level), {1, 1}, level.t, level.loss, level.neighbours, level.b, level.y, level.x,
                    level.blocks, channels_, 2, 0, 1);
    restrict_.enqueue(queue_, global(level), {1, 1}, level.t, level.loss, level.neighbours, level.b, level.x,
                      level.parent, level.octant, coarse.b, level.blocks, coarse.blocks, channels_);
    v_cycle(index + 1);
    prolong_.enqueue(queue_, global(level), {1, 1}, coarse.y, level.parent, level.octant, level.x, level.blocks,
                     coarse.blocks, channels_);
    smooth_.enqueue(queue_, global(level), {1, 1}, level.t, level.loss, level.neighbours, level.b, level.x, level.y,
                    level.blocks, channels_, 2, 1, 0);
  }

  cl::Session& session_ = test::session();
  cl::Queue& queue_ = session_.lattice_queue();
  int channels_;
  std::size_t stride_;
  std::vector<Level> levels_;
  cl::Program program_;
  cl::Kernel<F, F, I, F, F, F, int, int, int, int, int> smooth_;
  cl::Kernel<F, F, I, F, F, I, I, F, int, int, int> restrict_;
  cl::Kernel<F, I, I, F, int, int, int> prolong_;
  cl::Kernel<F, F, I, F, F, F, int, int> apply_;
  F sums_;
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

TEST(Smoother, ReducesTheEnergyOfAnyError) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 7);
  const test::DenseDiffusion dense(medium, 0);
  Device device(medium);
  const auto exact = random_field(medium, 8), start = random_field(medium, 9);
  const auto b = dense.apply(exact);
  auto energy = [&](const std::vector<double>& x) {
    std::vector<double> e(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) e[i] = x[i] - exact[i];
    return dot(e, dense.apply(e));
  };
  for (int reverse : {0, 1}) {
    auto x = start;
    double before = energy(x);
    for (int sweep = 0; sweep < 4; ++sweep) {
      x = device.smooth(b, x, 2, reverse, 0);
      const double now = energy(x);
      EXPECT_LT(now, before);
      before = now;
    }
    EXPECT_LT(before, 0.1 * energy(start));
  }
}

TEST(Smoother, FromZeroIsFromAZeroField) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, 10, 10);
  Device device(medium);
  const auto b = random_field(medium, 11);
  const auto garbage = random_field(medium, 12);
  EXPECT_EQ(device.smooth(b, garbage, 2, 0, 1), device.smooth(b, std::vector<double>(b.size(), 0.0), 2, 0, 0));
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

}  // namespace
}  // namespace turbid
