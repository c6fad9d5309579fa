// SPDX-License-Identifier: Apache-2.0
// host/study's diffusion runs on the tests' session.
#pragma once
#include "host/study/dense_diffusion.h"
#include "host/study/diffusion_runs.h"
#include "tests/support/test_media.h"

namespace turbid::test {

using study::DenseDiffusion, study::random_medium, study::SteadyAnswer, study::uniform, study::voxel_of;

inline SteadyAnswer solve_steady(const DiffusionMedium& medium, const std::vector<float>& q, float tolerance = 1e-6f) {
  return study::solve_steady(session(), medium, q, tolerance);
}

}  // namespace turbid::test
