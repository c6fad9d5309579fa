// SPDX-License-Identifier: Apache-2.0
// See bench_report.h.
#include "host/report/bench_report.h"

#include <cmath>
#include <stdexcept>

#include "host/report/json_parts.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

std::string title_of(const Quantity& quantity) { return quantity.name; }

std::string axis_unit(const Experiment& e, const std::vector<int>& columns) {
  const std::string unit = e.columns[columns.front()].unit;
  for (const int column : columns)
    if (e.columns[column].unit != unit) return {};
  return unit;
}

Cell number(double value) {
  if (std::isnan(value)) return {};
  if (std::abs(value) < 1e15 && value == std::floor(value)) return static_cast<std::int64_t>(value);
  return value;
}

Table table_of(const Experiment& e) {
  Table table{.id = e.id, .title = e.title};
  if (!e.labels.empty()) table.columns.push_back({.name = "what"});
  for (const Quantity& quantity : e.columns) table.columns.push_back({.name = quantity.name, .unit = quantity.unit});
  for (std::size_t i = 0; i < e.rows.size(); ++i) {
    Row row;
    if (!e.labels.empty()) row.cells.push_back(e.labels[i]);
    for (const double value : e.rows[i]) row.cells.push_back(number(value));
    table.rows.push_back(row);
  }
  return table;
}

Plot plot_of(const Experiment& e) {
  const Quantity& x = e.columns[e.plot_x];
  const std::string y = e.plot_y.size() == 1 ? e.columns[e.plot_y[0]].name : axis_unit(e, e.plot_y) == "ms" ? "time" : "value";
  Plot plot{.id = e.id + "_plot", .title = e.title,
            .x = {.label = x.name, .unit = x.unit, .log = e.log_x},
            .y = {.label = y, .unit = axis_unit(e, e.plot_y), .log = e.log_y}};
  for (const int column : e.plot_y) {
    Series series{.name = title_of(e.columns[column])};
    for (const auto& row : e.rows) {
      series.x.push_back(row[e.plot_x]);
      series.y.push_back(row[column]);
    }
    plot.series.push_back(series);
  }
  return plot;
}

}  // namespace

Section goal_section(const std::vector<Goal>& goals) {
  Table table{.id = "goals", .title = "Goals",
              .caption = "Each ratio is of medians of warmed-up, interleaved runs of this very command.",
              .columns = {{.name = "goal"}, {.name = "measured"}, {.name = "aim"}, {.name = "ours"}, {.name = "against"},
                          {.name = "error"}}};
  for (const Goal& goal : goals) {
    table.rows.push_back({{goal.name, goal.ratio, line("%s %.3g", goal.at_least ? ">=" : "<=", goal.aim), goal.ours, goal.against,
                           goal.error},
                          goal.passed() ? RowState::pass : RowState::fail});
  }
  return {.title = "Goals", .parts = {table}};
}

Section experiment_section(const Experiment& e) {
  Section section{.title = e.title, .parts = {}};
  if (!e.paper.empty()) section.parts.push_back(Paragraph{"The paper: " + e.paper});
  if (!e.method.empty()) section.parts.push_back(Paragraph{"Here: " + e.method});
  section.parts.push_back(table_of(e));
  if (e.plot_x >= 0) section.parts.push_back(plot_of(e));
  if (!e.pictures.empty()) {
    Pictures row{.id = e.id + "_pictures", .title = {}};
    const float exposure = automatic_exposure(e.pictures.front().second);
    for (const auto& [title, image] : e.pictures)
      row.pictures.push_back({.title = title, .width = image.width, .height = image.height, .png = png_preview_bytes(image, exposure)});
    section.parts.push_back(row);
  }
  if (!e.found.empty()) section.parts.push_back(Paragraph{"Found: " + e.found});
  return section;
}

std::string load_warning(double load, int cores) {
  // Half a core of others' work on the average of the last minute.
  if (load < 0.5) return {};
  return line("the machine was busy when this began: load average %.2f on %d cores; figures are less certain", load, cores);
}

double frame_seconds_of_profile(const std::string& json) {
  const Json document = Json::parse(json, nullptr, false);
  if (document.is_discarded()) throw std::runtime_error("a profile that is no JSON");
  for (const Json& section : document.value("sections", Json::array())) {
    for (const Json& part : section.value("parts", Json::array())) {
      if (part.value("id", "") != "frame") continue;
      for (const Json& row : part.at("rows"))
        if (row.at(0) == "frame") return 1e-3 * row.at(1).get<double>();
    }
  }
  throw std::runtime_error("a profile without its frame");
}

}  // namespace turbid
