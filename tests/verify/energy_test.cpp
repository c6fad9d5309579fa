// SPDX-License-Identifier: Apache-2.0
// Complete runs: the two solvers agree, runs repeat to the bit, white media give all light back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>

#include "host/study/energy_media.h"
#include "host/study/error_measures.h"
#include "tests/support/test_media.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

using study::energy_media, study::EnergyMedium;

TEST(EnergyBalance, AWhiteMediumGivesBackAllThatItReceives) {
  // Albedo 1: nothing is absorbed, escape plus reflection is all (case: furnace by power).
  MediumDescription scene = test::empty_domain(glm::ivec3(32), 1.0f);
  test::add_body(scene, make_sphere(11, test::at(glm::vec3(16))),
                 test::make_material({.sigma_s = glm::vec3(1), .eta = 1.4f}));
  const EnergyBalance e = test::run(scene, {test::sunlight({1, 0, 0})}).energy();
  EXPECT_EQ(e.absorbed.x, 0);
  const double entered = e.emitted.x - e.missed.x;
  EXPECT_NEAR((e.escaped.x + e.reflected.x + e.in_flight.x) / entered, 1, 1e-5);
}

TEST(EnergyBalance, EmissionIsTheVolumeTimesItsDensityPerColour) {
  // Also where one channel carries all three colours by their ratio: (0, 1, .5) has none in the first.
  for (const glm::vec3 emission :
       {glm::vec3(1, 1, 1), glm::vec3(0, 1, 0.5f), glm::vec3(0.5f, 1, 0.25f), glm::vec3(2, 0, 0)}) {
    MediumDescription scene = test::empty_domain(glm::ivec3(16), 0.5f);
    test::set_ambient(
        scene, test::make_material({.sigma_s = glm::vec3(0.2f), .sigma_a = glm::vec3(0.1f), .emission = emission}));
    const EnergyBalance e = test::run(scene, {}).energy();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(e.emitted[c], 512 * emission[c], 512e-5) << c;
    EXPECT_LT(e.imbalance(), 1e-5);
  }
}

TEST(Emission, OfABallIsThatOfItsVolume) {
  // Sampled distances are 1 / (6 R) voxels too large on average on a ball of R voxels: its volume falls short by 1 / (2 R^2).
  // Whole voxels, counted where their centres lie inside, are up to 5 % off in these places.
  for (const float radius : {3.0f, 4.6f, 7.3f}) {
    for (const char* solver : {"steady", "photon"}) {
      MediumDescription scene = test::empty_domain(glm::ivec3(24), 0.5f);
      test::add_body(scene, make_sphere(0.5f * radius, test::at({6.1f, 5.9f, 6.2f})),
                     test::make_material({.sigma_s = glm::vec3(0.2f), .sigma_a = glm::vec3(0.1f), .emission = glm::vec3(1)}));
      SolverSettings settings;
      settings.solver = solver;
      settings.photon.photons = 1000;
      const double ball = 4.0 / 3 * std::numbers::pi * std::pow(0.5 * radius, 3);
      const double expected = ball * (1 - 0.5 / (radius * radius));
      EXPECT_NEAR(test::run(scene, {}, settings).energy().emitted.x / expected, 1, 0.004) << solver << " " << radius;
    }
  }
}

TEST(Solvers, SteadyAndLatticeAgreeToTheirTolerance) {
  for (const EnergyMedium& c : energy_media()) {
    if (c.name == std::string("no absorption") || c.name == std::string("clear glass"))
      continue;  // slow on a lattice; nothing to solve
    SolverSettings settings;
    const test::Run steady = test::run(c.scene, c.lights, settings);
    settings.solver = "lattice";
    const test::Run lattice = test::run(c.scene, c.lights, settings);
    EXPECT_LT(lattice.solution.report.error_estimate, 1e-4) << c.name;
    EXPECT_LT(relative_l2(lattice.solution.volume.fluence, steady.solution.volume.fluence), 3e-4)
        << c.name;  // 1e-4 each, in two norms
    for (int colour = 0; colour < 3; ++colour)
      EXPECT_NEAR(lattice.energy().escaped[colour] / steady.energy().escaped[colour], 1, 3e-4) << c.name;
  }
}

