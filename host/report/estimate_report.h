// SPDX-License-Identifier: Apache-2.0
// Error estimates beside true errors, as a document.
#pragma once
#include <string>
#include <vector>

#include "host/report/document.h"
#include "host/study/estimate_trials.h"

namespace turbid {

/// Trials that belong together.
struct TrialGroup {
  std::string name;     ///< "calibration", "held out", "scenes"
  bool judged = false;  ///< must keep kLeastCoverage and kLargestMedian
  std::vector<EstimateTrial> trials;
};

Document estimate_document(const std::vector<TrialGroup>&, const NamedTexts& context);

}  // namespace turbid
