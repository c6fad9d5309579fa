// SPDX-License-Identifier: Apache-2.0
// turbid converge and render --error as a user runs them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/run.h"
#include "tests/support/small_scene.h"

namespace turbid::test {
namespace {

using Words = std::vector<std::string>;

void expect_refused(const Outcome& outcome, const std::string& piece) {
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(piece), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.error_lines().size(), 1u) << outcome.err;
}

TEST(Converge, what_cannot_be_refined_is_one_line_and_status_2) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const auto run = [&](Words words) {
    words.insert(words.begin(), "converge");
    words.push_back("-q");
    return place.turbid(words);
  };
  expect_refused(run({"nothing", "--over", "voxel_size"}), "nothing: no scene (.toml) and no such case");
  expect_refused(run({"nowhere.toml", "--over", "voxel_size"}), "nowhere.toml");
  expect_refused(run({"s.toml", "--over", "colour"}), "--over colour: no such parameter; there are voxel_size");
  expect_refused(run({"s.toml", "--over", "voxel_size", "--levels", "32,16"}), "--levels 32,16: expected");
  expect_refused(run({"s.toml", "--over", "step", "--levels", "0.5"}), "--levels 0.5: expected two or more");
  expect_refused(run({"s.toml", "--over", "voxel_size", "--levels", "16,24"}), "whole multiples");
  expect_refused(run({"s.toml"}), "--over PARAMETER");
  expect_refused(run({"s.toml", "--over", "step,voxel_size"}), "--over step,voxel_size: expected as the second");
  expect_refused(run({"s.toml", "--over", "step,rays,inner"}), "expected one or two parameters");
  expect_refused(run({"s.toml", "s.toml", "--over", "step"}), "expected one case or scene");
  expect_refused(run({"s.toml", "--against", "truth"}), "--against truth: expected photon");
  EXPECT_EQ(place.content(), Words{"s.toml"});
}

TEST(Converge, refining_voxels_of_a_milky_ball_meets_the_expected_order_and_writes_a_page) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome outcome = place.turbid(
      {"converge", "s.toml", "--over", "voxel_size", "--levels", "16,32", "--picture", "-q", "--json", "-o", "v/out"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_NE(outcome.out.find("Observed order"), std::string::npos);
  EXPECT_EQ(place.content(),
            (Words{"s.toml", "v/", "v/out.html", "v/out.json", "v/out.levels.csv", "v/out.stages.csv"}));
}

TEST(Converge, two_parameters_make_a_table_whose_finest_corner_errs_least) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome outcome = place.turbid({"converge", "s.toml", "--over", "voxel_size,step", "--levels", "16,32",
                                        "--levels2", "2,0.5", "-q", "-o", "two"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::ifstream table(place.path("two.both.csv"));
  std::string line, cell;
  std::vector<std::vector<double>> errors;
  std::getline(table, line);
  while (std::getline(table, line)) {
    std::stringstream cells(line);
    for (errors.emplace_back(); std::getline(cells, cell, ',');) errors.back().push_back(std::stod(cell));
  }
  ASSERT_EQ(errors.size(), 2u);
  ASSERT_EQ(errors[1].size(), 3u);  // the voxels, and an error per step
  EXPECT_LT(errors[1][2], errors[0][2]);
  EXPECT_LT(errors[1][2], errors[1][1]);
}

TEST(RenderError, chooses_settings_says_which_and_reaches_the_asked_error) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome outcome = place.turbid({"render", "s.toml", "--error", "0.5", "-q", "--json", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_NE(json["chosen"].get<std::string>().find("voxels, step"), std::string::npos);
  EXPECT_LE(json["error_estimate"]["picture"]["total"].get<double>(), 0.5);
}

TEST(RenderError, every_run_reports_the_parts_of_its_error) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const auto json = nlohmann::json::parse(place.turbid({"solve", "s.toml", "-q", "--json", "-o", "f.vdb"}).out);
  const auto& parts = json["error_estimate"]["fluence"];
  double sum = 0;
  for (const char* part : {"grid", "steps", "rays", "solve", "model"}) {
    EXPECT_GT(parts[part].get<double>(), 0) << part;
    sum += parts[part].get<double>();
  }
  EXPECT_NEAR(parts["total"].get<double>(), sum, 1e-12);
  const Outcome off =
      place.turbid({"solve", "s.toml", "-q", "--json", "-o", "f.vdb", "-D", "solver.error_estimate=off"});
  EXPECT_FALSE(nlohmann::json::parse(off.out).contains("error_estimate"));
}

}  // namespace
}  // namespace turbid::test
