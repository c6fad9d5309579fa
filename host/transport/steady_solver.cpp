// SPDX-License-Identifier: Apache-2.0
// Joins the marching pass and the steady solve.
#include "host/transport/steady_solver.h"

namespace turbid {

void SteadySolver::prepare_diffusion(const DiffusionMedium& medium) {
  solve_.emplace(context_.session, medium, context_.settings.steady);
}

DiffuseLight SteadySolver::diffuse(const LightSource& source) {
  const DiffusionMedium& medium = diffusion_medium();
  SteadyResult result =
      solve_->solve(source.power, warm_start(), [&](double fraction) { context_.progress.update(fraction); });
  DiffuseLight light;
  light.iterations = result.iterations;
  light.error_estimate = result.error_estimate;
  light.fluence = std::move(result.u);
  const std::size_t stride = medium.stride();
  for (int c = 0; c < medium.channels; ++c) {
    for (std::size_t i = 0; i < stride; ++i) light.fluence[c * stride + i] *= medium.eta_squared[i];
  }
  account(medium, light);
  return light;
}

}  // namespace turbid
