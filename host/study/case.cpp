// SPDX-License-Identifier: Apache-2.0
// Judging, running and finding cases.
#include "host/study/case.h"

#include <algorithm>
#include <cmath>

#include "host/study/case_lists.h"

namespace turbid {

bool Check::passed() const {
  switch (kind) {
    case CheckKind::relative:
      return std::abs(got - expected) <= tolerance * std::abs(expected) + 3 * standard_error;
    case CheckKind::absolute:
      return std::abs(got - expected) <= tolerance + 3 * standard_error;
    case CheckKind::at_most:
      return got <= expected;
    case CheckKind::at_least:
      return got >= expected;
    case CheckKind::within:
      return expected <= got && got <= upper;
  }
  return false;
}

bool ErrorSeries::passed() const {
  return fit && fit->order >= order_low && fit->order <= order_high;
}

bool CaseResult::passed() const {
  return std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.passed(); }) &&
         std::all_of(series.begin(), series.end(), [](const ErrorSeries& s) { return s.passed(); });
}

void CaseResult::relative(const std::string& quantity, double expected, double got, double tolerance,
                          const std::string& reason, const std::string& unit, double standard_error) {
  checks.push_back({quantity, unit, CheckKind::relative, expected, got, tolerance, 0, standard_error, reason});
}
void CaseResult::absolute(const std::string& quantity, double expected, double got, double tolerance,
                          const std::string& reason, const std::string& unit, double standard_error) {
  checks.push_back({quantity, unit, CheckKind::absolute, expected, got, tolerance, 0, standard_error, reason});
}
void CaseResult::at_most(const std::string& quantity, double bound, double got, const std::string& reason,
                         const std::string& unit) {
  checks.push_back({quantity, unit, CheckKind::at_most, bound, got, 0, 0, 0, reason});
}
void CaseResult::at_least(const std::string& quantity, double bound, double got, const std::string& reason,
                          const std::string& unit) {
  checks.push_back({quantity, unit, CheckKind::at_least, bound, got, 0, 0, 0, reason});
}
void CaseResult::within(const std::string& quantity, double low, double high, double got, const std::string& reason,
                        const std::string& unit) {
  checks.push_back({quantity, unit, CheckKind::within, low, got, 0, high, 0, reason});
}

double Refinement::error(const RefinedLevel& level) const {
  return judged == Norm::l1 ? level.l1 : judged == Norm::l2 ? level.l2 : level.linf;
}

namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

void run_refinement(const Refinement& refinement, CaseContext& context, CaseResult& result) {
  std::vector<double> levels = refinement.levels;
  if (context.quick && levels.size() > 2) levels.pop_back();
  const std::string variant = refinement.variant.empty() ? "" : ", " + refinement.variant;
  ErrorSeries series{refinement.parameter + variant, refinement.unit,      refinement.error_name(), {}, {},
                     refinement.order_low,           refinement.order_high};
  for (const double level : levels) {
    const RefinedLevel found = refinement.run(context, level);
    series.levels.push_back({found.h, refinement.error(found)});
    result.note_imbalance(found.energy_imbalance);
    for (const Refinement::Limit& limit : refinement.limits) {
      if (limit.level != level) continue;
      const std::string where = " at " + refinement.parameter + " " + number(level) + " " + refinement.unit + variant;
      if (refinement.quantity.empty())
        result.at_most(refinement.error_name() + where, limit.tolerance, refinement.error(found), limit.reason);
      else
        result.relative(refinement.quantity + where, refinement.exact, found.value, limit.tolerance, limit.reason, "1",
                        found.standard_error);
    }
  }
  if (refinement.order == 0) return;
  series.fit = fitted_order(series.levels);
  result.series.push_back(series);
}

}  // namespace

CaseResult Case::run(CaseContext& context) const {
  CaseResult result;
  const double started = wall_time();
  for (const Refinement& refinement : refinements) run_refinement(refinement, context, result);
  if (check) check(context, result);
  result.seconds = wall_time() - started;
  return result;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> list;
    for (const auto make :
         {study::lattice_cases, study::wave_cases, study::boundary_cases, study::beam_cases, study::path_cases,
          study::surface_cases, study::transport_cases, study::view_cases, study::stopping_cases,
          study::hard_media_cases, study::hard_contrast_cases, study::hard_void_cases, study::hard_index_cases,
          study::hard_ray_cases, study::hard_shape_cases})
      for (Case& one : make()) list.push_back(std::move(one));
    const auto rank = [](const Case& c) { return c.number > 0 ? c.number : std::numeric_limits<int>::max(); };
    std::stable_sort(list.begin(), list.end(), [&](const Case& a, const Case& b) { return rank(a) < rank(b); });
    return list;
  }();
  return all;
}

const Case* find_case(const std::string& name_or_number) {
  for (const Case& one : cases())
    if (one.name == name_or_number || (one.number > 0 && std::to_string(one.number) == name_or_number)) return &one;
  return nullptr;
}

}  // namespace turbid
