// SPDX-License-Identifier: Apache-2.0
// See compare_report.h.
#include "host/report/compare_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/report/json_parts.h"

namespace turbid {
namespace {

std::string format(const char* how, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, how, values...);
  return text;
}

std::string limit(const CompareReport& r) {
  return format(r.measure.larger_is_better ? "at least %g" : "up to %g", r.tolerance);
}

/// The part that speaks most against being alike.
const ComparedPart& worst(const CompareReport& r) {
  return *std::max_element(r.parts.begin(), r.parts.end(), [&](const ComparedPart& x, const ComparedPart& y) {
    if ((x.errors.not_finite > 0) != (y.errors.not_finite > 0)) return y.errors.not_finite > 0;
    const double of_x = r.measure.of(x.errors), of_y = r.measure.of(y.errors);
    return r.measure.larger_is_better ? of_x > of_y : of_x < of_y;
  });
}

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

bool CompareReport::alike(const ComparedPart& part) const {
  return part.errors.not_finite == 0 && measure.within(measure.of(part.errors), tolerance);
}

bool CompareReport::alike() const {
  return std::all_of(parts.begin(), parts.end(), [&](const ComparedPart& part) { return alike(part); });
}

std::string CompareReport::verdict() const {
  const ComparedPart& part = worst(*this);
  const std::string of = kind == "volume" ? " in the grid " + part.name : "";
  const std::string value = format("%s %.4g", measure.name.c_str(), measure.of(part.errors));
  if (alike()) return "alike: " + value + of + ", " + limit(*this) + " is allowed";
  if (part.errors.not_finite > 0)
    return a + ": differs from " + b + ": " + std::to_string(part.errors.not_finite) +
           " pairs of values hold a NaN or an infinity" + of;
  return a + ": differs from " + b + ": " + value + of + ", " + limit(*this) + " is allowed";
}

std::string compare_text(const CompareReport& r) {
  std::size_t width = 4;
  for (const ComparedPart& part : r.parts) width = std::max(width, part.name.size());
  const int w = static_cast<int>(std::min<std::size_t>(width, 40));
  std::string text = "A            " + r.a + "\nB, reference " + r.b + "\n";
  text += format("%-*s %12s", w, r.kind == "volume" ? "grid" : "", "values");
  const auto shown = [&](const Measure& m) { return std::isfinite(m.of(r.parts.front().errors)) || m.name != "flip"; };
  for (const Measure& m : measures())
    if (shown(m)) text += format(" %10s", m.name.c_str());
  text += "\n";
  for (const ComparedPart& part : r.parts) {
    text += format("%-*s %12zu", w, part.name.c_str(), part.errors.values);
    for (const Measure& m : measures())
      if (shown(m)) text += format(" %10.4g", m.of(part.errors));
    if (part.errors.not_finite > 0) text += format("  and %zu not finite", part.errors.not_finite);
    text += r.alike(part) ? "\n" : "  different\n";
  }
  if (!r.difference.empty()) text += "difference   " + r.difference + "\n";
  if (r.alike()) text += r.verdict() + "\n";
  return text;
}

std::string compare_json(const CompareReport& r) {
  Json parts = Json::array();
  for (const ComparedPart& part : r.parts) {
    Json json{{"name", part.name}, {"values", part.errors.values}, {"not_finite", part.errors.not_finite}};
    for (const Measure& m : measures())
      if (m.name != "flip" || part.errors.flip) json[m.name] = number(m.of(part.errors));
    json["epsilon"] = number(part.errors.epsilon);
    json["peak"] = number(part.errors.peak);
    json["alike"] = r.alike(part);
    parts.push_back(json);
  }
  Json json{{"format", "turbid compare 1"},
            {"a", r.a},
            {"b", r.b},
            {"kind", r.kind},
            {"measure", r.measure.name},
            {"tolerance", r.tolerance},
            {"trim", r.trim},
            {"alike", r.alike()},
            {"parts", parts}};
  if (!r.difference.empty()) json["difference"] = r.difference;
  return document(json);
}

}  // namespace turbid
