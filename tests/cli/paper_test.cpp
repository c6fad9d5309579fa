// SPDX-License-Identifier: Apache-2.0
// turbid verify --paper at its smallest: the page is written and says what the design derived.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/run.h"

namespace turbid::test {
namespace {

TEST(PaperStudy, WritesAPageWhoseNumbersAreThoseOfTheDesign) {
  const Workplace place;
  const Outcome outcome = place.turbid({"verify", "--paper", "--quick", "-q", "-o", "report/"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::ifstream page(place.path("report/paper.html"));
  EXPECT_TRUE(page.good());
  const auto report = nlohmann::json::parse(std::ifstream(place.path("report/paper.json")));
  const auto table = [&](const std::string& id) {
    for (const auto& section : report.at("sections"))
      for (const auto& part : section.at("parts"))
        if (part.value("id", "") == id && part.contains("rows")) return part;
    throw std::runtime_error("no table " + id);
  };
  const std::string all = report.dump();
  // Numerics section 6: Fig. 4 refracts light of 30 degrees to asin(.5 / sqrt 2), the others by Snell.
  EXPECT_NE(all.find("20.70"), std::string::npos);
  // Numerics section 1: the printed collision breaks beyond s = 2, and the engine refuses it there.
  EXPECT_NE(table("stability").dump().find("refused"), std::string::npos);
  EXPECT_EQ(table("stopping").at("rows").size(), 4u);
}

}  // namespace
}  // namespace turbid::test
