// SPDX-License-Identifier: Apache-2.0
// Goals of whole frames: how much the host adds to the kernels, relighting against starting anew, growth with the voxels.
#pragma once
#include <vector>

#include "host/bench/experiment.h"
#include "host/bench/goal.h"
#include "host/cl/session.h"

namespace turbid {

std::vector<Goal> measure_frame(cl::Session&, const BenchSettings&);

}  // namespace turbid
