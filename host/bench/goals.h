// SPDX-License-Identifier: Apache-2.0
// All speed goals of `turbid bench goals`, each measured side by side with what it is held against.
#pragma once
#include <string>
#include <vector>

#include "host/bench/experiment.h"
#include "host/bench/goal.h"
#include "host/cl/session.h"

namespace turbid {

/// A family of goals that are measured together.
struct GoalFamily {
  std::string name;             ///< what the command line calls it
  std::vector<Goal> (*measure)(cl::Session&, const BenchSettings&);
};

/// In the order in which they are printed.
const std::vector<GoalFamily>& goal_families();

}  // namespace turbid
