// SPDX-License-Identifier: Apache-2.0
// What every run says of its own error, against Monte Carlo transport.
#include "host/study/case_lists.h"
#include "host/study/estimate_trials.h"
#include "host/study/trial_bodies.h"

namespace turbid::study {
namespace {

constexpr std::size_t kEvery = 3;  // of the held-out bodies: all 60 take a minute
constexpr double kPhotons = 4e4;   // of one reference: what they scatter by is taken out

void must_cover(CaseResult& result, const std::string& what, const Coverage& c) {
  result.at_least(what + ": share of true errors that the estimate covers", kLeastCoverage, c.share,
                  "one of twenty may lie above it");
  result.at_most(what + ": estimate / true error, median", kLargestMedian, c.median_ratio,
                 "a bound that is much larger says nothing");
  char text[320];
  std::snprintf(text, sizeof text,
                "%s: the estimate is at the most %.3g times too large; the largest true error is %.2g of it (%s)",
                what.c_str(), c.largest_ratio, c.largest_shortfall, c.farthest.c_str());
  result.notes.push_back(text);
}

Case covers_case() {
  Case c{.name = "estimate_covers",
         .title =
             "The error that a run estimates of itself covers its true error, in bodies that no constant was chosen by",
         .equation = "||phi - exact|| / ||exact|| <= estimate; the same of the picture's root relMSE",
         .source = "photon solver on voxels half as large; `turbid converge --estimate` has all bodies"};
  c.check = [](CaseContext& context, CaseResult& result) {
    const std::vector<TrialBody> bodies = trial_bodies(TrialSet::held_out);
    std::vector<EstimateTrial> trials;
    for (std::size_t i = 0; i < bodies.size(); i += kEvery)
      trials.push_back(try_estimate(context.session, bodies[i].scene, {.photons = kPhotons}));
    must_cover(result, "fluence", fluence_coverage(trials));
    must_cover(result, "picture", image_coverage(trials));
  };
  return c;
}

}  // namespace

std::vector<Case> estimate_cases() {
  return {covers_case()};
}

}  // namespace turbid::study
