// SPDX-License-Identifier: Apache-2.0
// Fields by formula: muParser expressions, gradient noise, constant and named index fields.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "host/base/errors.h"
#include "volumes/noise.h"
#include "volumes/procedural.h"

namespace turbid {
namespace {

glm::vec3 at(const FieldPtr& field, glm::vec3 x) {
  glm::vec3 value;
  field->evaluate({&x, 1}, {&value, 1});
  return value;
}

float grey(const std::string& text, glm::vec3 x) {
  return at(expression_field(text), x).x;
}

std::string error_of(const std::string& text) {
  try {
    expression_field(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Expression, knows_position_radius_and_pi) {
  EXPECT_FLOAT_EQ(grey("x + 10*y + 100*z", {1, 2, 3}), 321.0f);
  EXPECT_FLOAT_EQ(grey("r", {2, 3, 6}), 7.0f);
  EXPECT_FLOAT_EQ(grey("sin(pi/6)", {0, 0, 0}), 0.5f);
}

TEST(Expression, has_shaping_functions) {
  EXPECT_FLOAT_EQ(grey("clamp(x, 0, 1)", {3, 0, 0}), 1.0f);
  EXPECT_FLOAT_EQ(grey("clamp(x, 0, 1)", {-3, 0, 0}), 0.0f);
  EXPECT_FLOAT_EQ(grey("mix(2, 4, 0.25)", {0, 0, 0}), 2.5f);
  EXPECT_FLOAT_EQ(grey("step(1, x)", {0.5f, 0, 0}), 0.0f);
  EXPECT_FLOAT_EQ(grey("step(1, x)", {1, 0, 0}), 1.0f);
  EXPECT_FLOAT_EQ(grey("smoothstep(0, 2, x)", {1, 0, 0}), 0.5f);
  EXPECT_FLOAT_EQ(grey("x < 0 ? 1 : 2", {-1, 0, 0}), 1.0f);
}

TEST(Expression, three_texts_are_red_green_blue) {
  const FieldPtr field = expression_field(std::array<std::string, 3>{"x", "y", "y"});
  EXPECT_EQ(at(field, {1, 2, 3}), glm::vec3(1, 2, 2));
  EXPECT_FALSE(field->constant());
}

TEST(Expression, without_position_is_constant) {
  EXPECT_EQ(expression_field("2*pi - 2*pi + 3")->constant(), glm::vec3(3));
  EXPECT_FALSE(expression_field("0*x")->constant());
}

TEST(Expression, noise_in_a_text_is_the_gradient_noise) {
  EXPECT_FLOAT_EQ(grey("noise(0.3*x, 0.3*y, 0.3*z)", {1, 2, 4}), static_cast<float>(gradient_noise(0.3, 0.6, 1.2)));
  EXPECT_FLOAT_EQ(grey("fbm(x, y, z, 3)", {0.1f, 0.2f, 0.3f}), static_cast<float>(fractal_noise(0.1f, 0.2f, 0.3f, 3)));
}

TEST(Expression, may_be_evaluated_by_several_threads) {
  const FieldPtr field = expression_field("x*x + noise(x, y, z)");
  std::vector<glm::vec3> x(2000), expected(x.size()), a(x.size()), b(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = {0.01f * i, 0.5f, 0.25f};
  field->evaluate(x, expected);
  std::thread first([&] { field->evaluate(x, a); });
  field->evaluate(x, b);
  first.join();
  EXPECT_EQ(a, expected);
  EXPECT_EQ(b, expected);
}

TEST(Expression, mistakes_are_named_with_their_place) {
  EXPECT_NE(error_of("2 + nois(x)").find("expression \"2 + nois(x)\", character 5: "), std::string::npos)
      << error_of("2 + nois(x)");
  EXPECT_NE(error_of("2 + nois(x)").find("nois"), std::string::npos);
  EXPECT_NE(error_of("2 +").find("expression \"2 +\""), std::string::npos);
  EXPECT_NE(error_of("noise(x)").find("noise"), std::string::npos);
  EXPECT_NE(error_of("").find("is empty"), std::string::npos);
  EXPECT_NE(error_of("1, 2").find("gives 2 values: expected one"), std::string::npos);
}

TEST(Expression, can_not_assign_to_the_position) {
  EXPECT_NE(error_of("x = 1 ? 2 : 3").find("character 3: \"=\" would assign"), std::string::npos);
  EXPECT_FLOAT_EQ(grey("x == 1 ? 2 : 3", {1, 0, 0}), 2.0f);
  EXPECT_FLOAT_EQ(grey("x >= 1 && x <= 1 && x != 2 ? 2 : 3", {1, 0, 0}), 2.0f);
}

TEST(Noise, stays_within_one_and_uses_its_range) {
  double lowest = 0, highest = 0, sum = 0;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double v = gradient_noise(0.6180339887 * i, 0.7548776662 * i, 0.5698402910 * i);
    lowest = std::min(lowest, v);
    highest = std::max(highest, v);
    sum += v;
  }
  EXPECT_GE(lowest, -1.0);
  EXPECT_LE(highest, 1.0);
  EXPECT_LT(lowest, -0.7);
  EXPECT_GT(highest, 0.7);
  EXPECT_NEAR(sum / n, 0.0, 0.003);  // standard deviation 0.26, 2e5 samples: 5 sigma
}

TEST(Noise, is_zero_at_lattice_points_and_smooth_across_them) {
  EXPECT_EQ(gradient_noise(3, -7, 1000000), 0.0);
  const double e = 1e-5;
  for (const double x : {-2.0, 0.0, 5.0}) {
    const double left = (gradient_noise(x, 0.4, 0.7) - gradient_noise(x - e, 0.4, 0.7)) / e;
    const double right = (gradient_noise(x + e, 0.4, 0.7) - gradient_noise(x, 0.4, 0.7)) / e;
    EXPECT_NEAR(left, right, 1e-3);  // C2: the slopes differ by O(e)
  }
}

TEST(Noise, has_no_short_period_and_no_mirror) {
  int equal = 0;
  for (int i = 0; i < 64; ++i) {
    const double x = i + 0.37;
    for (const double other : {x + 256, x + 1024, x + 65536, x + 4294967296.0, -x})
      equal += std::fabs(gradient_noise(x, 0.2, 0.6) - gradient_noise(other, 0.2, 0.6)) < 1e-6;
  }
  EXPECT_LE(equal, 3);  // a chance coincidence now and then
}

TEST(Noise, is_the_same_on_every_machine) {
  // Recorded once; IEEE arithmetic without contraction leaves no freedom.
  EXPECT_NEAR(gradient_noise(0.3, 0.6, 1.2), -0.318557973459942, 1e-12);
  EXPECT_NEAR(gradient_noise(-12345.678, 0.5, 98765.4321), -0.179789218715541, 1e-9);
  EXPECT_NEAR(fractal_noise(0.1, 0.2, 0.3, 4), 0.049150218321528, 1e-12);
}

TEST(Noise, of_nan_is_nan) {
  EXPECT_TRUE(std::isnan(gradient_noise(std::nan(""), 0, 0)));
  EXPECT_TRUE(std::isnan(gradient_noise(0, 1e300 * 1e300, 0)));
  EXPECT_EQ(gradient_noise(1e300, 0.5, 0.5), 0.0);
}

TEST(IndexFields, luneburg_is_root_two_at_the_centre_one_at_the_surface_and_goes_on_smoothly) {
  const FieldPtr field = luneburg_index({1, 0, 0}, 2, 1);
  EXPECT_FLOAT_EQ(at(field, {1, 0, 0}).x, std::sqrt(2.0f));
  EXPECT_FLOAT_EQ(at(field, {1, 1, 0}).x, std::sqrt(1.75f));
  EXPECT_FLOAT_EQ(at(field, {1, 2, 0}).x, 1.0f);
  EXPECT_FLOAT_EQ(at(field, {1, 2.2f, 0}).x, std::sqrt(2.0f - 1.21f));
  EXPECT_FLOAT_EQ(at(field, {1, 9, 0}).x, std::sqrt(0.1f));  // no square root of a negative number far away
}

TEST(IndexFields, fisheye_halves_at_its_radius_and_goes_on_falling) {
  const FieldPtr field = fisheye_index({0, 0, 0}, 2, 3);
  EXPECT_FLOAT_EQ(at(field, {0, 0, 0}).x, 3.0f);
  EXPECT_FLOAT_EQ(at(field, {0, 1, 0}).x, 2.4f);
  EXPECT_FLOAT_EQ(at(field, {0, 2, 0}).x, 1.5f);
  EXPECT_FLOAT_EQ(at(field, {0, 4, 0}).x, 0.6f);
}

TEST(IndexFields, rod_depends_on_the_distance_from_its_axis_and_never_falls_below_one) {
  const FieldPtr field = rod_index({0, 1, 0}, {0, 0, 5}, 1.6f, 0.5f);
  EXPECT_FLOAT_EQ(at(field, {0, 1, 30}).x, 1.6f);
  EXPECT_FLOAT_EQ(at(field, {1, 1, -4}).x, 1.6f * std::sqrt(0.75f));
  EXPECT_FLOAT_EQ(at(field, {100, 1, 0}).x, 1.0f);
}

TEST(IndexFields, linear_grows_along_its_gradient_and_never_falls_below_one) {
  const FieldPtr field = linear_index({1, 0, 0}, 1.3f, {0.1f, 0, 0});
  EXPECT_FLOAT_EQ(at(field, {3, 5, 5}).x, 1.5f);
  EXPECT_FLOAT_EQ(at(field, {-100, 0, 0}).x, 1.0f);
}

TEST(ConstantField, is_its_value_everywhere) {
  EXPECT_EQ(constant_field({1, 2, 3})->constant(), glm::vec3(1, 2, 3));
  EXPECT_EQ(at(constant_field({1, 2, 3}), {9, 9, 9}), glm::vec3(1, 2, 3));
}

}  // namespace
}  // namespace turbid