TEST(Solvers, AWarmStartAnswersLikeAColdOneAndKeepsTheBalance) {
  const EnergyMedium c = energy_media()[1];
  const MediumVolume medium = voxelise(c.scene);
  Progress progress(Verbosity::quiet);
  LightList moved = c.lights;
  moved[0].direction = glm::normalize(glm::vec3(1, -0.4f, 0.35f));
  for (const char* name : {"steady", "lattice"}) {
    SolverSettings settings;
    settings.solver = name;
    const auto solver = make_solver({.session = test::session(),
                                     .progress = progress,
                                     .settings = settings,
                                     .features = scene_features(medium, c.lights),
                                     .description = c.scene,
                                     .surroundings = {}});
    solver->prepare(medium);
    const LightSolution cold = solver->light(moved);
    const LightSolution first = solver->light(c.lights);
    solver->set_warm_start(true);
    const LightSolution same = solver->light(c.lights), warm = solver->light(moved);
    EXPECT_LE(same.report.iterations, name == std::string("steady") ? 1 : first.report.iterations / 4) << name;
    EXPECT_LT(warm.report.iterations, cold.report.iterations) << name;
    EXPECT_LT(relative_l2(warm.volume.fluence, cold.volume.fluence), 3e-4) << name;  // 1e-4 each, in two norms
    EXPECT_LT(warm.report.energy.imbalance(), 1e-5) << name;
    EXPECT_LT(same.report.energy.imbalance(), 1e-5) << name;
    solver->set_warm_start(false);
    EXPECT_EQ(solver->light(moved).volume.fluence, cold.volume.fluence) << name;
  }
}

TEST(Runs, RepeatToTheBit) {
  const std::vector<EnergyMedium> cases = energy_media();
  for (const char* solver : {"steady", "lattice"}) {
    for (const char* name : {"glass", "nested"}) {
      const auto c =
          std::find_if(cases.begin(), cases.end(), [&](const EnergyMedium& x) { return x.name == std::string(name); });
      SolverSettings settings;
      settings.solver = solver;
      settings.march.batch_steps = 16;
      const test::Run first = test::run(c->scene, c->lights, settings),
                      second = test::run(c->scene, c->lights, settings);
      EXPECT_EQ(first.solution.volume.fluence, second.solution.volume.fluence) << name << ", " << solver;
      EXPECT_EQ(first.solution.volume.deposit, second.solution.volume.deposit) << name << ", " << solver;
      EXPECT_EQ(first.energy().escaped, second.energy().escaped);
    }
  }
}

/// FNV-1a of everything that a run answers with.
std::uint64_t fingerprint() {
  std::uint64_t hash = 14695981039346656037ull;
  auto add = [&](const void* data, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
      hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 1099511628211ull;
  };
  for (const EnergyMedium& c : energy_media()) {
    if (c.name != std::string("nested") && c.name != std::string("heterogeneous")) continue;
    for (const char* solver : {"steady", "lattice", "global lattice", "half lattice", "half global lattice"}) {
      SolverSettings settings;
      settings.solver = solver == std::string("steady") ? "steady" : "lattice";
      const std::string name = solver;
      if (name.ends_with("global lattice")) settings.lattice.block_edge = 0;
      if (name.starts_with("half")) settings.lattice.storage = Storage::half_precision;
      settings.lattice.tolerance = 1e-3f;
      const test::Run run = test::run(c.scene, c.lights, settings);
      add(run.solution.volume.fluence.data(), 4 * run.solution.volume.fluence.size());
      add(run.solution.volume.deposit.data(), 4 * run.solution.volume.deposit.size());
      add(&run.energy().escaped, sizeof(run.energy().escaped));
    }
  }
  return hash;
}

TEST(Runs, DISABLED_PrintTheirFingerprint) {
  std::printf("fingerprint %llx\n", static_cast<unsigned long long>(fingerprint()));
}

TEST(Runs, GiveTheSameBitsWithOneThreadAndWithTwo) {
  // In processes of their own: PoCL reads its number of threads once.
  std::string answer[2];
  for (int threads = 1; threads <= 2; ++threads) {
    const std::string n = std::to_string(threads),
                      command = "POCL_MAX_PTHREAD_COUNT=" + n + " POCL_CPU_MAX_CU_COUNT=" + n + " '" +
                                std::filesystem::read_symlink("/proc/self/exe").string() +
                                "' --gtest_also_run_disabled_tests --gtest_filter=Runs.DISABLED_PrintTheirFingerprint";
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    char line[256];
    while (std::fgets(line, sizeof line, pipe))
      if (std::string(line).rfind("fingerprint", 0) == 0) answer[threads - 1] = line;
    EXPECT_EQ(pclose(pipe), 0);
  }
  EXPECT_EQ(answer[0], answer[1]);
  EXPECT_GT(answer[0].size(), 12u);
}

TEST(Runs, TheDepositDoesNotDependOnHowManyStepsABatchHas) {
  const std::vector<EnergyMedium> cases = energy_media();
  SolverSettings settings;
  const test::Run first = test::run(cases[1].scene, cases[1].lights, settings);
  settings.march.batch_steps = 11;
  EXPECT_EQ(first.solution.volume.deposit,
            test::run(cases[1].scene, cases[1].lights, settings).solution.volume.deposit);
}

TEST(Runs, LightIsLinear) {
  EnergyMedium c = energy_media()[1];
  const test::Run once = test::run(c.scene, c.lights);
  c.lights[0].irradiance *= 4.0f;  // a power of two: every rounding scales along
  const test::Run four = test::run(c.scene, c.lights);
  for (int colour = 0; colour < 3; ++colour)
    EXPECT_NEAR(four.energy().escaped[colour] / once.energy().escaped[colour], 4, 4e-6);
}

}  // namespace
}  // namespace turbid
