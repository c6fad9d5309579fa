// SPDX-License-Identifier: Apache-2.0
// The paper's scheme: batches of rays march on one queue while the lattice relaxes the earlier batches' deposits on
// another.
#pragma once
#include "host/transport/lattice_scheme.h"
#include "host/transport/marching_solver.h"

namespace turbid {

class LatticeSolver final : public MarchingSolver {
 public:
  using MarchingSolver::MarchingSolver;

 protected:
  const char* name() const override { return "lattice"; }
  void prepare_diffusion(const DiffusionMedium&) override;
  void march_all(March&) override;
  DiffuseLight diffuse(const LightSource&) override;
  std::size_t diffusion_bytes() const override { return lattice_ ? lattice_->device_bytes() : 0; }

 private:
  std::unique_ptr<LatticeScheme> lattice_;
};

}  // namespace turbid
