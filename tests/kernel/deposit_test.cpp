// SPDX-License-Identifier: Apache-2.0
// Power in fixed point: nothing is lost, and no order of arrival shows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/support/paths.h"
#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

using F = cl::Buffer<float>;
using L = cl::Buffer<std::int64_t>;

std::vector<std::int64_t> splat(const std::vector<glm::vec4>& points, float fixed_per_watt, std::size_t group) {
  cl::Session& session = test::session();
  const cl::Program program = session.build(test::test_kernel("probe_medium.cl"), {{"TURBID_CHANNELS", 1},
                                                                                     {"TURBID_BODIES", 0},
                                                                                     {"TURBID_GRADED", 0},
                                                                                     {"TURBID_HETEROGENEOUS", 0},
                                                                                     {"TURBID_HALF_TILES", 0},
                                                                                     {"TURBID_SCATTERING", 1},
                                                                                     {"TURBID_VOXELS_X", 16},
                                                                                     {"TURBID_VOXELS_Y", 16},
                                                                                     {"TURBID_VOXELS_Z", 16}});
  cl::Kernel<F, L, float, int> kernel(program, "probe_splat");
  std::vector<float> in;
  for (const glm::vec4& p : points) in.insert(in.end(), {p.x, p.y, p.z, p.w});
  const F input = session.upload(in);
  const L sums = session.zeros<std::int64_t>(8 * TURBID_TILE_NODES);
  kernel.enqueue(session.march_queue(), {points.size()}, {group}, input, sums, fixed_per_watt,
                 static_cast<int>(points.size()));
  return session.read(session.march_queue(), sums);
}

std::vector<glm::vec4> random_deposits(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<glm::vec4> points;
  for (int i = 0; i < count; ++i)
    points.emplace_back(16 * unit(random), 16 * unit(random), 16 * unit(random), std::exp(-8 * unit(random)));
  return points;
}

TEST(Deposit, SplattingConservesPower) {
  const auto points = random_deposits(5000, 1);
  double power = 0;
  for (const glm::vec4& p : points) power += p.w;
  const double units = std::exp2(40);
  const auto sums = splat(points, static_cast<float>(units), 1);
  const double found = std::accumulate(sums.begin(), sums.end(), 0.0) / units;
  EXPECT_NEAR(found / power, 1, 1e-7);  // eight weights, each rounded to 6e-8, errors of either sign over 5000 points
}

TEST(Deposit, APointsPowerHasItsPlaceAsCentroid) {
  const glm::vec3 x(9.3f, 4.75f, 11.125f);
  const double units = std::exp2(40);
  const auto sums = splat({glm::vec4(x, 1)}, static_cast<float>(units), 1);
  glm::dvec3 centroid(0);
  for (int tile = 0; tile < 8; ++tile) {
    for (int i = 0; i < TURBID_TILE_NODES; ++i) {
      const glm::dvec3 node(8 * (tile % 2) + i % 9 + 0.5, 8 * (tile / 2 % 2) + i / 9 % 9 + 0.5,
                            8 * (tile / 4) + i / 81 + 0.5);
      centroid += node * (static_cast<double>(sums[tile * TURBID_TILE_NODES + i]) / units);
    }
  }
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(centroid[axis], x[axis], 5e-6);  // rounding of weights times 16 voxels
}

TEST(Deposit, NoOrderOfArrivalShowsInTheSums) {
  auto points = random_deposits(20000, 2);
  const float units = std::exp2(50.0f);
  const auto once = splat(points, units, 1);
  EXPECT_EQ(once, splat(points, units, 64));
  std::shuffle(points.begin(), points.end(), std::mt19937(3));
  EXPECT_EQ(once, splat(points, units, 16));
}

/// A small medium with everything that splits rays.
MediumDescription march_scene() {
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(12, test::at(glm::vec3(16))),
                 test::make_material({.sigma_s = {0.1f, 0.2f, 0.05f}, .sigma_a = {0.01f, 0.02f, 0.03f}, .eta = 1.4f}));
  test::add_body(scene, make_box(glm::vec3(6), test::at({14, 16, 17})),
                 test::make_material({.sigma_a = glm::vec3(0.05f), .eta = 1.6f}));
  return scene;
}
const LightList kSun{test::sunlight({1, -0.3f, 0.2f}, {1, 0.5f, 0.25f})};

TEST(March, EveryWattIsTalliedOnce) {
  const test::Marched m = test::march(march_scene(), kSun);
  glm::dvec3 sum =
      m.tallies.absorbed + m.tallies.deposited + m.tallies.reflected + m.tallies.opaque + m.tallies.in_flight;
  for (const glm::dvec3& face : m.tallies.escaped) sum += face;
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(m.tallies.deposited[c], 0.1 * m.carried[c]);
    EXPECT_NEAR(sum[c] / m.carried[c], 1, 1e-6);  // float rounding along some hundred steps, of either sign
  }
}

TEST(March, TheDepositHoldsWhatTheTallySays) {
  const test::Marched m = test::march(march_scene(), kSun);
  glm::dvec3 sum(0);
  for (std::size_t i = 0; i < m.deposit.size(); ++i)
    sum[static_cast<int>(i % 3)] += static_cast<double>(m.deposit[i]) / m.units;
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / m.tallies.deposited[c], 1, 1e-6);  // as above
}

TEST(March, LittleIsLeftInFlight) {
  // Branches below min_power (1e-4) and paths of more than 16 interfaces end: a few per mille with total reflection
  // inside.
  const test::Marched m = test::march(march_scene(), kSun);
  RecordProperty("share", std::to_string(m.tallies.in_flight[0] / m.carried[0]));
  EXPECT_LT(m.tallies.in_flight[0] / m.carried[0], 5e-3);
}

TEST(March, NeitherTheOrderOfRaysNorTheBatchShowsInTheDeposit) {
  const test::Marched once = test::march(march_scene(), kSun), again = test::march(march_scene(), kSun, {}, true);
  EXPECT_EQ(once.deposit, again.deposit);
  EXPECT_EQ(once.tallies.absorbed, again.tallies.absorbed);
  EXPECT_EQ(once.tallies.escaped, again.tallies.escaped);
  MarchSettings short_batches;
  short_batches.batch_steps = 7;
  EXPECT_EQ(once.deposit,
            test::march(march_scene(), kSun, short_batches).deposit);  // the state kept between batches is complete
}

TEST(March, TheNumberOfWorkersDoesNotShowInTheDeposit) {
  const std::vector<std::int64_t> deposit = test::march(march_scene(), kSun).deposit;
  for (int workers : {1, 3, 7}) {
    MarchSettings settings;
    settings.workers = workers;
    EXPECT_EQ(deposit, test::march(march_scene(), kSun, settings).deposit) << workers << " workers";
  }
}

}  // namespace
}  // namespace turbid
