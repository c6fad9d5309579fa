// SPDX-License-Identifier: Apache-2.0
// Observed orders and extrapolation of sequences whose order is known.
#include "host/study/convergence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace turbid {
namespace {

constexpr double kRounding = 1e-12;

/// error = 3 h^order at h = 1, 1/2, 1/4, ...
std::vector<Level> exact_levels(double order, int count) {
  std::vector<Level> levels;
  for (int i = 0; i < count; ++i) levels.push_back({std::ldexp(1.0, -i), 3 * std::pow(std::ldexp(1.0, -i), order)});
  return levels;
}

TEST(ObservedOrder, is_the_slope_of_logarithms_not_a_ratio) {
  EXPECT_NEAR(observed_order({2, 12}, {1, 3}), 2, kRounding);
  EXPECT_NEAR(observed_order({3, 9}, {1, 1}), 2, kRounding);  // threefold refinement
  EXPECT_NEAR(observed_order({1, 1}, {0.5, 2}), -1, kRounding);
  EXPECT_TRUE(std::isnan(observed_order({1, 1}, {0.5, 0})));
  EXPECT_TRUE(std::isnan(observed_order({1, 1}, {1, 0.5})));
}

TEST(FittedOrder, of_an_exact_power_is_exact_and_its_interval_a_point) {
  for (const double order : {0.5, 1.0, 2.0, 4.0}) {
    const std::vector<Level> levels = exact_levels(order, 5);
    const auto fit = fitted_order(levels);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->order, order, kRounding);
    EXPECT_NEAR(fit->constant, 3, 1e-11);
    EXPECT_NEAR(fit->low, order, 1e-10);
    EXPECT_NEAR(fit->high, order, 1e-10);
    EXPECT_EQ(fit->levels, 5);
  }
}

TEST(FittedOrder, three_levels_by_hand) {
  // x = -1, 0, 1 and y = -1, 0.3, 1 in units of log 2: slope 1, intercept 0.1, residuals -0.1, 0.2, -0.1, so the
  // slope's standard error is sqrt(0.06 / 1 / 2).
  const std::vector<Level> levels{{0.5, 0.5}, {1, std::pow(2, 0.3)}, {2, 2}};
  const auto fit = fitted_order(levels);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 1, kRounding);
  EXPECT_NEAR(fit->high - fit->order, 12.7062047362 * std::sqrt(0.03), 1e-9);
  EXPECT_NEAR(fit->order - fit->low, 12.7062047362 * std::sqrt(0.03), 1e-9);
}

TEST(FittedOrder, two_levels_say_nothing_of_their_scatter) {
  const auto fit = fitted_order(exact_levels(2, 2));
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->order, 2, kRounding);
  EXPECT_TRUE(std::isinf(fit->low) && std::isinf(fit->high));
  EXPECT_TRUE(fit->includes(17));
}

TEST(FittedOrder, levels_without_a_positive_error_are_left_out) {
  std::vector<Level> levels = exact_levels(1, 4);
  levels.push_back({1.0 / 16, 0});
  levels.push_back({1.0 / 32, std::nan("")});
  EXPECT_EQ(fitted_order(levels)->levels, 4);
  EXPECT_FALSE(fitted_order(exact_levels(1, 1)));
  EXPECT_FALSE(fitted_order(std::vector<Level>{{1, 1}, {1, 2}}));
}

TEST(FittedOrder, the_interval_holds_the_true_order_in_95_of_100_noisy_studies) {
  for (const int count : {3, 4, 6, 12}) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 0.2);
    int held = 0;
    constexpr int kStudies = 4000;
    for (int study = 0; study < kStudies; ++study) {
      std::vector<Level> levels = exact_levels(2, count);
      for (Level& level : levels) level.error *= std::exp(noise(random));
      held += fitted_order(levels)->includes(2);
    }
    // Four standard deviations of a binomial of 4000 at 0.95: 0.0138.
    EXPECT_NEAR(double(held) / kStudies, 0.95, 0.0138) << count << " levels";
  }
}

TEST(StudentT, agrees_with_tables) {
  const std::pair<int, double> table[]{{1, 12.7062},  {2, 4.30265},  {5, 2.57058},
                                       {10, 2.22814}, {30, 2.04227}, {1000, 1.96234}};
  for (const auto& [degrees, value] : table) EXPECT_NEAR(student_t_975(degrees), value, 2e-3 * value) << degrees;
  EXPECT_TRUE(std::isinf(student_t_975(0)));
}

/// Trapezoidal rule for the integral of sin over [0, pi], which is 2; second order in h.
Sample trapezoid(int steps) {
  const double h = std::numbers::pi / steps;
  double sum = 0;
  for (int i = 1; i < steps; ++i) sum += std::sin(i * h);
  return {h, sum * h};
}

TEST(Richardson, of_the_trapezoidal_rule_is_simpsons_rule) {
  const Extrapolated result = richardson(trapezoid(8), trapezoid(16), 2);
  // Simpson with 16 steps: 2.0000165910479
  EXPECT_NEAR(result.value, 2.0000165910479, 1e-12);
  EXPECT_NEAR(result.error, 2.0000165910479 - trapezoid(16).value, 1e-12);
}

TEST(Richardson, three_levels_tell_the_order_whatever_their_ratios) {
  const auto value = [](double h) { return Sample{h, 5 - 2 * std::pow(h, 1.7)}; };
  for (const auto& [medium, fine] : {std::pair(0.5, 0.25), {0.6, 0.1}, {0.9, 0.3}}) {
    const auto result = richardson(value(1), value(medium), value(fine));
    ASSERT_TRUE(result);
    EXPECT_NEAR(result->order, 1.7, 1e-9);
    EXPECT_NEAR(result->value, 5, 1e-10);
  }
  const auto result = richardson(trapezoid(16), trapezoid(32), trapezoid(64));
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->order, 2, 0.01);  // the next term, h^4, is h^2 / 12 = 8e-4 of the first
  EXPECT_NEAR(result->value, 2, 1e-5);
}

TEST(Richardson, says_nothing_of_values_that_do_not_converge) {
  EXPECT_FALSE(richardson(Sample{4, 1}, {2, 2}, {1, 1.5}));  // oscillates
  EXPECT_FALSE(richardson(Sample{4, 1}, {2, 2}, {1, 4}));    // runs away
  EXPECT_FALSE(richardson(Sample{4, 1}, {2, 1}, {1, 1}));    // has arrived
  EXPECT_THROW(richardson(Sample{1, 1}, {2, 2}, {4, 3}), std::invalid_argument);
  EXPECT_THROW(richardson(Sample{1, 1}, {1, 2}, 2), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
