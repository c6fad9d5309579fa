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

TEST(Converge, what_cannot_be_weighed_or_estimated_is_one_line_and_status_2) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  place.write("blind.toml",
              milky_ball_with("[camera]\nposition = [0, 10, 60]\nwidth = 48\nheight = 32\nsamples = 1\n", ""));
  const auto run = [&](Words words) {
    words.insert(words.begin(), "converge");
    words.push_back("-q");
    return place.turbid(words);
  };
  expect_refused(run({"--pareto"}), "expected a case or a scene");
  expect_refused(run({"sphere_matched", "--pareto"}), "sphere_matched: expected a scene");
  expect_refused(run({"s.toml", "--pareto", "--error", "0.05,2"}), "--error: expected errors in (0, 1)");
  expect_refused(run({"s.toml", "--pareto", "--photons", "1"}), "--photons: expected 2");
  expect_refused(run({"s.toml", "s.toml", "--pareto"}), "expected one case or scene");
  expect_refused(run({"s.toml", "nowhere.toml", "--estimate"}), "nowhere.toml");
  expect_refused(run({"blind.toml", "--estimate"}), "has no [camera]");
  EXPECT_EQ(place.content(), (Words{"blind.toml", "s.toml"}));
}

TEST(Converge, weighing_a_scene_marks_what_is_worth_using_and_recommends_for_each_aim) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  const Outcome outcome = place.turbid({"converge", "s.toml", "--pareto", "--resolution", "16", "--photons", "2e4",
                                        "--error", "0.5,0.001", "-q", "--json", "-o", "p/out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(place.content(),
            (Words{"p/", "p/out.html", "p/out.json", "p/out.recommended.csv", "p/out.runs.csv", "s.toml"}));
  // Half is reached by diffusion, a thousandth by nothing but photons.
  EXPECT_NE(outcome.out.find("50 %"), std::string::npos);
  EXPECT_NE(outcome.out.find("0.1 %"), std::string::npos);
  EXPECT_NE(outcome.out.find("photon"), std::string::npos);
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

TEST(RenderError, an_error_that_cannot_be_met_is_refused_or_told) {
  const Workplace place;
  place.write("s.toml", kMilkyBall);
  for (const char* bad : {"0", "-0.1", "2", "few"})
    expect_refused(place.turbid({"render", "s.toml", "--error", bad, "-q", "-o", "out"}), "error");
  EXPECT_EQ(place.content(), Words{"s.toml"});
  // So coarse a grid is kept because it is asked for.
  const Outcome outcome =
      place.turbid({"render", "s.toml", "--error", "0.12", "--resolution", "8", "--json", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  const bool told = outcome.err.find("more than the 0.12 asked for") != std::string::npos;
  EXPECT_EQ(told, json["error_estimate"]["picture"]["total"].get<double>() > 0.12) << outcome.err;
  EXPECT_NE(json["chosen"].get<std::string>().find("8 voxels"), std::string::npos);
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
