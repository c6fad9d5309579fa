// SPDX-License-Identifier: Apache-2.0
// Enqueues V-cycles and conjugate-gradient steps; scalars live on the host, summed over blocks in double precision and in a
// fixed order.
#include "host/transport/steady.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

constexpr int kVoxels = 512;
constexpr double kResidualGoal = 1e-6;  // |sum r| / sum q at which the energy balance is left alone

/// [channel][block][voxel] with a block of zeros after each channel.
std::vector<float> with_zero_block(const std::vector<float>& values, int channels, std::size_t stride) {
  std::vector<float> padded((stride + kVoxels) * channels, 0.0f);
  for (int c = 0; c < channels; ++c) {
    std::copy_n(values.begin() + c * stride, stride, padded.begin() + c * (stride + kVoxels));
  }
  return padded;
}

}  // namespace

SteadySolve::SteadySolve(cl::Session& session, const DiffusionMedium& medium, const SteadySettings& settings)
    : session_(session), settings_(settings), channels_(medium.channels) {
  program_ = session.build("steady.cl", {});
  smooth_ = {program_, "smooth"};
  restrict_ = {program_, "restrict_residual"};
  prolong_ = {program_, "prolong"};
  apply_ = {program_, "apply"};
  advance_ = {program_, "advance_solution"};
  residual_ = {program_, "true_residual"};
  dot_ = {program_, "dot_product"};
  direction_ = {program_, "next_direction"};
  for (const MultigridLevel& from : build_multigrid(medium)) {
    Level level;
    level.blocks = from.blocks.count();
    level.conductance = session.upload(from.conductance);
    level.loss = session.upload(from.loss);
    level.neighbours = session.upload(from.neighbours);
    level.parent = session.upload(from.parent);
    level.octant = session.upload(from.octant);
    const std::size_t size = from.stride() * channels_;
    level.b = session.zeros<float>(size);
    level.x = session.zeros<float>(size);
    level.y = session.zeros<float>(size);
    levels_.push_back(std::move(level));
  }
  const std::size_t size = levels_[0].b.count();
  q_ = session.zeros<float>(size);
  solution_ = session.zeros<float>(size);
  p_ = session.zeros<float>(size);
  ap_ = session.zeros<float>(size);
  sums_ = session.zeros<float>(static_cast<std::size_t>(levels_[0].blocks) * channels_);
}

void SteadySolve::v_cycle(std::size_t index) {
  cl::Queue& queue = session_.lattice_queue();
  Level& level = levels_[index];
  const cl::Range global{static_cast<std::size_t>(level.blocks), static_cast<std::size_t>(channels_)}, local{1, 1};
  const int sweeps = settings_.smoothing_sweeps;
  if (index + 1 == levels_.size()) {
    smooth_.enqueue(queue, global, local, level.conductance, level.loss, level.neighbours, level.b, level.x, level.y,
                    level.blocks, channels_, sweeps, 0, 1);
    return;
  }
  Level& coarse = levels_[index + 1];
  smooth_.enqueue(queue, global, local, level.conductance, level.loss, level.neighbours, level.b, level.y, level.x,
                  level.blocks, channels_, sweeps, 0, 1);
  restrict_.enqueue(queue, global, local, level.conductance, level.loss, level.neighbours, level.b, level.x,
                    level.parent, level.octant, coarse.b, level.blocks, coarse.blocks, channels_);
  v_cycle(index + 1);
  prolong_.enqueue(queue, global, local, coarse.y, level.parent, level.octant, level.x, level.blocks, coarse.blocks,
                   channels_);
  smooth_.enqueue(queue, global, local, level.conductance, level.loss, level.neighbours, level.b, level.x, level.y,
                  level.blocks, channels_, sweeps, 1, 0);
}

std::vector<double> SteadySolve::channel_sums() {
  const std::vector<float> sums = session_.read(session_.lattice_queue(), sums_);
  std::vector<double> result(3, 0.0);
  const std::size_t blocks = levels_[0].blocks;
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t block = 0; block < blocks; ++block) result[c] += sums[c * blocks + block];
  }
  return result;
}

