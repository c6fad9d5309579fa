// SPDX-License-Identifier: Apache-2.0
// See run_warnings.h.
#include "host/study/run_warnings.h"

#include <algorithm>
#include <cstdio>

namespace turbid {
namespace {

constexpr double kFaintest = 1e-8;  // a ray's step then still deposits a hundred units of 2^-60 of all light
constexpr const char* kColours[3] = {"red", "green", "blue"};
constexpr double kInFlight = 0.01;  // share of the light that may be cut off unnoticed: what a picture hardly shows

std::string text(const char* format, auto... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

}  // namespace

std::vector<std::string> run_warnings(const SolverReport& report, const SolverSettings& settings) {
  std::vector<std::string> warnings;
  double in_flight = 0;
  for (int c = 0; c < 3; ++c)
    if (report.energy.emitted[c] > 0)
      in_flight = std::max(in_flight, report.energy.in_flight[c] / report.energy.emitted[c]);
  if (in_flight > kInFlight) {
    const std::string share = text("%.3g %% of the light was still on its way when its paths ended", 100 * in_flight);
    warnings.push_back(
        report.photon ? share + text(" after %d steps; raise solver.photon.max_steps (%d) unless it is trapped by "
                                     "total reflection",
                                     settings.photon.max_steps, settings.photon.max_steps)
                      : share + text("; raise solver.march.max_bounces (%d) or max_steps (%d) unless it is trapped "
                                     "by total reflection",
                                     settings.march.max_bounces, settings.march.max_steps));
  }
  const double brightest = std::max({report.energy.emitted.x, report.energy.emitted.y, report.energy.emitted.z});
  for (int c = 0; c < 3 && !report.photon; ++c)
    if (report.energy.emitted[c] > 0 && report.energy.emitted[c] < kFaintest * brightest)
      warnings.push_back(
          text("%s light is %.2g of the brightest colour's, far below the brightest that sums in fixed "
               "point can follow beside it; compute it in a run of its own",
               kColours[c], report.energy.emitted[c] / brightest));
  if (report.solver == "steady" && report.iterations > 0 && report.error_estimate > settings.steady.tolerance)
    warnings.push_back(
        text("the solve ended after %d iterations with an estimated error of %.2g, above its tolerance "
             "%.2g; raise solver.steady.max_iterations",
             report.iterations, report.error_estimate, static_cast<double>(settings.steady.tolerance)));
  if (report.solver == "lattice" && report.error_estimate > settings.lattice.tolerance)
    warnings.push_back(
        text("the lattice ended after %d sweeps with an estimated error of %.2g, above its tolerance "
             "%.2g; raise solver.lattice.max_sweeps or use solver \"steady\"",
             report.iterations, report.error_estimate, static_cast<double>(settings.lattice.tolerance)));
  return warnings;
}

}  // namespace turbid
