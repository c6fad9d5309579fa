// SPDX-License-Identifier: Apache-2.0
// FLIP against what follows from its definition, and against numbers of the authors' own program (flip-evaluator 1.7
// from PyPI, ppd 67.02064514160156 unless said otherwise; its maps at the pixels named here).
#include "host/study/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace turbid {
namespace {

using Pixels = std::vector<glm::vec3>;

// Rounding of float in 21 x 21 filter taps leaves 1e-8 in the features of an even picture, of which FLIP takes the
// root.
constexpr double kEven = 1e-4;
/// HyAB of Hunt-adjusted pure green and pure blue, the largest of all, worked out in double precision.
constexpr double kGreenToBlue = 203.30499;
constexpr double kProgram = 5e-6;  // the authors' program works in float too and prints six decimals

Pixels even(glm::vec3 colour, int count = 48) {
  return Pixels(count, colour);
}
double flip_of_colours(glm::vec3 reference, glm::vec3 test) {
  return flip(even(test), even(reference), 8, 6).mean;
}

/// A busy picture of 41 x 29 pixels from integer arithmetic, each channel with its own period.
constexpr int kWidth = 41, kHeight = 29;
Pixels busy() {
  constexpr int kSquare[] = {3, 5, 2}, kLine[] = {7, 11, 13}, kPeriod[] = {64, 50, 37};
  Pixels pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      glm::vec3 pixel;
      for (int c = 0; c < 3; ++c)
        pixel[c] = float((kSquare[c] * x * x + kLine[c] * y + x * y) % kPeriod[c]) / float(kPeriod[c] - 1);
      pixels.push_back(pixel);
    }
  return pixels;
}
/// The right half as a negative, and a white square of 3 x 3 pixels.
Pixels spoilt() {
  Pixels pixels = busy();
  for (int y = 0; y < kHeight; ++y)
    for (int x = 20; x < kWidth; ++x) pixels[y * kWidth + x] = 1.0f - pixels[y * kWidth + x];
  for (int y = 10; y < 13; ++y)
    for (int x = 5; x < 8; ++x) pixels[y * kWidth + x] = glm::vec3(1);
  return pixels;
}
void expect_map(const FlipMap& map, double mean, const std::vector<float>& at_probes) {
  EXPECT_NEAR(map.mean, mean, kProgram);
  const glm::ivec2 probes[] = {{0, 0}, {6, 11}, {20, 14}, {40, 28}, {19, 3}, {30, 20}};
  for (std::size_t i = 0; i < at_probes.size(); ++i)
    EXPECT_NEAR(map.error[probes[i].y * map.width + probes[i].x], at_probes[i], 2 * kEven) << i;
}

TEST(Flip, a_picture_does_not_differ_from_itself) {
  const FlipMap map = flip(busy(), busy(), kWidth, kHeight);
  EXPECT_EQ(map.mean, 0);
  EXPECT_EQ(map.error, std::vector<float>(kWidth * kHeight, 0.0f));
}

TEST(Flip, is_symmetric) {
  EXPECT_EQ(flip(spoilt(), busy(), kWidth, kHeight).error, flip(busy(), spoilt(), kWidth, kHeight).error);
}

TEST(Flip, white_on_black_follows_from_lightness_alone) {
  // Even pictures have no features, and blur changes nothing. HyAB of white and black is L* = 100.
  const double difference = std::pow(100, 0.7), largest = std::pow(kGreenToBlue, 0.7), knee = 0.4 * largest;
  const double expected = 0.95 + 0.05 * (difference - knee) / (largest - knee);
  EXPECT_NEAR(flip_of_colours(glm::vec3(0), glm::vec3(1)), expected, kEven);
  EXPECT_NEAR(flip_of_colours(glm::vec3(1), glm::vec3(0)), expected, kEven);
}

TEST(Flip, greys_follow_from_the_cube_root_of_luminance) {
  const auto lightness = [](double shown) { return 116 * std::cbrt(std::pow((shown + 0.055) / 1.055, 2.4)) - 16; };
  const double expected = std::pow((lightness(0.6) - lightness(0.5)) / kGreenToBlue, 0.7) * 0.95 / 0.4;
  EXPECT_NEAR(flip_of_colours(glm::vec3(0.5f), glm::vec3(0.6f)), expected, kEven);
}

TEST(Flip, green_to_blue_is_the_largest_difference) {
  EXPECT_NEAR(flip_of_colours({0, 1, 0}, {0, 0, 1}), 1, 1e-6);
}

TEST(Flip, colour_pairs_agree_with_the_authors_program) {
  EXPECT_NEAR(flip_of_colours({0, 0, 0}, {1, 1, 1}), 0.9673882, kEven);
  EXPECT_NEAR(flip_of_colours({1, 0, 0}, {0, 1, 0}), 0.9866648, kEven);
  EXPECT_NEAR(flip_of_colours({0.5, 0.5, 0.5}, {0.6, 0.6, 0.6}), 0.2850629, kEven);
  EXPECT_NEAR(flip_of_colours({0.2, 0.4, 0.6}, {0.25, 0.4, 0.55}), 0.1333695, kEven);
}

