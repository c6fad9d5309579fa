// SPDX-License-Identifier: Apache-2.0
// See paper_report.h.
#include "host/report/paper_report.h"

#include <algorithm>
#include <cmath>

#include "host/report/paper_sections.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

using study::PaperStudy;

std::string percent(double share) {
  return line("%.3g %%", 100 * share);
}

/// One row per thing that breaks.
Table overview(const PaperStudy& s) {
  Table table{.id = "overview",
              .title = "What breaks, and what the remedy buys",
              .caption = "Details, conditions and curves are in the sections below.",
              .columns = {{"as printed"}, {"what it does"}, {"remedy"}, {"with it"}}};
  const auto add = [&](std::string printed, std::string does, std::string remedy, std::string with) {
    table.rows.push_back({{std::move(printed), std::move(does), std::move(remedy), std::move(with)}});
  };
  const auto thick = std::find_if(s.stability.begin(), s.stability.end(), [](const auto& row) { return row.s >= 4; });
  add("collision p = s (Eq. 5)", line("populations grow %.3g-fold per step at s = %g", thick->growth[0], thick->s),
      "p = s / (1 + s/2)",
      line("they decay at every s (factor %.3g at s = %g)", s.stability.back().growth[3], s.stability.back().s));
  add("f_0 emits what it absorbed (Eq. 5)",
      line("%s of the energy is left after %.0f steps, as if nothing absorbed", percent(s.box.printed.back()).c_str(),
           s.box.step.back()),
      "f_0 is a sink",
      line("%s is left; exp(-sigma_a t) is %s", percent(s.box.sink.back()).c_str(),
           percent(s.box.exact.back()).c_str()));
  const study::Stopping& worst = s.stopping.back();
  add("stop when probes change by less than 1e-4",
      line("true error %s at albedo %g", percent(worst.paper_error).c_str(), worst.albedo),
      "stop on change rho / (1 - rho)", line("true error %s", percent(worst.estimate_error).c_str()));
  const study::Cost& slow = s.cost.back();
  add("plain lattice steps", line("%d of them to a true error of 1e-4 at albedo %g", slow.paper_sweeps, slow.albedo),
      "conjugate gradients and multigrid", line("%d iterations", slow.steady_iterations));
  add("rays by Eqs. 2 and 3", line("Luneburg focus %.2g R off at a step of %g R", s.focus[1].rms[0], s.focus[1].step),
      "kick-drift-kick", line("%.2g R", s.focus[1].rms[2]));
  add("rays by Fig. 4",
      line("focus %.2g R off however small the step; %.2f degrees behind a face that should give 19.47",
           s.focus.back().rms[1], s.refraction[1]),
      "grad n without 1/n, or kick-drift-kick", line("%.2g R; %.2f degrees", s.focus.back().rms[2], s.refraction[2]));
  add("od += exp(-delta sigma) (Fig. 4)",
      line("a ray carries %.2g times its light at depth %g", s.attenuation[1].printed.back(),
           s.attenuation[1].depth.back()),
      "a product", line("%.2g of it", std::exp(-s.attenuation[1].depth.back())));
  add("L_t is left behind",
      line("%.3g times the light is deposited at a step of %g", s.attenuation[2].deposited_printed,
           s.attenuation[2].step),
      "P (1 - e^-s) w", line("%.3g times the light, at any step", s.attenuation[2].deposited));
  add("one relaxation time for all moments",
      line("fluence around a lamp %s off, most on the diagonals", percent(s.directions.error[0]).c_str()),
      "two, (1/p1 - 1/2)(1/p2 - 1/2) = 1/4",
      line("%s off, alike in all directions", percent(s.directions.error[1]).c_str()));
  return table;
}

}  // namespace

Document paper_report(const PaperStudy& s, NamedTexts context, bool quick) {
  Document document{.title = "The paper's own scheme: where it breaks, and what each remedy buys",
                    .summary =
                        "Bernabei et al., A Parallel Architecture for Interactive Rendering of Scattering and "
                        "Refraction Effects, taken at its printed word, against the same scheme with each "
                        "remedy that Turbid uses.",
                    .context = std::move(context)};
  if (quick) document.summary += " A quick run: smaller domains than the full study's.";
  document.sections.push_back({"Overview", {overview(s)}});
  document.sections.push_back(paper_stability(s.stability));
  document.sections.push_back(paper_energy(s.box));
  document.sections.push_back(paper_stopping(s.stopping));
  document.sections.push_back(paper_cost(s.cost));
  document.sections.push_back(paper_bending(s.focus, s.refraction));
  document.sections.push_back(paper_deposits(s.attenuation));
  document.sections.push_back(paper_directions(s.directions));
  return document;
}

}  // namespace turbid
