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
  /// Of the next step, which it does.
  LatticeEnergy read_energy() override;
  std::size_t device_bytes() const override;

 protected:
  int sweeps_per_test() const override { return 4; }
  /// Plain steps, after which interfaces and populations belong together and the energy of a step can be told exactly.
  void settle() override;

 private:
  void enqueue_sweeps(int count, int inner);

  using F = cl::Buffer<float>;
  using F2 = cl::Buffer<std::array<float, 2>>;
  using F4 = cl::Buffer<std::array<float, 4>>;
  using I = cl::Buffer<std::int32_t>;
  using Bytes = cl::Buffer<std::byte>;

  cl::Session& session_;
  LatticeMedium medium_;
  int channels_ = 3, blocks_ = 0;
  int crossing_next_ = 1;  ///< whether populations stand as after a local step
  glm::dvec3 emitted_{0};  ///< sum of the source [W]
  cl::Program program_;
  cl::Kernel<F, F2, F, I, I, F, I, I, F4, I, F, F, Bytes, Bytes, F, F, int, int, int, int, int> sweep_;
  cl::Kernel<I, F, I, I, I, F4, F, Bytes, Bytes, F, int, int, int> departures_;
  Bytes populations_, rest_;
  F collision_, source_, walls_, fluence_, sums_, departing_;
  F interfaces_[2];
  F2 even_;
  F4 shares_;
  I lit_, wall_block_, first_face_, faces_, open_towards_, neighbours_;
};

}  // namespace turbid
