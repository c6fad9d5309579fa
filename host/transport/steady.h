// SPDX-License-Identifier: Apache-2.0
// Solves the lattice's steady state: conjugate gradients with a multigrid V-cycle (kernels/steady.cl).
#pragma once
#include <array>
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
  double error_estimate = 0;     ///< relative error in the energy norm, of the iterate before the last
  double residual_sum = 0;       ///< largest |sum of the true residual| / sum of the source over the channels
  std::vector<std::array<double, 3>> gains;  ///< per iteration and channel: squared energy norm of what it added / that of u
};

class SteadySolve {
 public:
  SteadySolve(cl::Session&, const DiffusionMedium&, const SteadySettings&);
  /// q [W]: [channel][block][voxel]. `progress(fraction)` may throw to stop. A warm solve starts from the last answer, scaled
  /// per channel to fit q best; it needs no iteration where that is good enough. Both starts lead to the same tolerance, but
  /// only the cold one to the same bits whatever was solved before.
  SteadyResult solve(const std::vector<float>& q, bool warm = false, const std::function<void(double)>& progress = {});
  /// Device memory held [bytes].
  std::size_t device_bytes() const;

 protected:
  using F = cl::Buffer<float>;
  using I = cl::Buffer<std::int32_t>;
  using PerChannel = std::array<double, 3>;

  struct Level {
    int blocks = 0;
    F conductance, loss, b, x, y;
    I neighbours, parent, octant;
  };

  /// y = (preconditioner) b on level `index`; sums_ then hold b . y of that level.
  void v_cycle(std::size_t index);
  void apply(const F& x, F& out);
  void residual(const F& b, const F& x, F& r);
  PerChannel channel_sums();
  cl::Range blocks_by_channels(const Level& level) const {
    return {static_cast<std::size_t>(level.blocks), static_cast<std::size_t>(channels_)};
  }
  void write_field(F& buffer, const std::vector<float>& values);
  std::vector<float> read_field(const F& buffer);

  cl::Session& session_;
  SteadySettings settings_;
  int channels_ = 3;
  std::size_t stride_ = 0;
  std::vector<Level> levels_;   ///< the last holds all levels of one block each: [level][channel][block, zeros][voxel]
  int tail_levels_ = 0;

 private:
  PerChannel dot(const F& u, const F& v);
  PerChannel start_from_last(const std::vector<float>& q);
  void run_round(bool first, PerChannel total, PerChannel& energy, SteadyResult&, const std::function<void(double)>& progress);
  void advance(const ChannelScalars& alpha);

  cl::Program program_;
  cl::Kernel<F, F, I, F, F, F, int, int> apply_;
  cl::Kernel<F, F, I, F, F, F, F, int, int> residual_;
  cl::Kernel<F, F, I, F, F, int, int, int> smooth_down_;
  cl::Kernel<F, F, I, F, F, F, I, I, F, F, int, int, int, int> smooth_up_;
  cl::Kernel<F, F, I, F, F, I, I, F, int, int, int> restrict_;
  cl::Kernel<F, F, I, I, I, F, F, F, int, int, int> coarse_cycle_;
  cl::Kernel<F, F, F, F, F, ChannelScalars, int, int> advance_;
  cl::Kernel<F, F, F, int, int> dot_;
  cl::Kernel<F, F, ChannelScalars, int, int> direction_;
  cl::Kernel<F, ChannelScalars, int, int> scale_;
  F solution_, p_, sums_;
  std::vector<float> staging_;
  bool solved_ = false;
};

}  // namespace turbid
