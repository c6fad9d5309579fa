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
// Few steps gain more than this factor.
constexpr double kMostPerStep = 12.0;

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

/// Steps that it takes at least from one error to another.
int steps_between(double error, double goal) {
  return std::max(1, static_cast<int>(std::ceil(std::log(error / goal) / std::log(kMostPerStep))));
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
  std::vector<cl::EventHandle> read;  ///< of each step: its scalars have come
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
  residual_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, conductance_, loss_, fine.neighbours, fine.b,
                    solution_, fine.b, sums_, channel_, fine.blocks);
}

void SteadySolve::step(Round& round) {
  Level& fine = levels_[0];
  const int number = round.steps, first = round.first_step;
  // The solution takes up each step one later, as that reads p anyway.
  const bool fresh = round.fresh && number == first + 1;
  next_step_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, conductance_, loss_, fine.neighbours, fine.y,
                     number > first ? p_ : fine.y, next_p_, fine.x, solution_, sums_, steps_, number, first, fresh,
                     padded_, channel_, fine.blocks);
  settle(steps_, TURBID_STEP * number + 1, 2);
  std::swap(p_, next_p_);
  round.read.push_back(session_.read_part(session_.lattice_queue(), steps_, TURBID_STEP * number,
                                          std::span<float>(host_steps_).subspan(TURBID_STEP * number, TURBID_STEP)));
  ++round.steps;
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

void SteadySolve::look(Round& round, int until) {
  const cl_event last_read = round.read[until - 1].get();
  cl::check(clWaitForEvents(1, &last_read), "waiting for a step");
  for (; round.seen < until; ++round.seen) {
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
  const int limit =
      round.first_step > 0 ? std::min(round.first_step + 6, settings_.max_iterations) : settings_.max_iterations;
  int wanted = round.first_step + (round.fresh ? steps_between(1, goal) : 1);
  for (;;) {
    for (wanted = std::min(wanted, limit); round.steps < wanted;) {
      if (round.steps > round.first_step) v_cycle(round.steps, round.first_step);
      step(round);
    }
    // While one step is being looked at, the next already runs if it is needed anyway.
    look(round, std::max(round.seen + 1, round.steps - 1));
    if (progress) {
      const double part = std::log(std::max(round.estimate, 1e-12)) / std::log(goal);
      progress((channel_ + std::clamp(part, 0.0, 1.0)) / channels_);
    }
    const bool enough = round.estimate <= goal;
    if (round.seen == round.steps && (enough || round.steps == limit)) return;
    if (!enough) wanted = round.seen + std::min(2, steps_between(round.estimate, goal));
  }
}

bool SteadySolve::converged(const Round& round) const { return round.estimate <= settings_.tolerance; }

void SteadySolve::finish_round(Round& round, std::span<float> u) {
  const Level& fine = levels_[0];
  const int done = round.steps - round.first_step;
  const bool close = converged(round);  // a solve that was cut off keeps the imbalance that tells so
  last_step_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, loss_, p_, solution_, sums_,
                     done > 0 ? static_cast<float>(round.alpha + (close ? round.for_balance : 0.0)) : 0.0f,
                     round.fresh && done == 1, channel_, fine.blocks);
  settle(lost_, channel_, 1);
  read_field(solution_, close ? static_cast<float>(round.total) : 0.0f, u);
  round.fresh = false;
  round.first_step = round.steps;
}

void SteadySolve::start_channel(std::span<const float> q, bool warm, Round& round) {
  round.fresh = !warm;
  if (round.fresh) write_field(levels_[0].b, q);
  round.left = round.total = sum_of(q);
  if (warm) start_from_last(q, round);
}

void SteadySolve::find_left(std::vector<Round>& rounds) {
  const std::vector<float> lost = session_.read(session_.lattice_queue(), lost_);
  for (std::size_t c = 0; c < rounds.size(); ++c) rounds[c].left = rounds[c].total - lost[c];
}

SteadyResult SteadySolve::solve(const std::vector<float>& q, bool warm, const std::function<void(double)>& progress) {
  SteadyResult result;
  if (levels_[0].blocks == 0) return result;
  result.u.resize(q.size());
  const Settled settled{session_.lattice_queue()};
  const auto part = [this](auto& values) { return std::span(values).subspan(channel_ * stride_, stride_); };
  std::vector<Round> rounds(channels_);
  for (channel_ = 0; channel_ < channels_; ++channel_) {
    Round& round = rounds[channel_];
    start_channel(part(q), warm && solved_, round);
    run_round(round, progress);
    finish_round(round, part(result.u));
  }
  find_left(rounds);
  // Each round starts from the true residual, so that rounding in the recursive one can't hide an imbalance; the second
  // and later rounds, which few media need, are iterative refinement.
  for (channel_ = 0; channel_ < channels_; ++channel_) {
    Round& round = rounds[channel_];
    for (int before = 0; ratio(round.left, round.total) > settings_.tolerance && round.steps > before &&
                         round.steps < settings_.max_iterations;) {
      before = round.steps;
      write_field(levels_[0].b, part(q));
      residual();
      run_round(round, progress);
      finish_round(round, part(result.u));
      find_left(rounds);
    }
  }
  for (const Round& round : rounds) {
    result.iterations = std::max(result.iterations, round.steps);
    result.error_estimate = std::max(result.error_estimate, round.estimate);
    result.error_before_last = std::max(result.error_before_last, round.before_last);
    result.residual_sum = std::max(result.residual_sum, ratio(round.left, round.total));
    result.gains.resize(result.iterations);
    const std::size_t c = &round - rounds.data();
    for (std::size_t i = 0; i < round.gains.size(); ++i) result.gains[i][c] = ratio(round.gains[i], round.energy);
  }
  channel_ = 0;
  solved_ = true;
  return result;
}

}  // namespace turbid
