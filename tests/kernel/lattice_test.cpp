// SPDX-License-Identifier: Apache-2.0
// The blockwise lattice against one global lattice in double precision; what a step does with energy; the printed
// matrix.
#include "host/transport/lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/transport/lattice_medium.h"
#include "host/transport/lattice_scheme.h"
#include "tests/support/test_diffusion.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

constexpr CollisionVariant kVariants[] = {CollisionVariant::paper, CollisionVariant::exponential,
                                          CollisionVariant::trapezoid, CollisionVariant::trt};

LatticeSettings settings(CollisionVariant variant, int edge, int inner = 1) {
  LatticeSettings s;
  s.collision = variant;
  s.block_edge = edge;
  s.inner_iterations = inner;
  return s;
}

/// A sphere in a box with a jump of the index, open in x, mirrored in y, periodic in z.
MediumDescription mixed_scene() {
  MediumDescription scene = test::empty_domain({24, 16, 16}, 1.0f);
  scene.faces = {FaceBoundary::open,   FaceBoundary::open,     FaceBoundary::mirror,
                 FaceBoundary::mirror, FaceBoundary::periodic, FaceBoundary::periodic};
  test::add_body(scene, make_box({20, 30, 30}, test::at({12, 8, 8})),
                 test::make_material({.sigma_s = glm::vec3(1), .eta = 1.2f}));
  test::add_body(scene, make_sphere(5, test::at({12, 8, 8})),
                 test::make_material({.sigma_s = glm::vec3(1), .eta = 1.5f}));
  return scene;
}

std::vector<float> random_source(const DiffusionMedium& medium, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<float> q(medium.stride() * medium.channels, 0.0f);
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (medium.region[i % medium.stride()] >= 0) q[i] = unit(random);
  }
  return q;
}

TEST(Lattice, StepsOfBlocksAreStepsOfTheWholeLattice) {
  const int channels = 2;
  for (CollisionVariant variant : kVariants) {
    const double s_high = variant == CollisionVariant::paper ? 1.0 : 10.0;  // the paper's collision diverges beyond 2
    const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, s_high, 1, channels);
    ASSERT_FALSE(medium.jumps.empty());
    ASSERT_FALSE(medium.boundary.empty());
    const std::vector<float> q = random_source(medium, 2);
    for (int edge : {4, 8, 0}) {  // 0: the global lattice in place
      const auto scheme = make_lattice(test::session(), medium, settings(variant, edge));
      LatticeScheme& lattice = *scheme;
      lattice.set_source(q);
      std::vector<test::DenseDiffusion::Populations> state(
          channels, test::DenseDiffusion::Populations(medium.stride(), {0, 0, 0, 0, 0, 0}));
      for (int step = 1; step <= 12; ++step) {
        lattice.enqueue_sweeps(1);
        if (step != 2 && step != 5 && step != 12) {
          for (int c = 0; c < channels; ++c) {
            const std::vector<double> source(q.begin() + c * medium.stride(), q.begin() + (c + 1) * medium.stride());
            test::DenseDiffusion(medium, c).step(state[c], variant, source);
          }
          continue;
        }
        const std::vector<float> fluence = lattice.read_fluence();
        for (int c = 0; c < channels; ++c) {
          const std::vector<double> source(q.begin() + c * medium.stride(), q.begin() + (c + 1) * medium.stride());
          const auto expected = test::DenseDiffusion(medium, c).step(state[c], variant, source);
          double largest = 0, worst = 0;
          for (std::size_t i = 0; i < medium.stride(); ++i) {
            largest = std::max(largest, std::abs(expected.fluence[i]));
            worst = std::max(worst, std::abs(expected.fluence[i] - fluence[c * medium.stride() + i]));
          }
          // Single precision: s from p1 = s / (1 + s/2) loses a factor 1 + s/2 = 6 of 1e-7; 12 steps.
          EXPECT_LT(worst / largest, 1e-5)
              << "collision " << static_cast<int>(variant) << ", edge " << edge << ", step " << step;
        }
      }
    }
  }
}

TEST(Lattice, AStepKeepsTheEnergyIdentityWhereverItStands) {
  // sum q = absorbed + escaped + added to what is stored, in every step and not in the steady state alone.
  for (CollisionVariant variant : kVariants) {
    const double s_high = variant == CollisionVariant::paper ? 1.0 : 10.0;
    const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.1, s_high, 3);
    const std::vector<float> q = random_source(medium, 4);
    double total = 0;
    for (float value : q) total += value;
    for (int edge : {4, 8, 0}) {  // 0: the global lattice in place
      const auto scheme = make_lattice(test::session(), medium, settings(variant, edge));
      LatticeScheme& lattice = *scheme;
      lattice.set_source(q);
      for (int sweeps : {1, 3, 20}) {
        lattice.enqueue_sweeps(sweeps);
        const LatticeEnergy energy = lattice.read_energy();
        double escaped = 0;
        for (const glm::dvec3& face : energy.escaped) escaped += face.x;
        // Block sums in single precision, relative to what is in motion: up to 30 times the source after 24 steps.
        EXPECT_NEAR((energy.absorbed.x + escaped + energy.stored.x) / total, 1, 1e-5)
            << static_cast<int>(variant) << " " << edge;
        EXPECT_GT(escaped, 0);
        EXPECT_EQ(energy.escaped[2], glm::dvec3(0));  // mirror
        EXPECT_EQ(energy.escaped[4], glm::dvec3(0));  // periodic
      }
    }
  }
}

