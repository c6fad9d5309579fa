// SPDX-License-Identifier: Apache-2.0
// Runs the lattice as one whole with single steps in place (kernels/global_lattice.cl): what blocks are compared with (Bernabei et
// al., Fig. 9), and the lattice that needs the least memory.
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
  void enqueue_step(bool measure);

  cl::Session& session_;
  GlobalRows rows_;
  int channels_ = 3, row_count_ = 0, face_count_ = 0;
  glm::dvec3 emitted_{0};  ///< sum of the source [W]
  cl::Program program_;
  cl::Kernel<F, F, F, cl::Buffer<std::array<std::int32_t, 4>>, cl::Buffer<std::array<std::int32_t, 2>>, F, F, int, int, int, int,
             int>
      step_;
  cl::Kernel<F, cl::Buffer<std::array<std::int32_t, 4>>, cl::Buffer<std::int32_t>, cl::Buffer<std::array<float, 4>>, F, int, int,
             int, int, int>
      exchange_;
  F slots_, collision_, source_, fluence_, sums_, lost_;
  cl::Buffer<std::array<std::int32_t, 4>> rows_buffer_, faces_buffer_;
  cl::Buffer<std::array<std::int32_t, 2>> near_buffer_;
  cl::Buffer<std::array<float, 4>> links_buffer_;
  cl::Buffer<std::int32_t> axes_buffer_;
};

}  // namespace turbid
