// SPDX-License-Identifier: Apache-2.0
// Enqueues V-cycles and conjugate-gradient steps; scalars live on the host, summed over blocks in double precision and in a
// fixed order.
#include "host/transport/steady.h"

#include <algorithm>
#include <cmath>

#include "host/base/parallel.h"

namespace turbid {
namespace {

constexpr int kVoxels = 512;
constexpr cl::Range kLocal{1, 1};
// Residual times preconditioned residual against the squared energy norm of the error: the smallest eigenvalue of the
// preconditioned operator was above 1/9 in all media tried (8 iterations to 1e-4 mean 1/4).
constexpr double kResidualToError = 3.0;

/// |sum r| / sum q that the energy balance may keep: well below its 1e-5, and below what the tolerance itself allows.
double residual_goal(double tolerance) { return std::clamp(0.03 * tolerance, 1e-6, 3e-6); }

double relative(const std::array<double, 3>& sum, const std::array<double, 3>& total) {
  double worst = 0;
  for (int c = 0; c < 3; ++c) {
    if (total[c] > 0) worst = std::max(worst, std::abs(sum[c]) / total[c]);
  }
  return worst;
}

/// sqrt of the largest part / whole over the channels.
double root_ratio(const std::array<double, 3>& part, const std::array<double, 3>& whole) {
  double worst = 0;
  for (int c = 0; c < 3; ++c) {
    if (whole[c] > 0) worst = std::max(worst, part[c] / whole[c]);
  }
  return std::sqrt(worst);
}

/// The levels of one block each as one: [level][channel][block, zeros][voxel].
MultigridLevel joined(const std::vector<MultigridLevel>& levels, std::size_t first) {
  MultigridLevel tail = levels[first];
  tail.neighbours.assign(6, 1);
  tail.parent = {0, 1};
  tail.octant.clear();
  for (std::size_t i = first; i < levels.size(); ++i) {
    if (i > first) {
      tail.conductance.insert(tail.conductance.end(), levels[i].conductance.begin(), levels[i].conductance.end());
      tail.loss.insert(tail.loss.end(), levels[i].loss.begin(), levels[i].loss.end());
    }
    tail.octant.push_back(levels[i].octant.empty() ? 0 : levels[i].octant[0]);
    tail.octant.push_back(0);
  }
  return tail;
}

}  // namespace

SteadySolve::SteadySolve(cl::Session& session, const DiffusionMedium& medium, const SteadySettings& settings)
    : session_(session), settings_(settings), channels_(medium.channels), stride_(medium.stride()) {
  program_ = session.build("steady.cl", {});
  apply_ = {program_, "apply"};
  residual_ = {program_, "true_residual"};
  smooth_down_ = {program_, "smooth_down"};
  smooth_up_ = {program_, "smooth_up"};
  restrict_ = {program_, "restrict_residual"};
  coarse_cycle_ = {program_, "coarse_cycle"};
  advance_ = {program_, "advance_solution"};
  dot_ = {program_, "dot_product"};
  direction_ = {program_, "next_direction"};
  scale_ = {program_, "scale"};
  std::vector<MultigridLevel> levels = build_multigrid(medium);
  std::size_t tail = 1;
  while (tail + 1 < levels.size() && levels[tail].blocks.count() > 1) ++tail;
  tail_levels_ = static_cast<int>(levels.size() - tail);
  levels[tail] = joined(levels, tail);
  for (std::size_t i = 0; i <= tail; ++i) {
    const MultigridLevel& from = levels[i];
    Level level;
    level.blocks = from.blocks.count();
    level.conductance = session.upload(from.conductance);
    level.loss = session.upload(from.loss);
    level.neighbours = session.upload(from.neighbours);
    level.parent = session.upload(from.parent);
    level.octant = session.upload(from.octant);
    for (F* field : {&level.b, &level.x, &level.y}) *field = session.zeros<float>(from.loss.size());
    levels_.push_back(std::move(level));
  }
  solution_ = session.zeros<float>(levels_[0].b.count());
  p_ = session.zeros<float>(levels_[0].b.count());
  sums_ = session.zeros<float>(static_cast<std::size_t>(levels_[0].blocks) * channels_);
}

std::size_t SteadySolve::device_bytes() const {
  std::size_t bytes = solution_.bytes() + p_.bytes() + sums_.bytes();
  for (const Level& level : levels_) {
    for (const F* field : {&level.conductance, &level.loss, &level.b, &level.x, &level.y}) bytes += field->bytes();
    for (const I* field : {&level.neighbours, &level.parent, &level.octant}) bytes += field->bytes();
  }
  return bytes;
}

void SteadySolve::v_cycle(std::size_t index) {
  cl::Queue& queue = session_.lattice_queue();
  Level& level = levels_[index];
  const int sweeps = settings_.smoothing_sweeps;
  if (index + 1 == levels_.size()) {
    coarse_cycle_.enqueue(queue, {static_cast<std::size_t>(channels_), 1}, kLocal, level.conductance, level.loss,
                          level.neighbours, level.parent, level.octant, level.b, level.x, level.y, tail_levels_, channels_,
                          sweeps);
    return;
  }
  const cl::Range global = blocks_by_channels(level);
  Level& coarse = levels_[index + 1];
  smooth_down_.enqueue(queue, global, kLocal, level.conductance, level.loss, level.neighbours, level.b, level.x, level.blocks,
                       channels_, sweeps);
  restrict_.enqueue(queue, global, kLocal, level.conductance, level.loss, level.neighbours, level.b, level.x, level.parent,
                    level.octant, coarse.b, level.blocks, coarse.blocks, channels_);
  v_cycle(index + 1);
  smooth_up_.enqueue(queue, global, kLocal, level.conductance, level.loss, level.neighbours, level.b, level.x, coarse.y,
                     level.parent, level.octant, level.y, sums_, level.blocks, coarse.blocks, channels_, sweeps);
}

void SteadySolve::apply(const F& x, F& out) {
  const Level& fine = levels_[0];
  apply_.enqueue(session_.lattice_queue(), blocks_by_channels(fine), kLocal, fine.conductance, fine.loss, fine.neighbours, x,
                 out, sums_, fine.blocks, channels_);
}

void SteadySolve::residual(const F& b, const F& x, F& r) {
  const Level& fine = levels_[0];
  residual_.enqueue(session_.lattice_queue(), blocks_by_channels(fine), kLocal, fine.conductance, fine.loss, fine.neighbours,
                    b, x, r, sums_, fine.blocks, channels_);
}

SteadySolve::PerChannel SteadySolve::dot(const F& u, const F& v) {
  const Level& fine = levels_[0];
  dot_.enqueue(session_.lattice_queue(), blocks_by_channels(fine), kLocal, u, v, sums_, fine.blocks, channels_);
  return channel_sums();
}

SteadySolve::PerChannel SteadySolve::channel_sums() {
  const std::vector<float> sums = session_.read(session_.lattice_queue(), sums_);
  PerChannel result{};
  const std::size_t blocks = levels_[0].blocks;
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t block = 0; block < blocks; ++block) result[c] += sums[c * blocks + block];
  }
  return result;
}

