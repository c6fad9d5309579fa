// SPDX-License-Identifier: Apache-2.0
// Runs the blockwise lattice (kernels/lattice.cl): sweeps of m inner steps, stopping test, energy.
#pragma once
#include <vector>

#include "host/cl/session.h"
#include "host/transport/lattice_medium.h"
#include "host/transport/lattice_scheme.h"

namespace turbid {

class Lattice : public LatticeScheme {
 public:
  Lattice(cl::Session&, const DiffusionMedium&, const LatticeSettings&);

  void reset() override;
  void set_source(const std::vector<float>& q) override;
  void enqueue_sweeps(int count) override { enqueue_sweeps(count, settings_.inner_iterations); }
  Change read_change() override;
  std::vector<float> read_fluence() override;
  LatticeEnergy read_energy() override;
  std::size_t device_bytes() const override;

 protected:
  int sweeps_per_test() const override { return 4; }
  /// One plain step, after which interfaces and populations belong together and the energy of a step can be told exactly.
  void settle() override { enqueue_sweeps(1, 1); }

 private:
  void enqueue_sweeps(int count, int inner);

  using F = cl::Buffer<float>;
  using I = cl::Buffer<std::int32_t>;

  cl::Session& session_;
  LatticeMedium medium_;
  int channels_ = 3, blocks_ = 0;
  cl::Program program_;
  cl::Kernel<F, F, I, F, I, F, F, F, F, F, int, int, int, int> sweep_;
  cl::Kernel<F, F, F, I, F, I, F, F, F, int, int, int> balance_;
  F collision_, source_, injected_, links_, populations_, fluence_, sums_, energy_;
  F interfaces_[2];
  I link_block_, neighbours_;
};

}  // namespace turbid
