// SPDX-License-Identifier: Apache-2.0
// turbid verify as a user runs it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/run.h"

namespace turbid::test {
namespace {

TEST(Verify, an_unknown_case_is_one_line_that_names_the_known_ones) {
  const Outcome outcome = Workplace().turbid({"verify", "15", "sunshine"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  ASSERT_EQ(outcome.error_lines().size(), 1u);
  EXPECT_NE(outcome.err.find("sunshine: no such case; there are matrix, identity"), std::string::npos) << outcome.err;
}

TEST(Verify, a_case_by_its_number_and_by_its_name_is_run_once_and_reported) {
  const Workplace place;
  const Outcome outcome = place.turbid({"verify", "15", "snell", "-q", "--json", "-o", "page/"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["cases"].size(), 1u);
  EXPECT_EQ(json["cases"][0]["name"], "snell");
  EXPECT_TRUE(json["passed"]);
  for (const auto& check : json["cases"][0]["checks"]) EXPECT_FALSE(std::string(check["reason"]).empty());
  const std::vector<std::string> files = place.content();
  for (const std::string file : {"page/verify.html", "page/verify.json", "page/verify.cases.csv"})
    EXPECT_NE(std::find(files.begin(), files.end(), file), files.end()) << file;
}

TEST(Verify, the_list_has_all_21_numbers) {
  const auto json = nlohmann::json::parse(Workplace().turbid({"verify", "--list", "--json"}).out);
  std::vector<int> numbers;
  for (const auto& one : json["cases"])
    if (one.contains("number")) numbers.push_back(one["number"]);
  ASSERT_EQ(numbers.size(), 21u);
  for (int i = 0; i < 21; ++i) EXPECT_EQ(numbers[i], i + 1);
}

}  // namespace
}  // namespace turbid::test
