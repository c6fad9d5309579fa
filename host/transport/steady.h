// SPDX-License-Identifier: Apache-2.0
// Solves the lattice's steady state: conjugate gradients with a multigrid V-cycle (kernels/steady.cl).
#pragma once
#include <functional>
#include <vector>

#include "host/cl/session.h"
#include "host/scene/settings.h"
#include "host/transport/multigrid.h"
#include "kernels/shared/lattice_params.h"

namespace turbid {

struct SteadyResult {
  std::vector<float> u;          ///< fluence / eta^2 [W/voxel^2]: [channel][block][voxel], without the block of zeros
  int iterations = 0;
  double error_estimate = 0;     ///< relative error in the energy norm (Hestenes and Stiefel's sum with delay 2)
  double residual_sum = 0;       ///< largest |sum of the true residual| / sum of the source over the channels
};

class SteadySolve {
 public:
  SteadySolve(cl::Session&, const DiffusionMedium&, const SteadySettings&);
  /// q [W]: [channel][block][voxel]. `progress(fraction)` may throw to stop.
  SteadyResult solve(const std::vector<float>& q, const std::function<void(double)>& progress = {});

 private:
  struct Level {
    int blocks = 0;
    cl::Buffer<float> conductance, loss, b, x, y;
    cl::Buffer<std::int32_t> neighbours, parent, octant;
  };
  using F = cl::Buffer<float>;
  using I = cl::Buffer<std::int32_t>;

  void v_cycle(std::size_t level);
  std::vector<double> channel_sums();

  cl::Session& session_;
  SteadySettings settings_;
  int channels_ = 3;
  std::vector<Level> levels_;
  cl::Program program_;
  cl::Kernel<F, F, I, F, F, F, int, int, int, int, int> smooth_;
  cl::Kernel<F, F, I, F, F, I, I, F, int, int, int> restrict_;
  cl::Kernel<F, I, I, F, int, int, int> prolong_;
  cl::Kernel<F, F, I, F, F, F, int, int> apply_;
  cl::Kernel<F, F, F, F, F, ChannelScalars, int, int> advance_;
  cl::Kernel<F, F, I, F, F, F, F, int, int> residual_;
  cl::Kernel<F, F, F, int, int> dot_;
  cl::Kernel<F, F, ChannelScalars, int, int> direction_;
  F q_, solution_, p_, ap_, sums_;
};

}  // namespace turbid
