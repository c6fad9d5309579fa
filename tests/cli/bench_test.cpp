// SPDX-License-Identifier: Apache-2.0
// turbid bench as a user runs it: wrong names, and a small run of each kind. No times are asserted.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/run.h"

namespace turbid::test {
namespace {

TEST(Bench, WrongNamesAreOneLineThatSaysWhatThereIs) {
  const Workplace place;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"bench", "papers"}, "papers: no such benchmark; there are paper, scaling, goals, all"},
      {{"bench", "paper", "--only", "histories"}, "--only histories: paper has history, blocks, albedo"},
      {{"bench", "goals", "--scenes", "nowhere"}, "--scenes nowhere: has no bunny.toml"}};
  for (const auto& [arguments, said] : wrong) {
    const Outcome outcome = place.turbid(arguments);
    EXPECT_EQ(outcome.status, 2);
    ASSERT_EQ(outcome.error_lines().size(), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(said), std::string::npos) << outcome.err;
  }
  EXPECT_TRUE(place.content().empty());
}

TEST(Bench, APartOfThePapersExperimentsWritesItsReport) {
  const Workplace place;
  const Outcome outcome =
      place.turbid({"bench", "all", "--quick", "--only", "queues", "--only", "fraction", "-q", "--json", "-o", "b"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(report.at("sections").size(), 2u);
  EXPECT_EQ(report.at("sections").at(0).at("title"), "What two queues can gain on this device");
  const auto parts = report.at("sections").at(1).at("parts");
  const auto table = std::find_if(parts.begin(), parts.end(), [](const auto& part) { return part.at("kind") == "table"; });
  ASSERT_NE(table, parts.end());
  EXPECT_EQ(table->at("rows").size(), 5u);
  // Fewer active voxels at every smaller radius.
  for (std::size_t i = 1; i < 5; ++i) EXPECT_LT(table->at("rows").at(i).at(1), table->at("rows").at(i - 1).at(1));
  EXPECT_TRUE(std::ifstream(place.path("b/all.html")).good());
}

}  // namespace
}  // namespace turbid::test