TEST(Lattice, ThePrintedMatrixAbsorbsNothing) {
  // Bernabei Eq. 5: Theta_0j = sigma_a, Theta_i0 = 1/6, Theta_ij = sigma_s/6 + (i = j)(1 - sigma_t): every column sums
  // to 1, so what row 0 absorbs comes back. Ours is its direction-to-direction part, whose columns sum to 1 - sigma_a,
  // with a sink.
  const double s = 0.7, s_a = 0.2, s_s = s - s_a;
  const Collision k = collision_coefficients(CollisionVariant::paper, s, s_a);
  for (int j = 0; j < 6; ++j) {
    double f[6] = {0, 0, 0, 0, 0, 0}, out[6];
    f[j] = 1;
    const double after = 1 - k.p0;
    for (int a = 0; a < 3; ++a) {
      const double even = after / 3 + (1 - k.p2) * (f[2 * a] + f[2 * a + 1] - 1.0 / 3),
                   odd = (1 - k.p1) * (f[2 * a] - f[2 * a + 1]);
      out[2 * a] = 0.5 * (even + odd);
      out[2 * a + 1] = 0.5 * (even - odd);
    }
    double column = 0, printed_column = s_a;
    for (int i = 0; i < 6; ++i) {
      const double printed = s_s / 6 + (i == j ? 1 - s : 0);
      EXPECT_NEAR(out[i], printed, 1e-14);
      column += out[i];
      printed_column += printed;
    }
    EXPECT_NEAR(printed_column, 1, 1e-14);
    EXPECT_NEAR(column, 1 - s_a, 1e-14);
  }
}

TEST(Lattice, RelaxationRatesGiveTheTablesDiffusion) {
  // D = (1/p1 - 1/2) / 3 against 1 / (3 s): numerics section 1.
  for (double s : {0.01, 0.1, 1.0, 1.9, 10.0, 50.0}) {
    const auto ratio = [&](CollisionVariant v) { return (1 / collision_coefficients(v, s, 0.1 * s).p1 - 0.5) * s; };
    EXPECT_NEAR(ratio(CollisionVariant::paper), 1 - s / 2, 1e-12);
    EXPECT_NEAR(ratio(CollisionVariant::exponential), s / 2 / std::tanh(s / 2), 1e-12 * s);
    EXPECT_NEAR(ratio(CollisionVariant::trapezoid), 1, 1e-12);
    EXPECT_NEAR(ratio(CollisionVariant::trt), 1, 1e-12);
    const Collision k = collision_coefficients(CollisionVariant::trt, s, 0.1 * s);
    EXPECT_NEAR((1 / k.p1 - 0.5) * (1 / k.p2 - 0.5), 0.25, 1e-12);  // Ginzburg's magic combination
  }
}

TEST(Lattice, BlocksAndInnerStepsDoNotChangeTheSteadyState) {
  const DiffusionMedium medium = test::random_medium(mixed_scene(), 0.3, 3, 5);
  const std::vector<float> q = random_source(medium, 6);
  std::vector<float> first;
  for (int edge : {4, 8, 0}) {
    for (int inner : {1, 2, 8}) {
      if (edge == 0 && inner > 1) continue;
      LatticeSettings s = settings(CollisionVariant::trt, edge, inner);
      s.tolerance = 1e-5f;
      const auto scheme = make_lattice(test::session(), medium, s);
      LatticeScheme& lattice = *scheme;
      lattice.set_source(q);
      EXPECT_LT(lattice.relax(), 1e-5);
      const std::vector<float> fluence = lattice.read_fluence();
      if (first.empty()) first = fluence;
      double difference = 0, total = 0;
      for (std::size_t i = 0; i < fluence.size(); ++i) {
        difference += std::abs(fluence[i] - first[i]);
        total += std::abs(first[i]);
      }
      EXPECT_LT(difference / total, 4e-5)
          << "b = " << edge << ", m = " << inner;  // two runs of estimated error 1e-5, safety 2
    }
  }
}

/// Relative L2 difference.
double apart(const std::vector<float>& a, const std::vector<float>& b) {
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::pow(static_cast<double>(a[i]) - b[i], 2);
    norm += std::pow(static_cast<double>(b[i]), 2);
  }
  return std::sqrt(difference / norm);
}

TEST(Lattice, HalfPrecisionStorageStaysWithinItsErrorAndBalancesItsRounding) {
  for (const double albedo : {0.99, 0.9999}) {
    for (const bool even : {true, false}) {
      DiffusionMedium medium = test::random_medium(mixed_scene(), 0.3, even ? 0.3 : 3, 5);
      for (std::size_t i = 0; i < medium.s.size(); ++i) medium.s_a[i] = static_cast<float>((1 - albedo) * medium.s[i]);
      std::vector<float> q = random_source(medium, 6);
      for (float& value : q) value *= 1e-7f;  // watts of any size: half precision ends at 6e-8
      double total = 0;
      for (float value : q) total += value;
      for (int edge : {4, 8, 0}) {
        LatticeSettings s = settings(CollisionVariant::trt, edge, 8);
        const auto full = make_lattice(test::session(), medium, s);
        s.storage = Storage::half_precision;
        const auto half = make_lattice(test::session(), medium, s);
        EXPECT_LT(half->device_bytes(), 0.9 * full->device_bytes());
        for (LatticeScheme* lattice : {full.get(), half.get()}) {
          lattice->set_source(q);
          lattice->relax();
        }
        EXPECT_LT(apart(half->read_fluence(), full->read_fluence()), kHalfError) << albedo << " " << edge;
        EXPECT_LE(half->sweeps(), 2 * full->sweeps()) << albedo << " " << edge;
        const LatticeEnergy energy = half->read_energy();
        double sum = energy.absorbed.x + energy.stored.x + energy.rounding.x;
        for (const glm::dvec3& face : energy.escaped) sum += face.x;
        EXPECT_NEAR(sum / total, 1, 1e-5) << albedo << " " << edge;
      }
    }
  }
}

}  // namespace
}  // namespace turbid
