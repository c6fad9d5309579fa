// SPDX-License-Identifier: Apache-2.0
// Figures of reports: ticks stand at round numbers, what an axis cannot show is said, and no coordinate is lost.
#include "host/report/figure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/report/label_room.h"

namespace turbid {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> names;
  for (const Tick& tick : ticks.ticks)
    if (!tick.label.empty()) names.push_back(tick.label);
  return names;
}

using Names = std::vector<std::string>;

TEST(Ticks, OfALinearAxisStandAtStepsOfOneTwoOrFive) {
  EXPECT_EQ(labels(ticks_for({0, 1, false}, 5)), (Names{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(ticks_for({-3, 12, false}, 5)), (Names{"0", "5", "10"}));
}

TEST(Ticks, OfLargeAndSmallLinearAxesShareAPowerOfTen) {
  const Ticks small = ticks_for({0, 4.2e-5, false}, 5);
  EXPECT_EQ(labels(small), (Names{"0", "1", "2", "3", "4"}));
  EXPECT_EQ(small.factor,
            "\xC3\x97"
            "10^-5");
  EXPECT_DOUBLE_EQ(small.ticks[3].at, 3e-5);
}

TEST(Ticks, OfALogarithmicAxisArePowersOfTenWithMinorTicksBetween) {
  const Ticks ticks = ticks_for({1e-6, 1e-2, true}, 6);
  EXPECT_EQ(labels(ticks), (Names{"10^-6", "10^-5", "10^-4", "10^-3", "10^-2"}));
  EXPECT_EQ(ticks.ticks.size(), 4u * 9 + 1);
  EXPECT_EQ(labels(ticks_for({0.03, 1.2, true}, 5)), (Names{"0.05", "0.1", "0.2", "0.5", "1"}));
  EXPECT_LE(labels(ticks_for({1e-20, 1e20, true}, 6)).size(), 7u);
}

TEST(Ticks, OfALogarithmicAxisNarrowerThanItsDigitsAreLinear) {
  EXPECT_GE(labels(ticks_for({1.02, 1.31, true}, 5)).size(), 2u);
}

TEST(Scale, HoldsEveryValueThatItsAxisCanShow) {
  const std::vector<std::vector<double>> sets{
      {}, {0}, {5}, {-5}, {1e-300, 1e200}, {3, 3 + 1e-15}, {kNan, kInfinity, 2}, {-1, 1e240}};
  for (const bool log : {false, true})
    for (const auto& values : sets) {
      const Axis axis{"", "", log};
      const Scale scale = fitted_scale(axis, values);
      EXPECT_LT(scale.low, scale.high);
      for (const double value : values) {
        if (!showable(axis, value)) continue;
        EXPECT_GE(scale(value), 0) << value;
        EXPECT_LE(scale(value), 1) << value;
      }
    }
}

Plot awkward(bool log) {
  Plot plot{.id = "p", .x = {"x", "mm", log}, .y = {"y", "", log}};
  plot.series = {{.name = "a", .x = {1, 2, 3, 4, 5, kNan}, .y = {1, 0, -1, kNan, kInfinity, 1}},
                 {.name = "b", .x = {1, 2}, .y = {3, 4}, .y_low = {0, -1}, .y_high = {kInfinity, kNan}},
                 {.name = "empty"}};
  plot.slopes = {{2}, {1, "", 1}, {1, "", 2}};
  plot.lines = {{true, 0, "zero"}, {false, -1, "below"}, {false, kNan, "nowhere"}, {true, 1.5, "here"}};
  return plot;
}

void expect_finite(const std::string& svg) {
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(Plot, LeavesOutWhatALogarithmicAxisCannotShowAndSaysSo) {
  EXPECT_EQ(left_out(awkward(true)), "5 points are zero, negative or not finite and cannot be shown on these axes.");
  EXPECT_EQ(left_out(awkward(false)), "3 points are not finite and cannot be shown on these axes.");
  Plot sound = awkward(true);
  sound.series.erase(sound.series.begin());
  EXPECT_EQ(left_out(sound), "");
}

TEST(Plot, HasNoCoordinateThatIsNotANumber) {
  for (const bool log : {false, true})
    for (const FigureLayout& layout : {kWideFigure, kNarrowFigure}) expect_finite(plot_svg(awkward(log), layout));
}

TEST(Plot, OfNothingSaysSo) {
  for (const bool log : {false, true}) {
    const Plot empty{.id = "p", .x = {"x", "", log}, .y = {"y", "", log}, .series = {{.name = "void"}}};
    const std::string svg = plot_svg(empty, kWideFigure);
    EXPECT_NE(svg.find("no data"), std::string::npos);
    expect_finite(svg);
  }
  EXPECT_EQ(plot_svg(awkward(true), kWideFigure).find("no data"), std::string::npos);
}

TEST(Plot, DrawsAReferenceSlopeWithItsOrder) {
  Plot plot{.id = "p", .x = {"h", "", true}, .y = {"error", "", true}};
  plot.series = {{.name = "steady", .x = {1, 0.5, 0.25}, .y = {1, 0.25, 0.0625}}};
  plot.slopes = {{2}};
  EXPECT_NE(plot_svg(plot, kWideFigure).find(">order 2<"), std::string::npos);
  plot.y.log = false;  // no straight line there
  EXPECT_EQ(plot_svg(plot, kWideFigure).find(">order 2<"), std::string::npos);
}

TEST(Bars, SayWhichValuesTheyCannotShow) {
  const BarChart chart{
      .id = "b", .value = {"time", "s", true}, .groups = {"a", "b"}, .series = {{"x", {0, 2}}, {"y", {1, kNan}}}};
  EXPECT_EQ(left_out(chart), "2 bars are missing: their values are zero, negative or not finite.");
  EXPECT_NE(bars_svg(chart, kNarrowFigure).find("<title>x: 2.00000</title>"), std::string::npos);
  EXPECT_EQ(left_out(BarChart{.id = "b"}), "");
  expect_finite(bars_svg(BarChart{.id = "b"}, kWideFigure));
}

TEST(Timeline, MergesIntervalsThatLieCloserThanAPixelCanShow) {
  Timeline timeline{.id = "q", .tracks = {{"march"}, {"lattice"}}};
  for (int i = 0; i < 20000; ++i) timeline.tracks[0].intervals.push_back({"batch", i * 1.0, i + 0.99});
  timeline.tracks[1].intervals = {{"collide", 0, 5000}, {"collide", 15000, 20000}, {"backwards", 3, 2}};
  const std::string svg = timeline_svg(timeline, kWideFigure);
  EXPECT_LT(svg.size(), 10000u);
  EXPECT_NE(svg.find("20000 of batch"), std::string::npos);
  EXPECT_NE(svg.find("collide: 15000 to 20000 ms"), std::string::npos);
  EXPECT_EQ(left_out(timeline), "One interval ends before it begins or is not finite: left out.");
  expect_finite(timeline_svg(Timeline{.id = "q"}, kWideFigure));
}

TEST(Timeline, GivesTheFirstColoursToWhatTakesLongest) {
  Timeline timeline{.id = "q", .tracks = {{"queue"}}};
  for (int i = 0; i < 9; ++i)  // the ninth name takes longest, the first least
    timeline.tracks[0].intervals.push_back({"k" + std::to_string(i), i * 10.0, i * 10.0 + i + 1});
  const std::string svg = timeline_svg(timeline, kWideFigure);
  EXPECT_NE(svg.find("class=\"area c0 outlined\"><title>k8:"), std::string::npos);
  EXPECT_NE(svg.find("class=\"area c0 pale outlined\"><title>k0:"), std::string::npos) << "not the same as k8";
}

TEST(LabelRoom, PlacesNoLabelOverAnother) {
  LabelRoom room({0, 0, 100, 100});
  room.take_line({0, 50}, {100, 50});
  EXPECT_EQ(room.place({{10, 45, 20, 10}, {10, 60, 20, 10}}, false), 1);
  EXPECT_EQ(room.place({{15, 62, 20, 10}}, false), -1);
  EXPECT_EQ(room.place({{15, 62, 20, 10}}, true), 0);
  EXPECT_EQ(room.place({{90, 10, 20, 10}, {80, 10, 20, 10}}, false), 1) << "the first leaves the frame";
}

}  // namespace
}  // namespace turbid
