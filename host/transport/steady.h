// SPDX-License-Identifier: Apache-2.0
// Solves the lattice's steady state: conjugate gradients with a multigrid V-cycle (kernels/steady.cl), channel after
// channel.
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
  std::vector<float> u;  ///< fluence / eta^2 [W/voxel^2]: [channel][block][voxel], without the block of zeros
  int iterations = 0;    ///< of the channel that took most
  /// Relative error in the energy norm, as the stopping test bounds it, of the worst channel.
  double error_estimate = 0;
  /// The same before the last iteration and without a margin.
  double error_before_last = 0;
  /// Largest |sum of the true residual| / sum of the source over the channels, which scaling u took off in the end.
  double residual_sum = 0;
  /// Per iteration and channel: squared energy norm of what it added / that of u.
  std::vector<std::array<double, 3>> gains;
};

class SteadySolve {
 public:
  SteadySolve(cl::Session&, const DiffusionMedium&, const SteadySettings&);
  /// q [W]: [channel][block][voxel]. `progress(fraction)` may throw to stop. A warm solve starts from the last answer,
  /// scaled per channel to fit q best; it needs no iteration where that is good enough. Both starts lead to the same
  /// tolerance, but only the cold one to the same bits whatever was solved before. Each channel of u that has
  /// met the tolerance is scaled (by less than that) so that as much is absorbed and escapes as q emits.
  SteadyResult solve(const std::vector<float>& q, bool warm = false, const std::function<void(double)>& progress = {});
  /// Device memory held [bytes].
  std::size_t device_bytes() const;

 protected:
  using F = cl::Buffer<float>;
  using I = cl::Buffer<std::int32_t>;
  using W = cl::Buffer<std::uint32_t>;

  /// The operator holds all channels, fields one.
  struct Level {
    int blocks = 0;
    W rounded;          ///< operator
    F b, x, y, handed;  ///< y in natural order but on the finest level
    I neighbours, children, parent, octant;
  };

  /// The finest level's y = (preconditioner) b, before which b takes up the step before `step` unless that is the
  /// `first`; sums_ then hold b . y, and `step`'s scalars too.
  void v_cycle(int step = 0, int first = 0);
  /// out = A x, by the kernel that conjugate gradients use.
  void apply(const F& x, F& out);
  /// Sum of what sums_ hold.
  double block_sum();
  cl::Range all_blocks(const Level& level) const { return {static_cast<std::size_t>(level.blocks), 1}; }
  /// One channel, [block][voxel], into packed order; spoils next_p_. Neither this nor the next waits until `values` are
  /// copied.
  void write_field(F& buffer, std::span<const float> values);
  /// The channel of a field of all that is being solved, scaled so that `total` is lost instead of lost_ (0: not
  /// scaled); spoils next_p_.
  void read_field(const F& buffer, float total, std::span<float> values);

  cl::Session& session_;
  SteadySettings settings_;
  int channels_ = 3;
  int channel_ = 0;         ///< that is being solved
  std::size_t stride_ = 0;  ///< voxels of a channel, without the block of zeros
  /// The last holds all levels of one block each: [level](operators: [channel])[block, zeros][voxel].
  std::vector<Level> levels_;
  int tail_levels_ = 0;
  int padded_ = 0;  ///< blocks of the finest level, rounded up to a multiple of 16

 private:
  struct Round;
  void coarse_correction();
  double dot_with_solution(const F& v);
  void residual();
  void start_from_last(std::span<const float> q, Round& round);
  void step(Round& round);
  void settle(F& to, int at, int parts);
  void look(Round& round, int until);
  void run_round(Round& round, const std::function<void(double)>& progress);
  bool converged(const Round& round) const;
  void finish_round(Round& round, std::span<float> u);
  void start_channel(std::span<const float> q, bool warm, Round& round);
  void find_left(std::vector<Round>& rounds);

  cl::Program program_;
  cl::Kernel<F, F, int, int, int> settle_;
  cl::Kernel<F, F, int> pack_;
  cl::Kernel<F, F, F, float, int, int> unpack_;
  cl::Kernel<F, F, I, F, F, F, F, F, F, F, int, int, int, int, int, int> next_step_;
  cl::Kernel<F, F, F, F, float, int, int, int> last_step_;
  cl::Kernel<F, F, I, F, F, F, F, int, int> residual_;
  cl::Kernel<W, I, F, F, F, F, F, int, int, int, int, int> descend_;
  cl::Kernel<W, I, I, I, F, F, F, F, int, int, int, int> descend_coarse_;
  cl::Kernel<W, I, F, F, F, I, I, F, F, int, int, int> ascend_;
  cl::Kernel<W, I, F, F, F, I, I, F, int, int, int> ascend_coarse_;
  cl::Kernel<W, I, I, I, F, I, I, I, F, F, F, F, int, int, int, int, int> coarse_cycle_;
  cl::Kernel<F, F, F, int, int> dot_;
  cl::Kernel<F, float, int, int> scale_;
  F conductance_, loss_, solution_;  ///< of all channels
  F p_, next_p_, sums_;
  I only_child_;  ///< of levels of one block
  F steps_;       ///< [step][TURBID_STEP]
  F lost_;        ///< [channel]: sum of A x, absorbed and escaped
  std::vector<float> host_sums_, host_steps_;
  bool solved_ = false;
};

}  // namespace turbid
