// SPDX-License-Identifier: Apache-2.0
// See refine_case.h.
#include "host/study/refine_case.h"

#include <cmath>

#include "host/base/errors.h"
#include "host/study/case.h"

namespace turbid {

std::vector<SceneRefinement> refine_case(cl::Session& session, Progress& progress, const Case& one,
                                         const std::string& parameter, const std::vector<double>& levels,
                                         const std::function<void(const std::string&)>& tell) {
  std::vector<SceneRefinement> all;
  std::string names;
  for (const Refinement& refinement : one.refinements) {
    if (names.find(refinement.parameter) == std::string::npos)
      names += (names.empty() ? "" : ", ") + refinement.parameter;
    if (refinement.parameter != parameter) continue;
    const std::vector<double>& chosen = levels.empty() ? refinement.levels : levels;
    const bool rising = refinement.levels.size() < 2 || refinement.levels.back() > refinement.levels.front();
    if (chosen.size() < 2) throw InputError("--levels: expected two or more, from coarse to fine, with commas between");
    for (std::size_t i = 1; i < chosen.size(); ++i)
      if (rising ? chosen[i] <= chosen[i - 1] : chosen[i] >= chosen[i - 1])
        throw InputError("--levels: expected levels from coarse to fine: " +
                         std::string(rising ? "rising " : "falling ") + parameter + " [" + refinement.unit + "]");
    SceneRefinement out;
    out.parameter = {.name = parameter + (refinement.variant.empty() ? "" : " (" + refinement.variant + ")"),
                     .level_unit = refinement.unit,
                     .h_unit = refinement.unit,
                     .rising = rising,
                     .order = refinement.order,
                     .least_order = refinement.order_low,
                     .why = "the case's own bound",
                     .levels = refinement.levels};
    out.reference = "the exact answer: " + one.equation;
    CaseContext context{session, progress, false};
    std::vector<Level> fitted;
    for (const double level : chosen) {
      char name[64];
      std::snprintf(name, sizeof name, "%s %g", parameter.c_str(), level);
      tell(name);
      const double started = wall_time();
      const RefinedLevel got = refinement.run(context, level);
      SceneLevel row{.level = level, .h = got.h};
      row.fluence = {.rel_l1 = got.l1, .linf = got.linf, .rel_l2 = got.l2, .noise = got.standard_error};
      row.stages = got.stages;
      row.seconds = wall_time() - started;
      fitted.push_back({got.h, refinement.error(got)});
      out.levels.push_back(std::move(row));
    }
    out.fit = fitted_order(fitted);
    out.judged = refinement.order > 0;
    all.push_back(std::move(out));
  }
  if (all.empty())
    throw InputError("--over " + parameter + ": the case " + one.name +
                     (names.empty() ? " has nothing to refine" : " can be refined over " + names));
  return all;
}

}  // namespace turbid
