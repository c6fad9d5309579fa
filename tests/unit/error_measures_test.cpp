// SPDX-License-Identifier: Apache-2.0
// Error measures against values worked out by hand, and errors of volumes whose difference is known.
#include "host/study/error_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/study/volume_errors.h"

namespace turbid {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kRounding = 1e-12;  // sums of a few doubles; the values are exact in float

TEST(ErrorMeasures, agree_with_a_calculation_by_hand) {
  // a - b = 1, -2, 0, 1; |b| sums to 10, b^2 to 42, so mean |b| = 2.5 and epsilon = 0.0625.
  const std::vector<float> b{1, 4, 0, -5}, a{2, 2, 0, -4};
  const ErrorMeasures m = measure_errors(a, b);
  EXPECT_EQ(m.values, 4u);
  EXPECT_EQ(m.not_finite, 0u);
  EXPECT_NEAR(m.mae, 1, kRounding);
  EXPECT_NEAR(m.rmse, std::sqrt(1.5), kRounding);
  EXPECT_EQ(m.linf, 2);
  EXPECT_NEAR(m.rel_l1, 0.4, kRounding);
  EXPECT_NEAR(m.rel_l2, std::sqrt(6.0 / 42), kRounding);
  EXPECT_NEAR(m.epsilon, 0.0625, kRounding);
  EXPECT_NEAR(m.relmse, (1 / 1.0625 + 4 / 16.0625 + 1 / 25.0625) / 4, kRounding);
  EXPECT_EQ(m.peak, 5);
  EXPECT_NEAR(m.psnr, 10 * std::log10(25 / 1.5), kRounding);
  EXPECT_NEAR(measure_errors(a, b, {.peak = 1}).psnr, 10 * std::log10(1 / 1.5), kRounding);
  EXPECT_FALSE(m.flip);
}

TEST(ErrorMeasures, equal_values_have_no_error) {
  const std::vector<float> b{0, 1, -2};
  const ErrorMeasures m = measure_errors(b, b);
  for (const char* name : {"mae", "rmse", "linf", "rel-l1", "rel-l2", "relmse"})
    EXPECT_EQ(find_measure(name)->of(m), 0) << name;
  EXPECT_EQ(m.psnr, kInfinity);
}

TEST(ErrorMeasures, relative_ones_do_not_depend_on_the_unit) {
  const std::vector<float> b{1, 4, 0.5f, 5}, a{2, 2, 0.25f, 4};
  std::vector<float> small_a, small_b;
  for (std::size_t i = 0; i < b.size(); ++i) small_a.push_back(a[i] / 1048576), small_b.push_back(b[i] / 1048576);
  const ErrorMeasures big = measure_errors(a, b), small = measure_errors(small_a, small_b);
  for (const char* name : {"rel-l1", "rel-l2", "relmse", "psnr"})
    EXPECT_NEAR(find_measure(name)->of(small), find_measure(name)->of(big), 1e-10) << name;
  EXPECT_NEAR(small.mae * 1048576, big.mae, kRounding);
}

TEST(ErrorMeasures, a_reference_of_zeros_is_met_exactly_or_missed_infinitely) {
  const std::vector<float> zeros{0, 0}, other{0, 1};
  EXPECT_EQ(measure_errors(zeros, zeros).relmse, 0);
  EXPECT_EQ(measure_errors(zeros, zeros).rel_l2, 0);
  EXPECT_EQ(measure_errors(other, zeros).relmse, kInfinity);
  EXPECT_EQ(measure_errors(other, zeros).rel_l1, kInfinity);
  EXPECT_EQ(measure_errors(other, zeros).psnr, -kInfinity);
}

TEST(ErrorMeasures, values_that_are_not_finite_are_counted_and_left_out) {
  const std::vector<float> a{1, std::nanf(""), 3, kInfinity, 3}, b{1, 2, kInfinity, kInfinity, 2};
  const ErrorMeasures m = measure_errors(a, b);
  EXPECT_EQ(m.values, 2u);
  EXPECT_EQ(m.not_finite, 3u);
  EXPECT_EQ(m.mae, 0.5);
  EXPECT_EQ(measure_errors({}, {}).mae, 0);
}

TEST(ErrorMeasures, trimming_takes_out_the_fireflies_of_relmse_alone) {
  std::vector<float> b(1000, 1.0f), a(1000, 1.1f);
  a[123] = 1000;
  EXPECT_GT(measure_errors(a, b).relmse, 900);
  // The other 999 terms: 0.1^2 / (1 + 0.01); 1.1f is 1.1 to 2e-8.
  EXPECT_NEAR(measure_errors(a, b, {.trim = 0.001}).relmse, 0.01 / 1.01, 1e-8);
  EXPECT_EQ(measure_errors(a, b, {.trim = 0.001}).rmse, measure_errors(a, b).rmse);
}

TEST(ErrorMeasures, are_known_by_name_with_a_direction) {
  EXPECT_EQ(find_measure("nonsense"), nullptr);
  const Measure& psnr = *find_measure("psnr");
  EXPECT_TRUE(psnr.within(50, 40));
  EXPECT_FALSE(psnr.within(30, 40));
  const Measure& relmse = *find_measure("relmse");
  EXPECT_TRUE(relmse.within(0, 0));
  EXPECT_FALSE(relmse.within(2e-3, 1e-3));
  EXPECT_FALSE(relmse.within(std::nan(""), 1e-3));
}

/// A domain [0, 1]^3 of `edge` voxels along each side, without the block at its far corner; fluence = formula(centre).
template <class Formula>
FluenceVolume volume_of(int edge, Formula formula) {
  const GridFrame frame{glm::ivec3(edge), glm::vec3(0), 1.0f / float(edge)};
  const glm::ivec3 last = frame.blocks() - 1;
  FluenceVolume volume{frame, BlockGrid(frame.blocks(), kBlockEdge, [&](glm::ivec3 b) { return b != last; }), {}, {}};
  volume.fluence.resize(3 * volume.colour_stride());
  for (int block = 0; block < volume.blocks.count(); ++block)
    for (int v = 0; v < 512; ++v) {
      const glm::vec3 value = formula(
          frame.centre_of(volume.blocks.coordinates(block) * kBlockEdge + glm::ivec3(v % 8, v / 8 % 8, v / 64)));
      for (int c = 0; c < 3; ++c) volume.fluence[c * volume.colour_stride() + std::size_t(block) * 512 + v] = value[c];
    }
  return volume;
}
glm::vec3 slope(glm::vec3 x) {
  return glm::vec3(1, 2, 4) * (1 + x.x + 2 * x.y + 4 * x.z);
}

TEST(VolumeErrors, a_volume_of_a_formulas_values_has_no_error_against_it) {
  const ErrorMeasures m = volume_errors(volume_of(16, slope), slope);
  EXPECT_EQ(m.values, 3u * 7 * 512);
  EXPECT_EQ(m.linf, 0);
}

TEST(VolumeErrors, one_per_cent_too_much_everywhere_is_one_per_cent_in_both_norms) {
  const ErrorMeasures m = volume_errors(volume_of(16, [](glm::vec3 x) { return 1.01f * slope(x); }), slope);
  EXPECT_NEAR(m.rel_l1, 0.01, 1e-6);  // float rounding of the values
  EXPECT_NEAR(m.rel_l2, 0.01, 1e-6);
}

TEST(VolumeErrors, a_finer_reference_is_averaged_over_each_voxel) {
  // The mean of a linear function over a voxel is its value at the centre.
  const FluenceVolume coarse = volume_of(16, slope);
  const auto inside = [](glm::vec3 x) { return x.z < 0.5f; };  // the missing corner block is smaller in finer volumes
  EXPECT_LT(volume_errors(coarse, volume_of(32, slope), inside).linf, 1e-5);
  EXPECT_LT(volume_errors(coarse, volume_of(48, slope), inside).linf, 1e-5);
  EXPECT_EQ(volume_errors(coarse, coarse).linf, 0);
  EXPECT_EQ(volume_errors(coarse, coarse, inside).values, 3u * 4 * 512);
}

TEST(VolumeErrors, volumes_of_other_domains_or_coarser_references_are_refused) {
  const FluenceVolume fine = volume_of(16, slope);
  EXPECT_THROW(volume_errors(fine, volume_of(24, slope)), std::invalid_argument);
  EXPECT_THROW(volume_errors(volume_of(24, slope), fine), std::invalid_argument);
  FluenceVolume shifted = volume_of(16, slope);
  shifted.frame.origin.x = 0.03f;
  EXPECT_THROW(volume_errors(fine, shifted), std::invalid_argument);
}

}  // namespace
}  // namespace turbid
