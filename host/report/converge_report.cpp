// SPDX-License-Identifier: Apache-2.0
// See converge_report.h.
#include "host/report/converge_report.h"

#include <cmath>

#include "host/report/text_line.h"
#include "host/view/encode_image.h"

namespace turbid {
namespace {

Cell number(double value) {
  return std::isnan(value) ? Cell() : Cell(value);
}

std::string order_sentence(const SceneRefinement& r) {
  if (!r.fit) return "No order can be fitted.";
  std::string text = line("Observed order %.2f", r.fit->order);
  if (r.fit->levels > 2) text += line(" (95 %% between %.2f and %.2f)", r.fit->low, r.fit->high);
  if (!r.judged) return text + "; none is expected here.";
  text += line("; expected %.3g, at least %.3g: ", r.parameter.order, r.parameter.least_order) + r.parameter.why;
  return text + (r.passed() ? ". Met." : ". NOT MET.");
}

/// "step", or "step at rays 4" beside a second parameter.
std::string title_of(const SceneRefinement& r) {
  return r.parameter.name + (r.beside ? line(" at %s %g", r.beside->parameter.name.c_str(), r.beside->level) : "");
}

/// Errors over two parameters: the levels of the first down, those of the second across.
Table both_table(const std::vector<SceneRefinement>& all) {
  const std::string& second = all.front().beside->parameter.name;
  Table table{.id = "both", .title = "Relative L2 error over " + all.front().parameter.name + " and " + second};
  table.caption = "Where a row or a column no longer falls, the other parameter limits.";
  table.columns = {{all.front().parameter.name, all.front().parameter.level_unit}};
  for (const SceneRefinement& r : all) table.columns.push_back({line("%s %g", second.c_str(), r.beside->level)});
  for (std::size_t i = 0; i < all.front().levels.size(); ++i) {
    Row row{.cells = {all.front().levels[i].level}};
    for (const SceneRefinement& r : all) row.cells.push_back(number(r.levels[i].fluence.rel_l2));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table level_table(const SceneRefinement& r, const std::string& id) {
  const bool picture = !r.levels.empty() && r.levels.front().image;
  Table table{.id = id, .title = "Levels of " + title_of(r)};
  table.caption = "Errors against " + r.reference + ". " + order_sentence(r);
  if (r.noise > 0)
    table.caption += line(" The reference's own scatter, %.2g in the L2 norm, is taken out of L2 and relMSE.", r.noise);
  table.columns = {{r.parameter.name, r.parameter.level_unit},
                   {"h", r.parameter.h_unit},
                   {"L1"},
                   {"L2"},
                   {"Linf"},
                   {"order"},
                   {"time", "s"},
                   {"peak memory", "MB"}};
  if (picture) table.columns.insert(table.columns.begin() + 6, {{"picture relMSE"}, {"mean FLIP"}});
  for (std::size_t i = 0; i < r.levels.size(); ++i) {
    const SceneLevel& l = r.levels[i];
    const double order =
        i == 0 ? std::nan("")
               : observed_order({r.levels[i - 1].h, r.levels[i - 1].fluence.rel_l2}, {l.h, l.fluence.rel_l2});
    Row row{.cells = {l.level, l.h, number(l.fluence.rel_l1), number(l.fluence.rel_l2), number(l.fluence.linf),
                      number(order)}};
    if (picture) {
      row.cells.push_back(l.image->relmse);
      row.cells.push_back(*l.flip);
    }
    row.cells.push_back(l.seconds);
    row.cells.push_back(l.peak_memory > 0 ? Cell(static_cast<double>(l.peak_memory) / 1e6) : Cell());
    if (r.judged && i + 1 == r.levels.size()) row.state = r.passed() ? RowState::pass : RowState::fail;
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table stage_table(const SceneRefinement& r, const std::string& id) {
  Table table{.id = id, .title = "Time of each stage", .caption = "Medians of the repeats."};
  table.columns = {{"stage"}};
  for (const SceneLevel& level : r.levels) table.columns.push_back({line("%g", level.level), "s"});
  for (const StageTime& stage : r.levels.front().stages) {
    Row row{.cells = {stage.name}};
    for (const SceneLevel& level : r.levels) row.cells.push_back(seconds_of(level.stages, stage.name));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Plot error_plot(const SceneRefinement& r, const std::string& id) {
  Plot plot{.id = id, .title = "Error over " + r.parameter.name};
  plot.x = {.label = r.parameter.name == "rays" || r.parameter.name == "photons" ? "h" : r.parameter.name,
            .unit = r.parameter.h_unit,
            .log = true};
  plot.y = {.label = "relative error", .log = true};
  Series l1{.name = "L1"}, l2{.name = "L2", .highlighted = true}, linf{.name = "Linf"},
      picture{.name = "picture, root of relMSE", .dashed = true};
  for (const SceneLevel& level : r.levels) {
    for (Series* series : {&l1, &l2, &linf, &picture}) series->x.push_back(level.h);
    l1.y.push_back(level.fluence.rel_l1);
    l2.y.push_back(level.fluence.rel_l2);
    linf.y.push_back(level.fluence.linf);
    picture.y.push_back(level.image ? std::sqrt(level.image->relmse) : std::nan(""));
  }
  const auto shown = [](const Series& series) {
    for (const double y : series.y)
      if (std::isfinite(y) && y > 0) return true;
    return false;
  };
  for (const Series& series : {l2, l1, linf, picture})
    if (shown(series)) plot.series.push_back(series);
  if (r.parameter.order > 0 && !plot.series.empty()) plot.slopes.push_back({r.parameter.order});
  if (r.noise > 0) plot.lines.push_back({false, r.noise, "scatter of the reference"});
  return plot;
}

Plot time_plot(const SceneRefinement& r, const std::string& id) {
  Plot plot{.id = id, .title = "Error over time"};
  plot.x = {.label = "time of the run", .unit = "s", .log = true};
  plot.y = {.label = "relative L2 error", .log = true};
  Series series{.name = r.parameter.name, .highlighted = true};
  for (const SceneLevel& level : r.levels) {
    series.x.push_back(level.seconds);
    series.y.push_back(level.fluence.rel_l2);
    series.point_labels.push_back(line("%g", level.level));
  }
  plot.series = {series};
  return plot;
}

/// |a - b| in the colours of the reference's exposure.
ViewImage difference_of(const ViewImage& a, const ViewImage& b) {
  ViewImage image = b;
  for (std::size_t i = 0; i < image.colour.size(); ++i)
    image.colour[i] = glm::vec4(glm::abs(glm::vec3(a.colour[i]) - glm::vec3(b.colour[i])), 1);
  return image;
}

Pictures pictures_of(const SceneRefinement& r, const std::string& id) {
  const ViewImage& reference = *r.reference_picture;
  const float exposure = automatic_exposure(reference);
  Pictures all{.id = id, .title = "Pictures"};
  all.caption = "Under each level ten times its difference from the reference, all at one exposure.";
  const auto add = [&](const std::string& title, const ViewImage& image, float stops) {
    all.pictures.push_back(
        {.title = title, .width = image.width, .height = image.height, .png = png_preview_bytes(image, stops)});
  };
  add("reference", reference, exposure);
  for (const SceneLevel& level : r.levels) {
    add(line("%s %g", r.parameter.name.c_str(), level.level), *level.picture, exposure);
    add(line("10 x |difference| at %g", level.level), difference_of(*level.picture, reference),
        exposure + std::log2(10.0f));
  }
  return all;
}

}  // namespace

Document converge_document(const std::string& subject, const std::vector<SceneRefinement>& refinements,
                           const NamedTexts& context) {
  Document document{.title = "Convergence of " + subject, .context = context};
  if (!refinements.empty() && refinements.front().beside) {
    Section section{.title = subject + " over two parameters"};
    section.parts.push_back(both_table(refinements));
    document.sections.push_back(std::move(section));
  }
  for (std::size_t i = 0; i < refinements.size(); ++i) {
    const SceneRefinement& r = refinements[i];
    const std::string suffix = refinements.size() > 1 ? "_" + std::to_string(i + 1) : "";
    document.summary += (i ? " " : "") + title_of(r) + ": " + order_sentence(r);
    Section section{.title = subject + " over " + title_of(r)};
    section.parts.push_back(level_table(r, "levels" + suffix));
    section.parts.push_back(error_plot(r, "error" + suffix));
    section.parts.push_back(time_plot(r, "time" + suffix));
    if (r.reference_picture) section.parts.push_back(pictures_of(r, "pictures" + suffix));
    if (!r.levels.front().stages.empty()) section.parts.push_back(stage_table(r, "stages" + suffix));
    document.sections.push_back(std::move(section));
  }
  return document;
}

}  // namespace turbid