void SteadySolve::write_field(F& buffer, const std::vector<float>& values) {
  const auto& place = packed_places();
  staging_.assign(buffer.count(), 0.0f);
  parallel_ranges(levels_[0].blocks, [&](int begin, int end) {
    for (int c = 0; c < channels_; ++c) {
      for (int block = begin; block < end; ++block) {
        const float* from = values.data() + c * stride_ + block * std::size_t{kVoxels};
        float* to = staging_.data() + c * (stride_ + kVoxels) + block * std::size_t{kVoxels};
        for (int v = 0; v < kVoxels; ++v) to[place[v]] = from[v];
      }
    }
  });
  session_.write(session_.lattice_queue(), buffer, std::span<const float>(staging_));
}

std::vector<float> SteadySolve::read_field(const F& buffer) {
  const auto& place = packed_places();
  staging_.resize(buffer.count());
  session_.read(session_.lattice_queue(), buffer, std::span<float>(staging_));
  std::vector<float> values(stride_ * channels_);
  parallel_ranges(levels_[0].blocks, [&](int begin, int end) {
    for (int c = 0; c < channels_; ++c) {
      for (int block = begin; block < end; ++block) {
        const float* from = staging_.data() + c * (stride_ + kVoxels) + block * std::size_t{kVoxels};
        float* to = values.data() + c * stride_ + block * std::size_t{kVoxels};
        for (int v = 0; v < kVoxels; ++v) to[v] = from[place[v]];
      }
    }
  });
  return values;
}

SteadySolve::PerChannel SteadySolve::start_from_last(const std::vector<float>& q) {
  // The multiple a x of the last answer that is nearest in the energy norm: a = x.q / x.A x. What is left is orthogonal to it,
  // so that the error is never larger than that of starting from zero, and |u|^2 = a x.q + |rest|^2.
  Level& fine = levels_[0];
  write_field(fine.b, q);
  const PerChannel xq = dot(solution_, fine.b);
  residual(fine.b, solution_, fine.b);
  const PerChannel xr = dot(solution_, fine.b);
  ChannelScalars factor{};
  PerChannel energy{};
  bool changed = false;
  for (int c = 0; c < channels_; ++c) {
    const double x_a_x = xq[c] - xr[c];
    double a = x_a_x > 0 && xq[c] > 0 ? xq[c] / x_a_x : 0.0;
    if (std::abs(a - 1) < 1e-6) a = 1;
    factor.value[c] = static_cast<float>(a);
    energy[c] = a * xq[c];
    changed |= a != 1;
  }
  if (changed) {
    scale_.enqueue(session_.lattice_queue(), blocks_by_channels(fine), kLocal, solution_, factor, fine.blocks, channels_);
  }
  return energy;
}

