// SPDX-License-Identifier: Apache-2.0
// Every case of `turbid verify` as a test of its own, and what judges them.
#include <gtest/gtest.h>

#include <cmath>

#include "host/report/verify_report.h"
#include "tests/support/test_media.h"

namespace turbid {
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}
namespace {

class KnownAnswer : public testing::TestWithParam<Case> {};

TEST_P(KnownAnswer, is_found) {
  Progress progress(Verbosity::quiet);
  CaseContext context{test::session(), progress, false};
  const CaseResult result = GetParam().run(context);
  const std::string text = verified_case_text({&GetParam(), result});
  EXPECT_TRUE(result.passed()) << text;
  EXPECT_FALSE(result.checks.empty() && result.series.empty());
  EXPECT_LT(result.energy_imbalance, 1e-5);
  std::printf("%s", text.c_str());
}

INSTANTIATE_TEST_SUITE_P(All, KnownAnswer, testing::ValuesIn(cases()), [](const auto& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Cases, have_names_of_their_own_and_say_where_their_answers_come_from) {
  for (const Case& c : cases()) {
    EXPECT_EQ(find_case(c.name), &c) << c.name;
    EXPECT_FALSE(c.equation.empty() || c.source.empty() || c.title.empty()) << c.name;
  }
  EXPECT_EQ(find_case("no such case"), nullptr);
  EXPECT_EQ(find_case("0"), nullptr);
}

TEST(Cases, fail_when_a_value_lies_outside_its_tolerance_or_is_none) {
  CaseResult result;
  result.relative("share", 2, 2.02, 0.0101, "");
  result.absolute("angle", 0, 0.1, 0.11, "");
  result.within("ratio", 0.9, 1.05, 1.05, "");
  EXPECT_TRUE(result.passed());
  const auto fails = [](auto add) {
    CaseResult one;
    add(one);
    return !one.passed();
  };
  EXPECT_TRUE(fails([](CaseResult& r) { r.relative("share", 2, 2.02, 0.0099, ""); }));
  EXPECT_TRUE(fails([](CaseResult& r) { r.absolute("angle", 0, std::nan(""), 1, ""); }));
  EXPECT_TRUE(fails([](CaseResult& r) { r.at_most("error", 1e-3, 1.1e-3, ""); }));
  EXPECT_TRUE(fails([](CaseResult& r) { r.at_least("photons", 5, 4, ""); }));
  EXPECT_TRUE(fails([](CaseResult& r) { r.within("ratio", 0.9, 1.05, 0.89, ""); }));
  EXPECT_TRUE(fails([](CaseResult& r) { r.absolute("Monte Carlo", 1, 1.31, 0, "", "1", 0.1); }));
  EXPECT_FALSE(fails([](CaseResult& r) { r.absolute("Monte Carlo", 1, 1.29, 0, "", "1", 0.1); }));
  CaseResult order;
  order.series.push_back({"voxel_size", "mm", "L2", {{1, 1}, {0.5, 0.25}}, {}, 1.9, 2.1});
  EXPECT_FALSE(order.passed());  // no order was found
  order.series[0].fit = fitted_order(order.series[0].levels);
  EXPECT_TRUE(order.passed());
  order.series[0].order_low = 2.05;
  EXPECT_FALSE(order.passed());
}

}  // namespace
}  // namespace turbid
