// SPDX-License-Identifier: Apache-2.0
// Statistics of measurements, the share of time in which a device is busy, traces, and comparing two profiles.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "host/base/errors.h"
#include "host/profile/profile.h"
#include "host/report/profile_report.h"

namespace turbid {
namespace {

cl::Command command(const std::string& name, const std::string& queue, double started, double ended) {
  cl::Command c;
  c.name = name;
  c.program = name + ".cl";
  c.queue = queue;
  c.stage = "work";
  c.called = c.queued = c.submitted = started - 0.001;
  c.returned = started;
  c.started = started;
  c.ended = ended;
  return c;
}

TEST(Spread, IsLeastMiddleAndLargest) {
  const Spread odd = spread_of({3, 1, 2}), even = spread_of({4, 1, 2, 3});
  EXPECT_EQ(odd.min, 1);
  EXPECT_EQ(odd.median, 2);
  EXPECT_EQ(odd.max, 3);
  EXPECT_EQ(even.median, 2.5);
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

TEST(Exponent, OfAPowerLawIsItsPower) {
  std::vector<double> x{1, 10, 30, 500}, y;
  for (const double value : x) y.push_back(7 * std::pow(value, 1.3));
  EXPECT_NEAR(exponent_of(x, y), 1.3, 1e-12);
  EXPECT_THROW(exponent_of({2, 2}, {1, 3}), std::invalid_argument);
}

TEST(BusyTime, CountsOverlappingCommandsOnce) {
  const cl::Command a = command("a", "march", 1, 3), b = command("b", "lattice", 2, 4), c = command("c", "march", 6, 7);
  EXPECT_DOUBLE_EQ(busy_seconds({&a, &b, &c}), 4);
  EXPECT_DOUBLE_EQ(busy_seconds({&c, &b, &a}), 4);
  EXPECT_EQ(busy_seconds({}), 0);
}

Frame small_frame() {
  Frame frame;
  frame.started = 1;
  frame.ended = 8;
  frame.commands = {command("c", "march", 6, 7), command("a", "march", 1.5, 3), command("b", "lattice", 2, 4)};
  frame.stages = {{"work", 1, 7.5}};
  return frame;
}

TEST(ChromeTrace, IsSortedCompleteEventsInMicrosecondsOneTrackPerQueue) {
  const auto trace = nlohmann::json::parse(chrome_trace(small_frame()));
  double before = 0;
  std::map<int, std::string> tracks;
  std::map<std::string, int> track_of;
  for (const auto& event : trace.at("traceEvents")) {
    if (event.at("ph") == "M") {
      if (event.at("name") == "thread_name") tracks[event.at("tid")] = event.at("args").at("name");
      continue;
    }
    ASSERT_EQ(event.at("ph"), "X");
    EXPECT_GE(event.at("ts").get<double>(), before);
    before = event.at("ts");
    EXPECT_GE(event.at("dur").get<double>(), 0);
    if (event.at("name") == "a") {
      EXPECT_NEAR(event.at("dur").get<double>(), 1.5e6, 1e-3);
    }
    track_of[event.at("name")] = event.at("tid");
  }
  EXPECT_EQ(tracks.at(track_of.at("a")), "queue march");
  EXPECT_EQ(tracks.at(track_of.at("b")), "queue lattice");
  EXPECT_EQ(track_of.at("a"), track_of.at("c"));
}

Profile small_profile(double seconds) {
  Profile p;
  const Spread around{seconds * 0.99, seconds, seconds * 1.01, 3};
  p.frame = p.kernels = p.device = around;
  const Spread ten{9, 10, 11, 3};
  p.ceilings = {ten, ten, ten, ten, ten};
  p.stages = {{"march", around, around, around, 1}};
  KernelProfile kernel;
  kernel.name = "march";
  kernel.calls = 1;
  kernel.frame_seconds = kernel.call_seconds = around;
  p.commands = {kernel};
  p.median_frame = small_frame();
  return p;
}

class OldProfile : public testing::Test {
 protected:
  OldProfile() { write(document_json(profile_document(small_profile(1.0), "scene", {}))); }
  ~OldProfile() override { std::filesystem::remove(file_); }
  void write(const std::string& text) { std::ofstream(file_) << text; }
  std::string file_ = (std::filesystem::temp_directory_path() / "turbid_old_profile.json").string() +
                      std::to_string(getpid());
};

TEST_F(OldProfile, WhatTakesTwiceAsLongIsARegression) {
  const auto changes = compare_profiles(file_, small_profile(2.0));
  ASSERT_EQ(changes.size(), 3u);  // the frame, its stage, its kernel
  for (const ProfileChange& change : changes) {
    EXPECT_NEAR(change.ratio, 2, 1e-9) << change.name;
    EXPECT_TRUE(change.regression) << change.name;
  }
}

TEST_F(OldProfile, WhatLiesWithinTheSpreadIsNone) {
  for (const ProfileChange& change : compare_profiles(file_, small_profile(1.015))) EXPECT_FALSE(change.regression);
}

TEST_F(OldProfile, ASlowerMachineIsNoRegression) {
  Profile now = small_profile(2.0);
  now.ceilings.triad = {4, 5, 6, 3};
  for (const ProfileChange& change : compare_profiles(file_, now)) {
    EXPECT_NEAR(change.corrected, 1, 1e-9);
    EXPECT_FALSE(change.regression);
  }
}

TEST_F(OldProfile, ThatIsBrokenIsTheUsersToMend) {
  write("{\"sections\": []}");
  EXPECT_THROW(require_profile(file_), InputError);
  write("nonsense");
  EXPECT_THROW(require_profile(file_), InputError);
  EXPECT_THROW(require_profile(file_ + ".missing"), InputError);
}

}  // namespace
}  // namespace turbid