TEST(Flip, a_busy_picture_agrees_with_the_authors_program) {
  expect_map(flip(spoilt(), busy(), kWidth, kHeight), 0.3315119,
             {0.000350f, 0.851014f, 0.462141f, 0.438982f, 0.271414f, 0.334902f});
}

TEST(Flip, a_shifted_edge_agrees_with_the_authors_program_at_two_distances) {
  Pixels reference(32 * 32, glm::vec3(0)), test = reference;
  for (int y = 0; y < 32; ++y)
    for (int x = 16; x < 32; ++x) {
      reference[y * 32 + x] = glm::vec3(1);
      if (x >= 18) test[y * 32 + x] = glm::vec3(1);
    }
  const auto expect_row = [&](float ppd, double mean, const std::vector<float>& row) {
    const FlipMap map = flip(test, reference, 32, 32, {ppd});
    EXPECT_NEAR(map.mean, mean, kEven);
    for (int x = 12; x < 22; ++x) EXPECT_NEAR(map.error[16 * 32 + x], row[x - 12], kEven) << x;
  };
  expect_row(
      67.02064514f, 0.1667972,
      {0.121793f, 0.460152f, 0.812341f, 0.975001f, 0.970655f, 0.808198f, 0.589271f, 0.372938f, 0.165896f, 0.037992f});
  expect_row(30, 0.1166740, {0, 0, 0.138444f, 0.922290f, 0.986243f, 0.981403f, 0.649815f, 0.055375f, 0, 0});
}

/// 1e-3 + 20 v^3, and the same times something between 0.75 and 1.25.
Pixels radiance() {
  Pixels pixels = busy();
  for (glm::vec3& pixel : pixels) pixel = 1e-3f + pixel * pixel * pixel * 20.0f;
  return pixels;
}
Pixels other_radiance() {
  Pixels pixels = radiance();
  const Pixels factor = spoilt();
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] *= 1.0f + 0.5f * (factor[i] - 0.5f);
  return pixels;
}

TEST(HdrFlip, chooses_the_exposures_of_the_authors_program) {
  const FlipExposures exposures = flip_exposures(radiance());
  EXPECT_NEAR(exposures.start, -3.1311140, 1e-5);  // rounding of log2 and of luminance in float
  EXPECT_NEAR(exposures.stop, -0.7317943, 1e-5);
  EXPECT_EQ(exposures.count, 3);
  EXPECT_NEAR(flip_exposures(even(glm::vec3(1))).start, 1.0832973, 1e-5);
}

TEST(HdrFlip, a_busy_picture_agrees_with_the_authors_program) {
  expect_map(hdr_flip(other_radiance(), radiance(), kWidth, kHeight), 0.0875490,
             {0.063626f, 0.125306f, 0.070176f, 0.095978f, 0.048437f, 0.090612f});
  EXPECT_NEAR(hdr_flip(even(glm::vec3(2)), even(glm::vec3(1)), 8, 6).mean, 0.1448331, kEven);
  EXPECT_EQ(hdr_flip(radiance(), radiance(), kWidth, kHeight).mean, 0);
}

TEST(HdrFlip, does_not_depend_on_the_unit_of_radiance) {
  Pixels a = other_radiance(), b = radiance();
  const double expected = hdr_flip(a, b, kWidth, kHeight).mean;
  for (glm::vec3& pixel : a) pixel /= 1048576.0f;
  for (glm::vec3& pixel : b) pixel /= 1048576.0f;
  EXPECT_NEAR(hdr_flip(a, b, kWidth, kHeight).mean, expected, kProgram);
}

TEST(HdrFlip, a_picture_that_is_mostly_black_is_exposed_for_what_is_not) {
  Pixels few(1000, glm::vec3(0));
  for (int i = 0; i < 99; ++i) few[i] = glm::vec3(float(1 << (i % 3)));  // 1, 2, 4: median 2, brightest 4
  const FlipExposures exposures = flip_exposures(few);
  EXPECT_NEAR(exposures.stop - exposures.start, 1, 1e-6);
  EXPECT_EQ(exposures.count, 2);
  few[0] = glm::vec3(1e30f);
  EXPECT_NEAR(flip_exposures(few).stop - flip_exposures(few).start, 23, 1e-5);
  EXPECT_EQ(hdr_flip(even(glm::vec3(0)), even(glm::vec3(0)), 8, 6).mean, 0);
}

TEST(HdrFlip, nan_and_infinity_give_a_number_all_the_same) {
  Pixels a = radiance();
  a[3] = glm::vec3(std::nanf(""));
  a[500] = glm::vec3(std::numeric_limits<float>::infinity());
  const FlipMap map = hdr_flip(a, radiance(), kWidth, kHeight);
  EXPECT_GT(map.mean, 0);
  EXPECT_LT(map.mean, 1);
  EXPECT_TRUE(std::isfinite(hdr_flip(radiance(), a, kWidth, kHeight).mean));
  EXPECT_TRUE(std::isfinite(flip(a, radiance(), kWidth, kHeight).mean));
}

TEST(Flip, pictures_of_another_size_are_refused) {
  EXPECT_THROW(flip(even(glm::vec3(0), 47), even(glm::vec3(0)), 8, 6), std::invalid_argument);
  EXPECT_THROW(hdr_flip({}, {}, 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
