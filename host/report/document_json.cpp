// SPDX-License-Identifier: Apache-2.0
// A Document as JSON.
#include <cmath>

#include "host/report/document.h"
#include "host/report/json_parts.h"

namespace turbid {
namespace {

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(number_text(value, 0));
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

struct CellJson {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(double value) const { return number(value); }
  Json operator()(const auto& other) const { return other; }
};

Json axis_json(const Axis& axis) {
  Json json{{"label", axis.label}, {"unit", axis.unit}, {"log", axis.log}};
  if (axis.range) json["range"] = {number(axis.range->first), number(axis.range->second)};
  return json;
}

/// What every titled part begins with.
Json head(const char* kind, const auto& part) {
  return {{"kind", kind}, {"id", part.id}, {"title", part.title}, {"caption", part.caption}};
}

struct PartJson {
  Json operator()(const Paragraph& part) const { return {{"kind", "paragraph"}, {"text", part.text}}; }
  Json operator()(const Code& part) const { return {{"kind", "code"}, {"title", part.title}, {"text", part.text}}; }

  Json operator()(const Table& table) const {
    Json json = head("table", table);
    json["columns"] = Json::array();
    for (const Column& column : table.columns)
      json["columns"].push_back({{"name", column.name}, {"unit", column.unit}});
    json["rows"] = Json::array();
    const bool states = table.has_states();
    if (states) json["states"] = Json::array();
    for (const Row& row : table.rows) {
      Json cells = Json::array();
      for (const Cell& cell : row.cells) cells.push_back(std::visit(CellJson{}, cell));
      json["rows"].push_back(cells);
      if (states) json["states"].push_back(state_word(row.state));
    }
    return json;
  }

  Json operator()(const Plot& plot) const {
    Json json = head("plot", plot);
    json["x"] = axis_json(plot.x);
    json["y"] = axis_json(plot.y);
    json["series"] = Json::array();
    for (const Series& one : plot.series) {
      Json part{{"name", one.name}, {"x", numbers(one.x)}, {"y", numbers(one.y)}};
      if (!one.y_low.empty()) part["y_low"] = numbers(one.y_low);
      if (!one.y_high.empty()) part["y_high"] = numbers(one.y_high);
      if (!one.point_labels.empty()) part["point_labels"] = one.point_labels;
      json["series"].push_back(part);
    }
    json["reference_slopes"] = Json::array();
    for (const ReferenceSlope& slope : plot.slopes)
      json["reference_slopes"].push_back({{"order", number(slope.order)}, {"label", slope.label}});
    json["lines"] = Json::array();
    for (const MarkerLine& one : plot.lines)
      json["lines"].push_back({{"axis", one.vertical ? "x" : "y"}, {"at", number(one.at)}, {"label", one.label}});
    return json;
  }

  Json operator()(const BarChart& chart) const {
    Json json = head("bars", chart);
    json["value"] = axis_json(chart.value);
    json["groups"] = chart.groups;
    json["series"] = Json::array();
    for (const BarSeries& one : chart.series) {
      Json part{{"name", one.name}, {"values", numbers(one.values)}};
      if (!one.low.empty()) part["low"] = numbers(one.low);
      if (!one.high.empty()) part["high"] = numbers(one.high);
      json["series"].push_back(part);
    }
    return json;
  }

  Json operator()(const Timeline& timeline) const {
    Json json = head("timeline", timeline);
    json["unit"] = timeline.unit;
    json["tracks"] = Json::array();
    for (const Track& track : timeline.tracks) {
      Json intervals = Json::array();
      for (const Interval& one : track.intervals)
        intervals.push_back({{"name", one.name}, {"begin", number(one.begin)}, {"end", number(one.end)}});
      json["tracks"].push_back({{"name", track.name}, {"intervals", intervals}});
    }
    return json;
  }

  Json operator()(const Pictures& row) const {
    Json json = head("pictures", row);
    json["pictures"] = Json::array();
    for (const Picture& one : row.pictures)
      json["pictures"].push_back(
          {{"title", one.title}, {"caption", one.caption}, {"width", one.width}, {"height", one.height}});
    return json;
  }
};

}  // namespace

std::string document_json(const Document& report) {
  Json json{{"format", "turbid document 1"}, {"title", report.title}, {"summary", report.summary}};
  const Verdict checks = verdict(report);
  if (checks.passed + checks.failed > 0) json["checks"] = {{"passed", checks.passed}, {"failed", checks.failed}};
  json["context"] = Json::object();
  for (const auto& [name, value] : report.context) json["context"][name] = value;
  json["sections"] = Json::array();
  for (const Section& section : report.sections) {
    Json parts = Json::array();
    for (const Part& part : section.parts) parts.push_back(std::visit(PartJson{}, part));
    json["sections"].push_back({{"title", section.title}, {"parts", parts}});
  }
  return document(json);
}

}  // namespace turbid
