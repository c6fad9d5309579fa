// SPDX-License-Identifier: Apache-2.0
// Runs the lattice as one whole with single steps in place (kernels/global_lattice.cl): what blocks are compared with
// (Bernabei et al., Fig. 9), and the lattice that needs the least memory.
#pragma once
#include <vector>

#include "host/cl/session.h"
#include "host/transport/global_rows.h"
#include "host/transport/lattice_scheme.h"

namespace turbid {

class GlobalLattice : public LatticeScheme {
 public:
  GlobalLattice(cl::Session&, const DiffusionMedium&, const LatticeSettings&);

  void reset() override;
  void set_source(const std::vector<float>& q) override;
  /// A sweep is one step here.
  void enqueue_sweeps(int count) override;
  Change read_change() override;
  std::vector<float> read_fluence() override;
  /// Of the next step; does two.
  LatticeEnergy read_energy() override;
  std::size_t device_bytes() const override;

 protected:
  int sweeps_per_test() const override { return 32; }

 private:
  using F = cl::Buffer<float>;
  using I = cl::Buffer<std::int32_t>;
  using F2 = cl::Buffer<std::array<float, 2>>;
  using I2 = cl::Buffer<std::array<std::int32_t, 2>>;
  using I4 = cl::Buffer<std::array<std::int32_t, 4>>;
  using Bytes = cl::Buffer<std::byte>;
  using Step = cl::Kernel<Bytes, Bytes, F, F2, F, I, I4, I4, F2, I2, F, int, int, int, int, int>;
  using MeasuredStep = cl::Kernel<Bytes, Bytes, F, F2, F, I, I4, I4, F2, I2, F, int, int, int, int, int, F, F>;
  void enqueue_step(bool measure);

  cl::Session& session_;
  GlobalRows rows_;
  int channels_ = 3, row_count_ = 0, block_count_ = 0, face_count_ = 0;
  glm::dvec3 emitted_{0};  ///< sum of the source [W]
  cl::Program program_;
  Step steps_[2];  ///< local, crossing
  MeasuredStep measured_[2];
  cl::Kernel<Bytes, I4, cl::Buffer<std::array<float, 4>>, F, int, int, int, int, int> exchange_;
  Bytes slots_, rest_;
  F collision_, source_, walls_, fluence_, sums_, lost_;
  F2 even_, end_walls_;
  I lit_;
  I4 rows_buffer_, ends_, faces_;
  I2 near_;
  cl::Buffer<std::array<float, 4>> links_;
};

}  // namespace turbid
