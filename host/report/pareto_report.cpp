// SPDX-License-Identifier: Apache-2.0
// See pareto_report.h.
#include "host/report/pareto_report.h"

#include <algorithm>
#include <cmath>

#include "host/report/text_line.h"

namespace turbid {
namespace {

Cell number(double value) {
  return std::isnan(value) ? Cell() : Cell(value);
}

Table run_table(const ParetoStudy& study) {
  Table table{.id = "runs", .title = "All runs"};
  table.caption = line(
      "L2 of the fluence against two photon runs, whose own scatter (%.2g) is taken out; an error far "
      "below it is not resolved. Coarser runs are interpolated to its voxels. Worth using: no other run is as fast and "
      "as accurate, to 1 %%.",
      study.noise);
  table.columns = {{"L2"}, {"time", "s"}, {"worth using"}, {"solver"}, {"setting"}, {"picture"}, {"peak memory", "MB"}};
  for (const SettingRun& run : study.runs)
    table.rows.push_back({{run.error, run.seconds, run.efficient, run.solver, run.setting, number(run.picture_error),
                           static_cast<double>(run.peak_memory) / 1e6}});
  return table;
}

Plot run_plot(const ParetoStudy& study) {
  Plot plot{.id = "pareto", .title = "Error over time"};
  plot.caption = "The heavy line joins the runs that are worth using.";
  plot.x = {.label = "time of the run", .unit = "s", .log = true};
  plot.y = {.label = "relative L2 error of the fluence", .log = true};
  for (const char* solver : {"steady", "lattice", "photon"}) {
    Series series{.name = solver, .line = false};
    for (const SettingRun& run : study.runs)
      if (run.solver == solver) {
        series.x.push_back(run.seconds);
        series.y.push_back(run.error);
      }
    if (!series.x.empty()) plot.series.push_back(series);
  }
  Series front{.name = "worth using", .markers = false, .highlighted = true};
  std::vector<SettingRun> efficient;
  std::copy_if(study.runs.begin(), study.runs.end(), std::back_inserter(efficient),
               [](const SettingRun& r) { return r.efficient; });
  std::sort(efficient.begin(), efficient.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  for (const SettingRun& run : efficient) {
    front.x.push_back(run.seconds);
    front.y.push_back(run.error);
  }
  plot.series.push_back(front);
  if (study.noise > 0) plot.lines.push_back({false, study.noise, "scatter of the reference"});
  return plot;
}

Table advice_table(const ParetoStudy& study, const std::vector<double>& aims) {
  Table table{.id = "recommended", .title = "What to use"};
  table.caption =
      "Where no run of a diffusion solver reaches an aim its model is the limit: photons, by 1 / sqrt(time).";
  table.columns = {{"error"}, {"solver"}, {"setting"}, {"reaches"}, {"time", "s"}};
  for (const double aim : aims) {
    const auto best = recommended(study.runs, aim);
    const double photons =
        study.photon_error > 0 ? photon_seconds(study.photon_error, study.photon_seconds, aim) : std::nan("");
    if (best && !(study.runs[*best].seconds > photons)) {
      const SettingRun& run = study.runs[*best];
      table.rows.push_back({{line("%g %%", 100 * aim), run.solver, run.setting, run.error, run.seconds}});
    } else {
      const double count = study.photons * photons / study.photon_seconds;
      table.rows.push_back(
          {{line("%g %%", 100 * aim), "photon",
            study.photon_error > 0 ? line("%.0f photons", 1e3 * std::ceil(count / 1e3)) : std::string("photons"), aim,
            number(photons)}});
    }
  }
  return table;
}

}  // namespace

Document pareto_document(const std::string& scene, const ParetoStudy& study, const std::vector<double>& aims,
                         const NamedTexts& context) {
  Document document{.title = "Speed against error: " + scene, .context = context};
  double best = 1e9;
  for (const SettingRun& run : study.runs)
    if (run.solver != "photon") best = std::min(best, run.error);
  document.summary =
      line("The diffusion solvers come down to %.2g at the best; one photon run of %.3g s scatters by %.2g.", best,
           study.photon_seconds, study.photon_error);
  document.sections = {{"What to use", {advice_table(study, aims)}}, {"Runs", {run_plot(study), run_table(study)}}};
  return document;
}

Document accuracy_document(const std::vector<AccuracyRow>& rows, const NamedTexts& context) {
  Document document{.title = "steady and lattice against photon", .context = context};
  document.summary =
      "How far the diffusion solvers lie from Monte Carlo transport, and how much longer Monte Carlo takes "
      "to the same error of the fluence.";
  Table table{.id = "accuracy", .title = "Scenes"};
  table.caption =
      "L2: of the fluence, the reference's scatter taken out. Powers: difference, in % of the light that met "
      "the medium, of the colour that is worst. Time ratio: photon's to an equal L2 over the solver's whole run.";
  table.columns = {{"scene"},
                   {"solver"},
                   {"L2", "%", 2},
                   {"scatter", "%", 2},
                   {"picture relMSE", "", 2},
                   {"reflected", "%", 2},
                   {"escaped", "%", 2},
                   {"absorbed", "%", 2},
                   {"time", "s", 2},
                   {"time ratio", "", 2}};
  for (const AccuracyRow& r : rows)
    table.rows.push_back({{r.scene, r.solver, 100 * r.fluence, 100 * r.noise, number(r.relmse), 100 * r.reflected,
                           100 * r.escaped, 100 * r.absorbed, r.seconds, number(r.time_ratio)}});
  document.sections = {{"Scenes", {table}}};
  return document;
}

}  // namespace turbid
