// SPDX-License-Identifier: Apache-2.0
// Conjugate-gradient steps. The device sums up its own step sizes; the host looks at them now and then, to see whether
// to stop.
#include "host/transport/steady.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace turbid {
namespace {

constexpr cl::Range kLocal{1, 1};
// Residual times preconditioned residual against the squared energy norm of the error: the smallest eigenvalue of the
// preconditioned operator was above 1/9 in all media tried (8 iterations to 1e-4 mean 1/4).
constexpr double kResidualToError = 3.0;
// What is still to be gained is continued geometrically. Twice the larger of the last two ratios of gains bounds the
// rest in all media tried (cases 18 and 19, `verify --hard`).
constexpr double kFallMargin = 2.0, kSlowestFall = 0.9;
// Three steps are needed in all media tried where the tolerance is below this, and few steps gain more than the factor.
constexpr double kSoonest = 1e-2, kMostPerStep = 12.0;

double ratio(double part, double whole) {
  return whole > 0 ? std::abs(part) / whole : 0.0;
}

/// Waits for the queue, also where something is thrown: it may still read q and write u.
struct Settled {
  cl::Queue& queue;
  ~Settled() { clFinish(queue.get()); }
};

/// In eight parts, which processors add at once.
double sum_of(std::span<const float> values) {
  double part[8]{};
  for (std::size_t i = 0; i + 8 <= values.size(); i += 8) {
    for (int j = 0; j < 8; ++j) part[j] += values[i + j];  // whole blocks: a multiple of 8
  }
  return ((part[0] + part[1]) + (part[2] + part[3])) + ((part[4] + part[5]) + (part[6] + part[7]));
}

/// The squared error that the gains of the last three steps foretell.
struct Foretold {
  double before = 0;  ///< before the last step: the last gain and what follows if gains go on as they fell last
  double bound = 0;   ///< after it, with a margin; never above `before`
};
Foretold foretell(double gain, double last, double before_last) {
  const double fall = last > 0 ? std::min(gain / last, kSlowestFall) : kSlowestFall;
  const double earlier = before_last > 0 ? last / before_last : kSlowestFall;
  const double slow = std::min(kFallMargin * std::max(fall, earlier), kSlowestFall);
  const double before = gain / (1 - fall);
  return {before, std::min(before, gain * slow / (1 - slow))};
}

}  // namespace

/// Conjugate gradients of one channel from a true residual on.
struct SteadySolve::Round {
  int first_step = 0;      ///< of this round
  bool fresh = false;      ///< the solution held nothing when it began
  double total = 0;        ///< sum of q
  int steps = 0;           ///< enqueued
  int seen = 0;            ///< of them, that the host has looked at
  double left = 0;         ///< sum of the residual
  double energy = 0;       ///< squared energy norm of the solution so far
  double alpha = 0;        ///< of the last step, which is not in the solution yet
  double for_balance = 0;  ///< to be added to it
  double estimate = 0, before_last = 0;
  std::vector<double> gains;
};

double SteadySolve::block_sum() {
  session_.read(session_.lattice_queue(), sums_, std::span<float>(host_sums_));
  return std::accumulate(host_sums_.begin(), host_sums_.begin() + levels_[0].blocks, 0.0);
}

double SteadySolve::dot_with_solution(const F& v) {
  const Level& fine = levels_[0];
  dot_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, solution_, v, sums_, channel_, fine.blocks);
  return block_sum();
}

void SteadySolve::residual() {
  Level& fine = levels_[0];
  residual_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, conductance_, loss_, fine.neighbours,
                    fine.b, solution_, fine.b, sums_, channel_, fine.blocks);
}

void SteadySolve::step(const Round& round) {
  Level& fine = levels_[0];
  const int number = round.steps, first = round.first_step;
  // The solution takes up each step one later, as that reads p anyway.
  const bool fresh = round.fresh && number == first + 1;
  next_step_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, conductance_, loss_, fine.neighbours,
                     fine.y, number > first ? p_ : fine.y, next_p_, fine.x, solution_, sums_, steps_, number, first,
                     fresh, padded_, turn(), channel_, fine.blocks);
  settle(TURBID_STEP * number + 1, 2);
  std::swap(p_, next_p_);
}

void SteadySolve::start_from_last(std::span<const float> q, Round& round) {
  // The multiple a x of the last answer that is nearest in the energy norm: a = x.q / x.A x. What is left is orthogonal
  // to it, so that the error is never larger than that of starting from zero, and |u|^2 = a x.q + |rest|^2.
  Level& fine = levels_[0];
  write_field(fine.b, q);
  const double xq = dot_with_solution(fine.b);
  residual();
  round.left = block_sum();
  const double x_a_x = xq - dot_with_solution(fine.b);
  double a = x_a_x > 0 && xq > 0 ? xq / x_a_x : 0.0;
  if (std::abs(a - 1) < 1e-6) a = 1;
  round.energy = a * xq;
  if (a == 1) return;
  scale_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, solution_, static_cast<float>(a), channel_,
                 fine.blocks);
  write_field(fine.b, q);
  residual();
  round.left = block_sum();
}

