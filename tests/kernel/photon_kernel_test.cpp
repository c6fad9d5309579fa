// SPDX-License-Identifier: Apache-2.0
// Building blocks of the Monte Carlo reference, and what its bits may depend on: the seed and the photons' numbers, not on
// threads, on how the work is cut, or on an interruption.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numbers>
#include <thread>

#include "host/base/errors.h"
#include "host/transport/photon_checkpoint.h"
#include "tests/support/paths.h"
#include "tests/support/run.h"
#include "tests/support/test_photons.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

using test::session;

cl::Program probes() { return session().build(test::test_kernel("probe_random.cl"), {}); }

TEST(Philox, GivesThePublishedKnownAnswers) {
  // Random123, tests/kat_vectors: philox4x32, 10 rounds; counter, key, answer.
  const std::vector<unsigned> in{0, 0, 0, 0, 0, 0,
                                 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff,
                                 0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344, 0xa4093822, 0x299f31d0};
  const std::vector<unsigned> expected{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8, 0x408f276d, 0x41c83b0e,
                                       0xa20bc7c6, 0x6d5451fd, 0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
  using U = cl::Buffer<unsigned>;
  cl::Kernel<U, U, int> kernel(probes(), "probe_philox");
  const U input = session().upload(in), output = session().zeros<unsigned>(12);
  kernel.enqueue(session().march_queue(), {3}, {1}, input, output, 3);
  EXPECT_EQ(session().read(session().march_queue(), output), expected);
}

TEST(Philox, NumbersStayInsideTheirRangesAtBothEndsOfTheBits) {
  const std::vector<unsigned> in{0, 1, 0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff};
  cl::Kernel<cl::Buffer<unsigned>, cl::Buffer<float>, int> kernel(probes(), "probe_distributions");
  const cl::Buffer<unsigned> input = session().upload(in);
  const cl::Buffer<float> output = session().zeros<float>(12);
  kernel.enqueue(session().march_queue(), {6}, {1}, input, output, 6);
  const std::vector<float> out = session().read(session().march_queue(), output);
  for (int i = 0; i < 6; ++i) {
    EXPECT_GT(out[2 * i], 0.0f);
    EXPECT_LT(out[2 * i], 1.0f);
    EXPECT_GE(out[2 * i + 1], 0.0f);
    EXPECT_NEAR(out[2 * i + 1], -std::log((in[i] + 0.5) / 4294967296.0), 1e-6 * (1 + out[2 * i + 1]));
  }
}

TEST(HenyeyGreenstein, HasTheIntegralOneAndTheMeanCosineG) {
  constexpr int kCount = 1 << 16;
  for (float g : {-0.9f, -0.3f, 0.0f, 0.5f, 0.9f}) {
    cl::Kernel<float, cl::Buffer<float>, int> kernel(probes(), "probe_phase");
    const cl::Buffer<float> output = session().zeros<float>(kCount);
    kernel.enqueue(session().march_queue(), {kCount}, {64}, g, output, kCount);
    const std::vector<float> phase = session().read(session().march_queue(), output);
    double integral = 0, mean = 0;
    for (int i = 0; i < kCount; ++i) {
      const double cosine = 1 - 2 * (i + 0.5) / kCount, weight = 2 * std::numbers::pi * phase[i] * 2 / kCount;
      integral += weight;
      mean += cosine * weight;
    }
    EXPECT_NEAR(integral, 1, 1e-5) << g;  // float values
    EXPECT_NEAR(mean, g, 1e-5) << g;
  }
}

TEST(HenyeyGreenstein, ScatteredDirectionsHaveItsMomentsAboutAnyAxis) {
  constexpr int kCount = 200000;
  unsigned seed = 1;
  for (float g : {-0.9f, -0.5f, 0.0f, 1e-5f, 0.01f, 0.7f, 0.9f, 0.99f}) {
    for (glm::vec3 axis : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::normalize(glm::vec3(-1, 2, -3))}) {
      cl::Kernel<float, float, float, float, unsigned, cl::Buffer<float>, int> kernel(probes(), "probe_scatter");
      const cl::Buffer<float> output = session().zeros<float>(3 * kCount);
      kernel.enqueue(session().march_queue(), {kCount}, {64}, g, axis.x, axis.y, axis.z, seed++, output, kCount);
      const std::vector<float> out = session().read(session().march_queue(), output);
      // Legendre moments of the phase function are g and g^2; sideways the mean is zero.
      const glm::dvec3 side = glm::normalize(glm::cross(glm::dvec3(axis), glm::dvec3(0.3, 1, 0.2)));
      double sum[3] = {}, square[3] = {};
      for (int i = 0; i < kCount; ++i) {
        const glm::dvec3 d(out[3 * i], out[3 * i + 1], out[3 * i + 2]);
        ASSERT_NEAR(glm::length(d), 1, 1e-6);
        const double c = glm::dot(d, glm::dvec3(axis)), value[3] = {c, 1.5 * c * c - 0.5, glm::dot(d, side)};
        for (int k = 0; k < 3; ++k) {
          sum[k] += value[k];
          square[k] += value[k] * value[k];
        }
      }
      const double expected[3] = {g, double{g} * g, 0};
      for (int k = 0; k < 3; ++k) {
        const double mean = sum[k] / kCount, error = std::sqrt((square[k] / kCount - mean * mean) / kCount);
        // 96 comparisons: one beyond 4 standard errors in 160 such tests; and what 24 bits of cosine leave.
        EXPECT_NEAR(mean, expected[k], 4 * error + 1e-6) << "g " << g << ", moment " << k;
      }
    }
  }
}

