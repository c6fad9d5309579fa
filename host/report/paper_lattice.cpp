// SPDX-License-Identifier: Apache-2.0
// Sections on the lattice: stability, energy, stopping, cost.
#include "host/report/paper_sections.h"

namespace turbid {
namespace {

/// One series per thing, over one x.
template <class Rows, class X, class Y>
Series series(const std::string& name, const Rows& rows, X x, Y y) {
  Series one{.name = name};
  for (const auto& row : rows) {
    one.x.push_back(x(row));
    one.y.push_back(y(row));
  }
  return one;
}

}  // namespace

Section paper_stability(const std::vector<study::Stability>& rows) {
  Plot plot{.id = "growth",
            .title = "Growth of the populations in one step",
            .caption =
                "Largest mode of a periodic box of 8^3 voxels, albedo .9, by power iteration. Above 1 the "
                "lattice blows up: with the printed collision at s > 2, never with the others.",
            .x = {.label = "optical thickness of a voxel, s", .log = true},
            .y = {.label = "growth per step", .log = true},
            .lines = {{.at = 1, .label = "stable below"}, {.vertical = true, .at = 2, .label = "s = 2"}}};
  Table table{.id = "stability", .title = "The same in numbers", .columns = {{"s"}}};
  for (std::size_t v = 0; v < study::kCollisions.size(); ++v) {
    plot.series.push_back(series(
        study::kCollisions[v], rows, [](const auto& row) { return row.s; },
        [v](const auto& row) { return row.growth[v]; }));
    table.columns.push_back({study::kCollisions[v], "", 4});
  }
  plot.series[0].highlighted = true;
  table.columns.push_back({"the engine's lattice, collision \"paper\""});
  for (const auto& row : rows)
    table.rows.push_back({{row.s, row.growth[0], row.growth[1], row.growth[2], row.growth[3], row.engine}});
  return {"Stability", {plot, table}};
}

Section paper_energy(const study::ClosedBox& box) {
  Plot plot{.id = "energy",
            .title = "Energy in a closed box",
            .caption =
                "Eq. 5 as printed: every column of the matrix sums to 1, so f_0 gives back on the next step "
                "what the others lost to it, and nothing is ever absorbed. With f_0 as a sink the energy falls "
                "by 1 - s_a per step. Periodic box, s = 0.5, albedo .9.",
            .x = {.label = "steps"},
            .y = {.label = "energy, of what it was", .log = true},
            .series = {{.name = "as printed", .x = box.step, .y = box.printed, .markers = false, .highlighted = true},
                       {.name = "f_0 a sink", .x = box.step, .y = box.sink, .markers = false},
                       {.name = "exp(-sigma_a t)", .x = box.step, .y = box.exact, .markers = false, .dashed = true}}};
  return {"Absorption", {plot}};
}

Section paper_stopping(const std::vector<study::Stopping>& rows) {
  const auto x = [](const study::Stopping& row) { return 1 - row.albedo; };
  Plot plot{
      .id = "stop",
      .title = "True error when the stopping test says: enough",
      .caption =
          "Each test was asked for 1e-4. The paper looks at the relative change of sparse probes from one "
          "step to the next, which says nothing of how many steps are still to come: the error left is "
          "about change rho / (1 - rho), rho the ratio of successive changes. At low albedo it waits for "
          "the dimmest of its probes (here one voxel in 64) and does too much. Slab of voxels of one mean "
          "free path, open towards two sides, the first eighth emits; error in L2 against the scheme's own "
          "end.",
      .x = {.label = "1 - albedo", .log = true},
      .y = {.label = "true relative error at the stop", .log = true},
      .series = {series("change at probes < 1e-4 (paper)", rows, x, [](const auto& row) { return row.paper_error; }),
                 series("change rho / (1 - rho) < 1e-4", rows, x, [](const auto& row) { return row.estimate_error; }),
                 series("conjugate gradients' estimate < 1e-4", rows, x,
                        [](const auto& row) { return row.steady_error; })},
      .lines = {{.at = 1e-4, .label = "asked for"}}};
  plot.series[0].highlighted = true;
  Table table{.id = "stopping",
              .title = "The same in numbers",
              .columns = {{"albedo", "", 5},
                          {"paper: steps"},
                          {"true error", "", 2, NumberStyle::scientific},
                          {"change rho / (1 - rho): steps"},
                          {"true error", "", 2, NumberStyle::scientific},
                          {"conjugate gradients: iterations"},
                          {"true error", "", 2, NumberStyle::scientific}}};
  for (const auto& row : rows)
    table.rows.push_back(
        {{row.albedo, std::int64_t{row.paper_sweeps}, row.paper_error, std::int64_t{row.estimate_sweeps},
          row.estimate_error, std::int64_t{row.steady_iterations}, row.steady_error}});
  return {"Stopping test", {plot, table}};
}

Section paper_cost(const std::vector<study::Cost>& rows) {
  const auto x = [](const study::Cost& row) { return 1 - row.albedo; };
  Plot plot{
      .id = "work",
      .title = "Steps to a true error of 1e-4",
      .caption =
          "Cube of voxels of one mean free path, open on all sides, light from one side. A step costs one "
          "pass over the lattice, an iteration of the steady solve a multigrid cycle, a few of them.",
      .x = {.label = "1 - albedo", .log = true},
      .y = {.label = "steps or iterations", .log = true},
      .series = {series("plain steps, paper's collision", rows, x, [](const auto& row) { return row.paper_sweeps; }),
                 series("plain steps, two relaxation times", rows, x, [](const auto& row) { return row.trt_sweeps; }),
                 series("conjugate gradients with multigrid", rows, x,
                        [](const auto& row) { return row.steady_iterations; })}};
  plot.series[0].highlighted = true;
  Table table{.id = "cost",
              .title = "Steps and time",
              .caption = "Times are of the device's work alone, in one run on one machine: read their ratios.",
              .columns = {{"albedo", "", 5},
                          {"paper: steps"},
                          {"time", "s"},
                          {"TRT: steps"},
                          {"time", "s"},
                          {"conjugate gradients: iterations"},
                          {"time", "s"},
                          {"paper's time / ours"}}};
  for (const auto& row : rows)
    table.rows.push_back(
        {{row.albedo, std::int64_t{row.paper_sweeps}, row.paper_seconds, std::int64_t{row.trt_sweeps}, row.trt_seconds,
          std::int64_t{row.steady_iterations}, row.steady_seconds, row.paper_seconds / row.steady_seconds}});
  return {"Cost", {plot, table}};
}

}  // namespace turbid
