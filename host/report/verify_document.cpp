// SPDX-License-Identifier: Apache-2.0
// The report of `turbid verify -o`.
#include <cmath>

#include "host/report/report_context.h"
#include "host/report/text_line.h"
#include "host/report/verify_report.h"

namespace turbid {
namespace {

RowState state_of(bool passed) {
  return passed ? RowState::pass : RowState::fail;
}

std::string tolerance_text(const Check& c) {
  std::string more = c.standard_error > 0 ? line(" and 3 x %.2g", c.standard_error) : "";
  switch (c.kind) {
    case CheckKind::relative:
      return line("%.3g %%", 100 * c.tolerance) + more;
    case CheckKind::absolute:
      return line("%.3g", c.tolerance) + more;
    case CheckKind::at_most:
      return "at most";
    case CheckKind::at_least:
      return "at least";
    case CheckKind::within:
      return line("up to %.4g", c.upper);
  }
  return "";
}

Table overview(const VerifyReport& r) {
  Table table{.id = "cases",
              .title = "All cases",
              .columns = {{.name = "case"},
                          {.name = "name"},
                          {.name = "what"},
                          {.name = "checks"},
                          {.name = "orders"},
                          {.name = "time", .unit = "s", .digits = 2}}};
  for (const VerifiedCase& c : r.cases) {
    std::string orders;
    for (const ErrorSeries& s : c.result.series)
      if (s.fit) orders += (orders.empty() ? "" : ", ") + line("%.2f", s.fit->order);
    table.rows.push_back({{c.of->number > 0 ? std::to_string(c.of->number) : "", c.of->name, c.of->title,
                           static_cast<std::int64_t>(c.result.checks.size()), orders, c.result.seconds},
                          state_of(c.result.passed())});
  }
  return table;
}

Table checks_table(const VerifiedCase& c) {
  Table table{.id = "checks_" + identifier(c.of->name),
              .columns = {{.name = "quantity"},
                          {.name = "unit"},
                          {.name = "expected", .digits = 6},
                          {.name = "got", .digits = 6},
                          {.name = "tolerance"},
                          {.name = "reason"}}};
  for (const Check& check : c.result.checks)
    table.rows.push_back({{check.quantity, check.unit, check.expected, check.got, tolerance_text(check), check.reason},
                          state_of(check.passed())});
  return table;
}

Table orders_table(const VerifiedCase& c) {
  Table table{.id = "orders_" + identifier(c.of->name),
              .columns = {{.name = "refined"},
                          {.name = "error"},
                          {.name = "order", .digits = 2, .style = NumberStyle::fixed},
                          {.name = "95 % from", .digits = 2, .style = NumberStyle::fixed},
                          {.name = "to", .digits = 2, .style = NumberStyle::fixed},
                          {.name = "expected"}}};
  for (const ErrorSeries& s : c.result.series) {
    Row row{{s.parameter, s.error_name, {}, {}, {}, line("%.2f to %.2f", s.order_low, s.order_high)},
            state_of(s.passed())};
    if (s.fit) row.cells[2] = s.fit->order, row.cells[3] = s.fit->low, row.cells[4] = s.fit->high;
    table.rows.push_back(row);
  }
  return table;
}

Plot orders_plot(const VerifiedCase& c) {
  const ErrorSeries& first = c.result.series.front();
  Plot plot{.id = "plot_" + identifier(c.of->name),
            .title = "Error against " + first.parameter.substr(0, first.parameter.find(',')),
            .x = {.label = "h", .unit = first.unit, .log = true},
            .y = {.label = "error", .log = true}};
  for (const ErrorSeries& s : c.result.series) {
    if (s.unit != first.unit) continue;  // of another axis: in the table alone
    Series line_of{.name = s.parameter + ": " + s.error_name};
    for (const Level& level : s.levels) {
      line_of.x.push_back(level.h);
      line_of.y.push_back(level.error);
    }
    plot.slopes.push_back({.order = std::round(0.5 * (s.order_low + s.order_high)), .series = plot.series.size()});
    plot.series.push_back(line_of);
  }
  return plot;
}

}  // namespace

Document verify_document(const VerifyReport& r, const cl::DeviceInfo& device) {
  Document document{.title = "Turbid against known answers",
                    .summary = r.verdict() + ".",
                    .context = report_context(r.command_line, &device)};
  document.sections.push_back({"Overview", {overview(r)}});
  for (const VerifiedCase& c : r.cases) {
    const std::string number = c.of->number > 0 ? line("%d. ", c.of->number) : "";
    Section section{number + c.of->title, {Paragraph{c.of->equation}, Paragraph{"From: " + c.of->source}}};
    if (!c.result.checks.empty()) section.parts.push_back(checks_table(c));
    if (!c.result.series.empty()) {
      section.parts.push_back(orders_table(c));
      section.parts.push_back(orders_plot(c));
    }
    for (const std::string& note : c.result.notes) section.parts.push_back(Paragraph{note});
    if (c.result.energy_imbalance > 0)
      section.parts.push_back(Paragraph{line("The energy balance closes to %.1e.", c.result.energy_imbalance)});
    document.sections.push_back(section);
  }
  return document;
}

}  // namespace turbid