TEST(PhotonProgram, BuildsForEveryKindOfScene) {
  for (int choice = 0; choice < 32; ++choice) {
    EXPECT_NO_THROW(session().build("photon.cl", {{"TURBID_CHANNELS", 1}, {"TURBID_BODIES", choice & 1 ? 2 : 0},
                                                  {"TURBID_GRADED", choice >> 1 & 1}, {"TURBID_HETEROGENEOUS", choice >> 2 & 1}, {"TURBID_HALF_TILES", 0},
                                                  {"TURBID_SCATTERING", choice >> 3 & 1}, {"TURBID_ANISOTROPIC", choice >> 4 & 1},
                                                  {"TURBID_VOXELS_X", 16},
                                                  {"TURBID_VOXELS_Y", 24}, {"TURBID_VOXELS_Z", 8}}))
        << choice;
  }
}

/// A ball of glass in fog between mirrors, with an opaque one beside it: every kind of event.
MediumDescription busy_scene() {
  MediumDescription scene = test::empty_domain(glm::ivec3(24), 1.0f);
  scene.faces[0] = scene.faces[1] = FaceBoundary::mirror;
  scene.faces[2] = scene.faces[3] = FaceBoundary::periodic;
  test::set_ambient(scene, test::make_material({.sigma_s = {0.1f, 0.2f, 0.4f}, .sigma_a = {0.02f, 0.01f, 0.0f}, .g = 0.6f}));
  test::add_body(scene, make_sphere(6, test::at({9, 9, 12})), test::make_material({.sigma_s = glm::vec3(0.3f), .eta = 1.5f}));
  test::add_body(scene, make_sphere(3, test::at({18, 18, 12})), test::make_material({}));
  scene.materials.back().opaque = true;
  return scene;
}
const LightList kBusyLights{test::sunlight({0.2f, 0.1f, 1}, {1.0f, 0.7f, 0.4f}), test::point_light({4, 20, 4}, {300, 200, 100})};

TEST(Photons, AddTheSameBitsHoweverTheWorkIsCut) {
  const MediumDescription scene = busy_scene();
  const MediumVolume medium = voxelise(scene);
  const SceneFeatures features = scene_features(medium, kBusyLights);
  const DeviceMedium device = upload_medium(session(), medium, features);
  const PhotonMedium photon_medium = upload_photon_medium(session(), medium, device);
  const PhotonSources sources =
      photon_sources(kBusyLights, medium, entry_surfaces(scene, medium, false), device, photon_medium, {}, 0);
  Photons photons(session(), device, photon_medium, test::photons(1), medium.faces(), {});
  PhotonSums whole, pieces;
  photons.start(sources, std::exp2(32));
  photons.follow({.channel = 1, .first = 0, .first_in_batch = 0, .batch = 3000, .count = 3000});
  photons.read(whole);
  photons.start(sources, std::exp2(32));
  std::uint64_t done = 0;
  for (std::uint64_t count : {1, 63, 1000, 2, 1934}) {
    photons.follow({.channel = 1, .first = done, .first_in_batch = done, .batch = 3000, .count = count});
    done += count;
  }
  photons.read(pieces);
  EXPECT_EQ(whole.voxels, pieces.voxels);
  EXPECT_EQ(whole.tallies, pieces.tallies);
  // Every unit of weight is accounted for: the tallies, escaped light that never scattered aside, sum up to what started.
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < whole.tallies.size(); ++i) {
    if (i < TURBID_PHOTON_UNSCATTERED || i >= TURBID_PHOTON_ABSORBED) sum += whole.tallies[i];
  }
  EXPECT_EQ(sum, std::int64_t{3000} << 32);
}

std::uint64_t hash_of(const LightSolution& solution) {
  std::uint64_t hash = 0;
  for (const auto* values : {&solution.volume.fluence, &solution.volume.deposit, &solution.volume.standard_error})
    hash = fingerprint(hash, *values);
  const PhotonTallies& tallies = *solution.report.photon;
  for (const Estimate* e : {&tallies.escaped, &tallies.absorbed, &tallies.roulette, &tallies.reflected, &tallies.unscattered})
    hash = fingerprint(hash, e, sizeof *e);
  return hash;
}

