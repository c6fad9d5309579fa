// SPDX-License-Identifier: Apache-2.0
// The blockwise lattice beside hand-written C++ of the same steps.
#pragma once
#include "host/bench/goal.h"
#include "host/cl/session.h"

namespace turbid {

/// Eight steps in blocks of 8^3 between two exchanges, on a cube of `voxels`^3 (a multiple of 8) of random coefficients
/// with a source everywhere, so that both read them all: by lattice.cl and by reference_lattice.cpp in turn, `repeats`
/// times. Fails if their fluences differ by more than rounding.
Goal blocked_steps(cl::Session&, int voxels, int repeats);

}  // namespace turbid
