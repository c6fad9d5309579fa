// SPDX-License-Identifier: Apache-2.0
// turbid profile as a user runs it: what it writes, and what it says of wrong arguments. No times are asserted.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

nlohmann::json json_of(const std::string& file) {
  std::ifstream stream(file);
  return nlohmann::json::parse(stream);
}

TEST(Profile, WritesPageTablesAndTraceAndComparesWithItself) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome first =
      place.turbid({"profile", "s.toml", "--resolution", "16", "--repeat", "2", "--general", "-o", "p", "--trace", "trace.json"});
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_NE(first.out.find("A warm frame takes"), std::string::npos) << first.out;
  EXPECT_NE(first.out.find("The general path takes"), std::string::npos) << first.out;
  const auto profile = json_of(place.path("p/profile.json"));
  EXPECT_EQ(profile.at("title"), "Profile of s");
  int complete = 0;
  std::vector<std::string> names;
  const auto trace = json_of(place.path("trace.json"));
  for (const auto& event : trace.at("traceEvents")) {
    complete += event.at("ph") == "X";
    names.push_back(event.at("name"));
  }
  EXPECT_GT(complete, 10);
  for (const char* name : {"march", "view", "ascend"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  // Whatever the times are, the comparison is made and says so.
  const Outcome second = place.turbid(
      {"profile", "s.toml", "--resolution", "16", "--repeat", "2", "-o", "q", "--compare", "p/profile.json"});
  EXPECT_TRUE(second.status == 0 || second.status == 1) << second.err;
  EXPECT_NE(second.out.find("Against the older profile"), std::string::npos) << second.out;
}

TEST(Profile, ABrokenOlderProfileIsOneLineAndNothingIsWritten) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  place.write("old.json", "{\"title\": \"no profile\"}");
  for (const std::string file : {"old.json", "missing.json"}) {
    const Outcome outcome = place.turbid({"profile", "s.toml", "--compare", file, "-o", "p"});
    EXPECT_EQ(outcome.status, 2);
    ASSERT_EQ(outcome.error_lines().size(), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find("--compare " + file), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(place.content(), (std::vector<std::string>{"old.json", "s.toml"}));
}

TEST(Profile, NoRepeatsIsBadInput) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome outcome = place.turbid({"profile", "s.toml", "--repeat", "0"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("--repeat"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace turbid::test
