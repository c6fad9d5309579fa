// SPDX-License-Identifier: Apache-2.0
// A case with a known answer, refined by one of its parameters and told like a scene's refinement.
#pragma once
#include "host/study/refine_scene.h"

namespace turbid {

struct Case;

/// One of the case's refinements at these levels (empty: its own). L1, L2 and L-infinity are those that the case
/// defines, NaN else; the fit is of the one it judges by. Throws InputError that names the case's parameters if it has
/// none called so, or if the levels do not run from coarse to fine.
std::vector<SceneRefinement> refine_case(cl::Session&, Progress&, const Case&, const std::string& parameter,
                                         const std::vector<double>& levels,
                                         const std::function<void(const std::string&)>& tell);

}  // namespace turbid
