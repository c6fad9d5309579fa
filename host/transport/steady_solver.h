// SPDX-License-Identifier: Apache-2.0
// The default solver: march, then the steady state by conjugate gradients.
#pragma once
#include "host/transport/marching_solver.h"
#include "host/transport/steady.h"

namespace turbid {

class SteadySolver final : public MarchingSolver {
 public:
  using MarchingSolver::MarchingSolver;

 protected:
  const char* name() const override { return "steady"; }
  void prepare_diffusion(const DiffusionMedium&) override;
  DiffuseLight diffuse(const LightSource&) override;
  std::size_t diffusion_bytes() const override { return solve_ ? solve_->device_bytes() : 0; }

 private:
  std::optional<SteadySolve> solve_;
};

}  // namespace turbid
