// SPDX-License-Identifier: Apache-2.0
// How thick the bodies that scatter are, in voxels: what says how well a grid resolves them.
#pragma once
#include "host/study/companion.h"

namespace turbid {

/// 4 V / S of all voxels that take part together, the mean length of straight lines through them [voxels].
double mean_chord(const SampledFluence&);

}  // namespace turbid
