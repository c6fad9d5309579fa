// SPDX-License-Identifier: Apache-2.0
// See estimate_report.h.
#include "host/report/estimate_report.h"

#include <algorithm>

#include "host/report/text_line.h"

namespace turbid {
namespace {

Row coverage_row(const TrialGroup& group, const std::string& what, const Coverage& c) {
  const bool kept = c.share >= kLeastCoverage && c.median_ratio <= kLargestMedian;
  return {{group.name, what, static_cast<std::int64_t>(c.trials), 100 * c.share, c.median_ratio, c.largest_ratio,
           c.largest_shortfall, c.farthest},
          !group.judged ? RowState::plain
          : kept        ? RowState::pass
                        : RowState::fail};
}

Table coverage_table(const std::vector<TrialGroup>& groups) {
  Table table{.id = "coverage", .title = "Coverage"};
  table.caption = line(
      "Covered: the true error is at most the estimate; asked for in at least %g %%. Too large: estimate over true "
      "error, of those that stand out of the reference's scatter by two standard deviations; asked for in the median: "
      "at most %g. Shortfall: largest true error over estimate, and where.",
      100 * kLeastCoverage, kLargestMedian);
  table.columns = {{"set"},       {"of the"}, {"runs"}, {"covered", "%"}, {"too large, median"}, {"too large, at most"},
                   {"shortfall"}, {"where"}};
  for (const TrialGroup& group : groups) {
    table.rows.push_back(coverage_row(group, "fluence", fluence_coverage(group.trials)));
    table.rows.push_back(coverage_row(group, "picture", image_coverage(group.trials)));
  }
  return table;
}

Plot scatter_plot(const std::vector<TrialGroup>& groups, const std::string& what, Judged EstimateTrial::*of) {
  Plot plot{.id = what + "_scatter", .title = "Estimate over true error: " + what};
  plot.caption =
      "Above the heavy line the estimate covers the true error; beyond the dashed one it is over five times as large.";
  plot.x = {.label = "true error", .log = true};
  plot.y = {.label = "estimate", .log = true};
  double low = 1, high = 1e-3;
  for (const TrialGroup& group : groups) {
    Series series{.name = group.name, .line = false};
    for (const EstimateTrial& trial : group.trials) {
      const Judged& v = trial.*of;
      if (!v.resolved) continue;
      series.x.push_back(v.error);
      series.y.push_back(v.estimate);
      low = std::min(low, v.error);
      high = std::max(high, v.error);
    }
    if (!series.x.empty()) plot.series.push_back(series);
  }
  plot.series.push_back({.name = "equal", .x = {low, high}, .y = {low, high}, .markers = false, .highlighted = true});
  plot.series.push_back(
      {.name = "five times", .x = {low, high}, .y = {5 * low, 5 * high}, .markers = false, .dashed = true});
  return plot;
}

Table trial_table(const TrialGroup& group) {
  Table table{.id = "runs_" + identifier(group.name), .title = group.name};
  table.columns = {{"run"},   {"fluence error"}, {"estimate"},     {"grid"}, {"steps + rays"},
                   {"model"}, {"picture error"}, {"estimate"},     {"grid"}, {"steps + rays"},
                   {"model"}, {"run", "s"},      {"estimate", "s"}};
  for (const EstimateTrial& t : group.trials) {
    const ErrorParts &f = t.fluence_parts, &p = t.image_parts;
    Row row{{t.name, t.fluence.error, t.fluence.estimate, f.grid, f.steps + f.rays, f.model, t.image.error,
             t.image.estimate, p.grid, p.steps + p.rays, p.model, t.seconds, t.estimate_seconds}};
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Document estimate_document(const std::vector<TrialGroup>& groups, const NamedTexts& context) {
  Document document{.title = "The error estimate against true errors", .context = context};
  document.summary =
      "Every run estimates its own error. Here the true error is found beside it: against two photon runs on voxels "
      "half "
      "as large, whose own scatter is taken out.";
  document.sections = {{"Coverage", {coverage_table(groups)}}, {"All runs", {}}};
  document.sections[0].parts.push_back(scatter_plot(groups, "fluence", &EstimateTrial::fluence));
  document.sections[0].parts.push_back(scatter_plot(groups, "picture", &EstimateTrial::image));
  for (const TrialGroup& group : groups) document.sections[1].parts.push_back(trial_table(group));
  return document;
}

}  // namespace turbid