void SteadySolve::advance(const ChannelScalars& alpha) {
  Level& fine = levels_[0];
  advance_.enqueue(session_.lattice_queue(), blocks_by_channels(fine), kLocal, p_, fine.x, solution_, fine.b, sums_, alpha,
                   fine.blocks, channels_);
}

void SteadySolve::run_round(bool first, PerChannel total, PerChannel& energy, SteadyResult& result,
                            const std::function<void(double)>& progress) {
  cl::Queue& queue = session_.lattice_queue();
  Level& fine = levels_[0];
  const double goal = residual_goal(settings_.tolerance);
  const int started = result.iterations;
  v_cycle(0);
  PerChannel rz = channel_sums();
  const double at_start = kResidualToError * root_ratio(rz, energy);
  const bool warm = first && *std::max_element(energy.begin(), energy.end()) > 0;
  if (warm && at_start <= settings_.tolerance && result.residual_sum <= goal) {
    result.error_estimate = at_start;
    return;
  }
  session_.copy(queue, fine.y, p_);
  PerChannel last{};
  while (result.iterations < settings_.max_iterations) {
    apply(p_, fine.x);  // fine.x is free between V-cycles
    const PerChannel pap = channel_sums();
    ChannelScalars alpha{}, beta{};
    PerChannel gain{}, before_last{};
    for (int c = 0; c < channels_; ++c) {
      const double a = pap[c] > 0 ? rz[c] / pap[c] : 0.0;
      alpha.value[c] = static_cast<float>(a);
      gain[c] = a * rz[c];
      energy[c] += gain[c];
      // |error|^2 = sum of this and all later gains (Hestenes and Stiefel 1952), the later ones continued as they fall off.
      const double fall = last[c] > 0 ? std::min(gain[c] / last[c], 0.9) : 0.9;
      before_last[c] = gain[c] / (1.0 - fall);
    }
    last = gain;
    result.gains.push_back(gain);
    advance(alpha);
    const double residual = relative(channel_sums(), total);
    ++result.iterations;
    const double estimate = root_ratio(before_last, energy);
    result.error_estimate = estimate;
    if (progress) progress(std::min(1.0, std::log(std::max(estimate, 1e-12)) / std::log(settings_.tolerance)));
    const int done = result.iterations - started;
    if (done >= 2 && estimate <= settings_.tolerance && residual <= goal) return;
    if (!first && done >= 6) return;
    v_cycle(0);
    const PerChannel rz_next = channel_sums();
    for (int c = 0; c < channels_; ++c) beta.value[c] = rz[c] > 0 ? static_cast<float>(rz_next[c] / rz[c]) : 0.0f;
    direction_.enqueue(queue, blocks_by_channels(fine), kLocal, fine.y, p_, beta, fine.blocks, channels_);
    rz = rz_next;
  }
}

SteadyResult SteadySolve::solve(const std::vector<float>& q, bool warm, const std::function<void(double)>& progress) {
  SteadyResult result;
  Level& fine = levels_[0];
  if (fine.blocks == 0) return result;
  PerChannel total{}, energy{};  // energy: squared energy norm of the solution so far
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < stride_; ++i) total[c] += q[c * stride_ + i];
  }
  if (warm && solved_) {
    energy = start_from_last(q);
  } else {
    session_.fill_zero(session_.lattice_queue(), solution_);
  }
  // Each round starts from the true residual, so that rounding in the recursive one can't hide an imbalance; the second and
  // later rounds are iterative refinement.
  for (bool first = true;; first = false) {
    write_field(fine.b, q);
    residual(fine.b, solution_, fine.b);
    result.residual_sum = relative(channel_sums(), total);
    const bool settled = result.residual_sum <= residual_goal(settings_.tolerance);
    if (!first && (settled || result.iterations >= settings_.max_iterations)) break;
    const int before = result.iterations;
    run_round(first, total, energy, result, progress);
    if (result.iterations == before) break;
  }
  for (auto& gain : result.gains) {
    for (int c = 0; c < channels_; ++c) gain[c] = energy[c] > 0 ? gain[c] / energy[c] : 0.0;
  }
  result.u = read_field(solution_);
  solved_ = true;
  return result;
}

}  // namespace turbid
