// SPDX-License-Identifier: Apache-2.0
// What a finished run could not do, one sentence each, with the way out.
#pragma once
#include <string>
#include <vector>

#include "host/scene/settings.h"
#include "host/transport/solver.h"

namespace turbid {

/// Light that was cut off before it came to an end; a solve that stopped short of its tolerance; a colour too faint
/// beside another.
std::vector<std::string> run_warnings(const SolverReport&, const SolverSettings&);

}  // namespace turbid
