// SPDX-License-Identifier: Apache-2.0
// See verify_report.h.
#include "host/report/verify_report.h"

#include <algorithm>
#include <cmath>

#include "host/report/json_parts.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

std::string of_unit(const std::string& unit) {
  return unit.empty() || unit == "1" ? "" : " " + unit;
}

std::string expectation(const Check& c) {
  const std::string unit = of_unit(c.unit);
  switch (c.kind) {
    case CheckKind::relative:
      return line("expected %.6g%s to %.2g %%", c.expected, unit.c_str(), 100 * c.tolerance);
    case CheckKind::absolute:
      return line("expected %.6g%s +- %.2g", c.expected, unit.c_str(), c.tolerance);
    case CheckKind::at_most:
      return line("expected up to %.3g%s", c.expected, unit.c_str());
    case CheckKind::at_least:
      return line("expected at least %.3g%s", c.expected, unit.c_str());
    case CheckKind::within:
      return line("expected %.4g to %.4g%s", c.expected, c.upper, unit.c_str());
  }
  return "";
}

const char* kind_name(CheckKind kind) {
  switch (kind) {
    case CheckKind::relative:
      return "relative";
    case CheckKind::absolute:
      return "absolute";
    case CheckKind::at_most:
      return "at most";
    case CheckKind::at_least:
      return "at least";
    case CheckKind::within:
      return "within";
  }
  return "";
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json check_json(const Check& c) {
  Json json{
      {"quantity", c.quantity},       {"unit", c.unit},       {"kind", kind_name(c.kind)}, {"expected", c.expected},
      {"got", number_or_null(c.got)}, {"passed", c.passed()}, {"reason", c.reason}};
  if (c.kind == CheckKind::relative || c.kind == CheckKind::absolute) json["tolerance"] = c.tolerance;
  if (c.kind == CheckKind::within) json["upper"] = c.upper;
  if (c.standard_error > 0) json["standard_error"] = c.standard_error;
  return json;
}

Json series_json(const Series& s) {
  Json levels = Json::array();
  for (const Level& level : s.levels) levels.push_back({{"h", level.h}, {"error", number_or_null(level.error)}});
  Json json{{"parameter", s.parameter},
            {"unit", s.unit},
            {"error", s.error_name},
            {"levels", levels},
            {"passed", s.passed()}};
  if (s.fit)
    json["order"] = {{"fitted", s.fit->order},
                     {"low", number_or_null(s.fit->low)},
                     {"high", number_or_null(s.fit->high)},
                     {"expected", {s.order_low, s.order_high}}};
  return json;
}

Json head_json(const Case& c) {
  Json json{{"name", c.name}, {"title", c.title}, {"equation", c.equation}, {"source", c.source}, {"hard", c.hard}};
  if (c.number > 0) json["number"] = c.number;
  return json;
}

}  // namespace

int VerifyReport::failed() const {
  return static_cast<int>(std::count_if(cases.begin(), cases.end(), [](const auto& c) { return !c.result.passed(); }));
}

std::string VerifyReport::verdict() const {
  if (failed() == 0) return line("%zu cases passed", cases.size());
  std::string names;
  for (const VerifiedCase& c : cases)
    if (!c.result.passed()) names += (names.empty() ? "" : ", ") + c.of->name;
  return line("%d of %zu cases failed: ", failed(), cases.size()) + names;
}

std::string verified_case_text(const VerifiedCase& c) {
  const std::string number = c.of->number > 0 ? std::to_string(c.of->number) : "-";
  std::string text = line("%2s %s: ", number.c_str(), c.of->name.c_str()) + c.of->title + "\n   " + c.of->equation +
                     "\n   (" + c.of->source + ")\n";
  for (const Check& check : c.result.checks) {
    text += line("   %s  %-44s got %-12.6g ", check.passed() ? "pass" : "FAIL", check.quantity.c_str(), check.got);
    text += expectation(check);
    if (check.standard_error > 0) text += line(" and 3 x %.2g", check.standard_error);
    text += ": " + check.reason + "\n";
  }
  for (const Series& s : c.result.series) {
    text += line("   %s  order in %s of %s: ", s.passed() ? "pass" : "FAIL", s.parameter.c_str(), s.error_name.c_str());
    if (s.fit) text += line("%.2f (%.2f to %.2f)", s.fit->order, s.fit->low, s.fit->high);
    text += line(", expected %.2f to %.2f; h [%s]", s.order_low, s.order_high, s.unit.c_str());
    for (const Level& level : s.levels) text += line(" %.4g: %.2e", level.h, level.error);
    text += "\n";
  }
  for (const std::string& note : c.result.notes) text += "   " + note + "\n";
  if (c.result.energy_imbalance > 0) text += line("   energy balance closes to %.1e\n", c.result.energy_imbalance);
  return text + line("   %s in %.1f s\n", c.result.passed() ? "passed" : "FAILED", c.result.seconds);
}

std::string case_list_text(const std::vector<Case>& cases) {
  std::string text;
  for (const Case& c : cases)
    text += line("%3s  %-14s ", c.number > 0 ? std::to_string(c.number).c_str() : "", c.name.c_str()) + c.title +
            (c.hard ? " (hard)" : "") + "\n";
  return text;
}

std::string case_list_json(const std::vector<Case>& cases) {
  Json list = Json::array();
  for (const Case& c : cases) list.push_back(head_json(c));
  return document(Json{{"format", "turbid cases 1"}, {"cases", list}});
}

std::string verify_json(const VerifyReport& r) {
  Json list = Json::array();
  for (const VerifiedCase& c : r.cases) {
    Json json = head_json(*c.of), checks = Json::array(), series = Json::array();
    for (const Check& check : c.result.checks) checks.push_back(check_json(check));
    for (const Series& s : c.result.series) series.push_back(series_json(s));
    json["passed"] = c.result.passed();
    json["checks"] = checks;
    json["series"] = series;
    json["notes"] = c.result.notes;
    json["energy_imbalance"] = c.result.energy_imbalance;
    json["seconds"] = c.result.seconds;
    list.push_back(json);
  }
  return document(Json{{"format", "turbid verify 1"},
                       {"version", TURBID_VERSION},
                       {"command_line", r.command_line},
                       {"device", r.device},
                       {"quick", r.quick},
                       {"passed", r.failed() == 0},
                       {"cases", list}});
}

}  // namespace turbid