void SteadySolve::look(Round& round) {
  session_.read(session_.lattice_queue(), steps_, std::span<float>(host_steps_).first(TURBID_STEP * round.steps));
  for (; round.seen < round.steps; ++round.seen) {
    const float* found = host_steps_.data() + TURBID_STEP * round.seen;
    const double rz = found[0], pap = found[1], sum_s = found[2], gain = pap > 0 ? rz / pap * rz : 0.0;
    const int back = round.seen - round.first_step;
    const double last = back > 0 ? round.gains[round.seen - 1] : 0.0,
                 before_last = back > 1 ? round.gains[round.seen - 2] : 0.0;
    round.alpha = pap > 0 ? rz / pap : 0.0;
    round.energy += gain;
    round.left -= round.alpha * sum_s;
    round.gains.push_back(gain);
    // |error|^2 = sum of this and all later gains (Hestenes and Stiefel 1952).
    const Foretold error = foretell(gain, last, before_last);
    const double bound = std::sqrt(ratio(error.bound, round.energy));
    round.before_last = std::sqrt(ratio(error.before, round.energy));
    // What the balance lacks is made up for in the end: along p, to which the error is orthogonal, or by scaling;
    // whichever moves the solution less.
    const double along_p = sum_s != 0 ? round.left / sum_s : 0.0;
    const double by_p = std::abs(along_p) * std::sqrt(ratio(pap, round.energy)),
                 by_scaling = ratio(round.left, round.total);
    const bool choose_p = sum_s != 0 && by_p < by_scaling;
    round.for_balance = choose_p ? along_p : 0.0;
    round.estimate = choose_p ? std::hypot(bound, by_p) : bound + by_scaling;
  }
}

void SteadySolve::run_round(Round& round, const std::function<void(double)>& progress) {
  const double goal = settings_.tolerance;
  v_cycle(round.first_step, round.first_step);
  if (!round.fresh && round.first_step == 0) {
    const double at_start = kResidualToError * std::sqrt(ratio(block_sum(), round.energy));
    round.estimate = round.before_last = at_start;
    if (at_start + ratio(round.left, round.total) <= goal) return;
  }
  // A look costs as much as a kernel: not where a step can't have sufficed.
  int look_at = round.first_step + (round.fresh && goal < kSoonest ? 3 : 1);
  for (;;) {
    step(round);
    ++round.steps;
    const bool full = round.steps == settings_.max_iterations;
    if (round.steps >= look_at || full) {
      look(round);
      if (progress) {
        const double part = std::log(std::max(round.estimate, 1e-12)) / std::log(goal);
        progress((channel_ + std::clamp(part, 0.0, 1.0)) / channels_);
      }
      const bool again = round.first_step > 0 && round.steps - round.first_step >= 6;
      if (round.estimate <= goal || again || full) return;
      look_at = round.steps + (round.estimate > kMostPerStep * goal ? 2 : 1);
    }
    v_cycle(round.steps, round.first_step);
  }
}

void SteadySolve::finish_round(Round& round) {
  const Level& fine = levels_[0];
  const int done = round.steps - round.first_step;
  last_step_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, loss_, p_, solution_, sums_,
                     done > 0 ? static_cast<float>(round.alpha + round.for_balance) : 0.0f, round.fresh && done == 1,
                     channel_, fine.blocks);
  round.fresh = false;
  round.first_step = round.steps;
  round.left = round.total - block_sum();
}

void SteadySolve::solve_channel(std::span<const float> q, bool warm, SteadyResult& result, std::span<float> u,
                                const std::function<void(double)>& progress) {
  Level& fine = levels_[0];
  Round round;
  round.fresh = !warm;
  if (round.fresh) write_field(fine.b, q);
  round.left = round.total = sum_of(q);
  if (warm) start_from_last(q, round);
  // Each round starts from the true residual, so that rounding in the recursive one can't hide an imbalance; the second
  // and later rounds are iterative refinement.
  for (;;) {
    const int before = round.steps;
    run_round(round, progress);
    finish_round(round);
    if (ratio(round.left, round.total) <= settings_.tolerance || round.steps == before ||
        round.steps >= settings_.max_iterations)
      break;
    write_field(fine.b, q);
    residual();
  }
  const double found = round.total - round.left;
  read_field(solution_, round.total > 0 && found > 0 ? static_cast<float>(round.total / found) : 1.0f, u);
  result.iterations = std::max(result.iterations, round.steps);
  result.error_estimate = std::max(result.error_estimate, round.estimate);
  result.error_before_last = std::max(result.error_before_last, round.before_last);
  result.residual_sum = std::max(result.residual_sum, ratio(round.left, round.total));
  result.gains.resize(result.iterations);
  for (std::size_t i = 0; i < round.gains.size(); ++i) result.gains[i][channel_] = ratio(round.gains[i], round.energy);
}

SteadyResult SteadySolve::solve(const std::vector<float>& q, bool warm, const std::function<void(double)>& progress) {
  SteadyResult result;
  if (levels_[0].blocks == 0) return result;
  result.u.resize(q.size());
  back_ = false;
  const Settled settled{session_.lattice_queue()};
  for (channel_ = 0; channel_ < channels_; ++channel_) {
    const std::size_t first = channel_ * stride_;
    solve_channel(std::span(q).subspan(first, stride_), warm && solved_, result,
                  std::span(result.u).subspan(first, stride_), progress);
  }
  channel_ = 0;
  solved_ = true;
  return result;
}

}  // namespace turbid