std::string own_binary() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

/// What the children of the tests below run.
TEST(PhotonChild, DISABLED_PrintsTheHashOfItsBits) {
  std::printf("hash %016llx\n", static_cast<unsigned long long>(hash_of(test::follow(busy_scene(), test::photons(6000), kBusyLights).solution)));
}

TEST(Photons, AddTheSameBitsOnOneThreadAndOnMany) {
  const test::Workplace place;
  std::string hashes[2];
  for (int threads : {1, 2}) {
    const std::string count = std::to_string(threads);
    const test::Outcome outcome =
        place.run({own_binary(), "--gtest_also_run_disabled_tests", "--gtest_filter=PhotonChild.DISABLED_PrintsTheHashOfItsBits"},
                  {.environment = {{"POCL_MAX_PTHREAD_COUNT", count}, {"POCL_CPU_MAX_CU_COUNT", count}}});
    ASSERT_EQ(outcome.status, 0) << outcome.out << outcome.err;
    const std::size_t at = outcome.out.find("hash ");
    ASSERT_NE(at, std::string::npos) << outcome.out;
    hashes[threads - 1] = outcome.out.substr(at, 21);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

SolverSettings interruptible(const std::string& path) {
  SolverSettings settings = test::photons(90000, 5, 6);
  settings.photon.checkpoint = path;
  settings.photon.checkpoint_seconds = 0;
  return settings;
}

TEST(PhotonChild, DISABLED_RunsWithACheckpoint) {
  test::follow(busy_scene(), interruptible(std::getenv("TURBID_TEST_CHECKPOINT")), kBusyLights);
}

TEST(PhotonCheckpoint, ARunGoesOnAfterKillMinusNineAndEndsWithTheSameBits) {
  const test::Workplace place;
  const std::string path = place.path("run.checkpoint"), binary = own_binary();
  const pid_t child = fork();
  if (child == 0) {
    setenv("TURBID_TEST_CHECKPOINT", path.c_str(), 1);
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, 1);
    dup2(null, 2);
    execl(binary.c_str(), binary.c_str(), "--gtest_also_run_disabled_tests", "--gtest_filter=PhotonChild.DISABLED_RunsWithACheckpoint",
          static_cast<char*>(nullptr));
    _exit(127);
  }
  ASSERT_GT(child, 0);
  // Kill it once it has written its state: at any moment, perhaps while it writes the next one.
  int status = 0;
  pid_t ended = 0;
  while (!std::filesystem::exists(path) && (ended = waitpid(child, &status, WNOHANG)) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ASSERT_EQ(ended, 0) << "the run ended before its first checkpoint";
  std::this_thread::sleep_for(std::chrono::milliseconds(60));
  kill(child, SIGKILL);
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the run ended before it could be killed";
  ASSERT_TRUE(std::filesystem::exists(path));

  const auto resumed = test::follow(busy_scene(), interruptible(path), kBusyLights);
  EXPECT_FALSE(std::filesystem::exists(path)) << "a run that has ended removes its checkpoint";
  const auto whole = test::follow(busy_scene(), interruptible(""), kBusyLights);
  EXPECT_EQ(hash_of(resumed.solution), hash_of(whole.solution));
  EXPECT_EQ(resumed.tallies().photons, whole.tallies().photons);
}

TEST(PhotonCheckpoint, IsRefusedWhenDamagedForeignOrSomethingElse) {
  const test::Workplace place;
  const std::string path = place.path("checkpoint");
  PhotonState state;
  state.finished = 7;
  state.device.voxels = {1, 2, 3};
  write_checkpoint(path, 42, state);
  PhotonState same;
  same.device.voxels.resize(3);
  ASSERT_TRUE(read_checkpoint(path, 42, same));
  EXPECT_EQ(same.finished, 7u);
  EXPECT_EQ(same.device.voxels, state.device.voxels);
  auto refusal = [&](std::uint64_t fingerprint) {
    try {
      read_checkpoint(path, fingerprint, same);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal(43).find("another scene, seed or settings"), std::string::npos) << refusal(43);
  std::string bytes;
  {
    std::ifstream file(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(file), {});
  }
  std::string damaged = bytes;
  damaged[damaged.size() / 2] ^= 1;
  place.write("checkpoint", damaged);
  EXPECT_NE(refusal(42).find("damaged"), std::string::npos) << refusal(42);
  place.write("checkpoint", bytes.substr(0, bytes.size() - 9));
  EXPECT_NE(refusal(42).find("damaged"), std::string::npos) << refusal(42);
  place.write("checkpoint", "unit = \"mm\"\n");
  EXPECT_NE(refusal(42).find("not a checkpoint"), std::string::npos) << refusal(42);
  EXPECT_FALSE(read_checkpoint(place.path("none"), 42, same));
}

}  // namespace
}  // namespace turbid
