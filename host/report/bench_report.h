// SPDX-License-Identifier: Apache-2.0
// Goals and experiments as documents.
#pragma once
#include <string>
#include <vector>

#include "host/bench/experiment.h"
#include "host/bench/goal.h"
#include "host/report/document.h"

namespace turbid {

/// The one table of goals; its rows pass or fail.
Section goal_section(const std::vector<Goal>&);
/// What the paper says, what was run and found, table, plot, pictures.
Section experiment_section(const Experiment&);
/// Empty unless the machine had more to do than this run when it began.
std::string load_warning(double load, int cores);

/// Median time of a warm frame [s] in the JSON text of `turbid profile`. Throws std::runtime_error if there is none.
double frame_seconds_of_profile(const std::string& json);

}  // namespace turbid