SteadyResult SteadySolve::solve(const std::vector<float>& q, const std::function<void(double)>& progress) {
  SteadyResult result;
  Level& fine = levels_[0];
  const std::size_t stride = static_cast<std::size_t>(fine.blocks) * kVoxels;
  result.u.assign(stride * channels_, 0.0f);
  if (fine.blocks == 0) return result;
  cl::Queue& queue = session_.lattice_queue();
  const cl::Range global{static_cast<std::size_t>(fine.blocks), static_cast<std::size_t>(channels_)}, local{1, 1};
  std::vector<double> total(3, 0.0);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < stride; ++i) total[c] += q[c * stride + i];
  }
  session_.write(queue, q_, std::span<const float>(with_zero_block(q, channels_, stride)));
  session_.fill_zero(queue, solution_);

  auto dot = [&](const F& u, const F& v) {
    dot_.enqueue(queue, global, local, u, v, sums_, fine.blocks, channels_);
    return channel_sums();
  };
  auto relative_residual = [&](const std::vector<double>& sum) {
    double worst = 0;
    for (int c = 0; c < channels_; ++c) {
      if (total[c] > 0) worst = std::max(worst, std::abs(sum[c]) / total[c]);
    }
    return worst;
  };
  // Each round starts from the true residual, so that rounding in the recursive one can't hide an imbalance; the second and
  // later rounds are iterative refinement.
  std::vector<double> energy(3, 0.0);  // squared energy norm of the solution so far
  bool converged = false;
  while (!converged) {
    residual_.enqueue(queue, global, local, fine.conductance, fine.loss, fine.neighbours, q_, solution_, fine.b, sums_,
                      fine.blocks, channels_);
    result.residual_sum = relative_residual(channel_sums());
    const bool first_round = result.iterations == 0;
    if (!first_round && (result.residual_sum <= kResidualGoal || result.iterations >= settings_.max_iterations)) break;
    const int started = result.iterations;
    v_cycle(0);
    session_.copy(queue, fine.y, p_);
    std::vector<double> rz = dot(fine.b, fine.y);
    std::vector<std::array<double, 3>> gains;  // alpha_j r_j . z_j
    while (result.iterations < settings_.max_iterations) {
      apply_.enqueue(queue, global, local, fine.conductance, fine.loss, fine.neighbours, p_, ap_, sums_, fine.blocks,
                     channels_);
      const std::vector<double> pap = channel_sums();
      ChannelScalars alpha{}, beta{};
      std::array<double, 3> gain{};
      for (int c = 0; c < channels_; ++c) {
        const double a = pap[c] > 0 ? rz[c] / pap[c] : 0.0;
        alpha.value[c] = static_cast<float>(a);
        gain[c] = a * rz[c];
        energy[c] += gain[c];
      }
      gains.push_back(gain);
      advance_.enqueue(queue, global, local, p_, ap_, solution_, fine.b, sums_, alpha, fine.blocks, channels_);
      const double residual = relative_residual(channel_sums());
      ++result.iterations;
      double estimate = 0;
      for (int c = 0; c < channels_; ++c) {
        if (energy[c] <= 0) continue;
        double recent = gain[c];
        if (gains.size() > 1) recent += gains[gains.size() - 2][c];
        estimate = std::max(estimate, std::sqrt(recent / energy[c]));
      }
      result.error_estimate = estimate;
      if (progress) progress(std::min(1.0, std::log(std::max(estimate, 1e-12)) / std::log(settings_.tolerance)));
      if (result.iterations - started >= 2 && estimate <= settings_.tolerance && residual <= kResidualGoal) break;
      if (!first_round && result.iterations - started >= 6) break;
      v_cycle(0);
      const std::vector<double> rz_next = dot(fine.b, fine.y);
      for (int c = 0; c < channels_; ++c) beta.value[c] = rz[c] > 0 ? static_cast<float>(rz_next[c] / rz[c]) : 0.0f;
      direction_.enqueue(queue, global, local, fine.y, p_, beta, fine.blocks, channels_);
      rz = rz_next;
    }
    converged = result.iterations >= settings_.max_iterations;
  }
  residual_.enqueue(queue, global, local, fine.conductance, fine.loss, fine.neighbours, q_, solution_, fine.b, sums_,
                    fine.blocks, channels_);
  result.residual_sum = relative_residual(channel_sums());
  const std::vector<float> padded = session_.read(queue, solution_);
  for (int c = 0; c < channels_; ++c) {
    std::copy_n(padded.begin() + c * (stride + kVoxels), stride, result.u.begin() + c * stride);
  }
  return result;
}

}  // namespace turbid
