// SPDX-License-Identifier: Apache-2.0
// The steady solve's device side: its levels, the V-cycle over them, fields in and out.
#include <algorithm>

#include "host/transport/steady.h"

namespace turbid {
namespace {

constexpr cl::Range kLocal{1, 1};

/// The levels of one block each as one: [level][channel][block, zeros][voxel].
MultigridLevel joined(const std::vector<MultigridLevel>& levels, std::size_t first) {
  MultigridLevel tail = levels[first];
  tail.neighbours.assign(6, 1);
  tail.parent = {0, 1};
  tail.octant.clear();
  for (std::size_t i = first; i < levels.size(); ++i) {
    if (i > first) tail.rounded.insert(tail.rounded.end(), levels[i].rounded.begin(), levels[i].rounded.end());
    tail.octant.push_back(levels[i].octant.empty() ? 0 : levels[i].octant[0]);
    tail.octant.push_back(0);
  }
  return tail;
}

}  // namespace

SteadySolve::SteadySolve(cl::Session& session, const DiffusionMedium& medium, const SteadySettings& settings)
    : session_(session), settings_(settings), channels_(medium.channels), stride_(medium.stride()) {
  program_ = session.build("steady.cl", {});
  settle_ = {program_, "settle"};
  pack_ = {program_, "pack"};
  unpack_ = {program_, "unpack"};
  next_step_ = {program_, "next_step"};
  last_step_ = {program_, "last_step"};
  residual_ = {program_, "true_residual"};
  descend_ = {program_, "descend"};
  descend_coarse_ = {program_, "descend_coarse"};
  ascend_ = {program_, "ascend"};
  ascend_coarse_ = {program_, "ascend_coarse"};
  coarse_cycle_ = {program_, "coarse_cycle"};
  dot_ = {program_, "dot_product"};
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
    level.rounded = session.upload(from.rounded);
    level.neighbours = session.upload(from.neighbours);
    level.children = session.upload(from.children);
    level.parent = session.upload(from.parent);
    level.octant = session.upload(from.octant);
    const std::size_t size = from.rounded.size() / 2 / channels_;
    for (F* field : {&level.b, &level.x, &level.y}) *field = session.zeros<float>(size);
    level.handed = session.zeros<float>(size / TURBID_BLOCK_VOXELS * TURBID_HANDED);
    levels_.push_back(std::move(level));
  }
  conductance_ = session.upload(levels[0].conductance);
  loss_ = session.upload(levels[0].loss);
  solution_ = session.zeros<float>(levels[0].loss.size());
  for (F* field : {&p_, &next_p_}) *field = session.zeros<float>(levels_[0].b.count());
  padded_ = (levels_[0].blocks + 15) / 16 * 16;
  host_sums_.resize(padded_);
  sums_ = session.zeros<float>(2 * host_sums_.size());
  host_steps_.resize(TURBID_STEP * (static_cast<std::size_t>(settings.max_iterations) + 1));
  steps_ = session.zeros<float>(host_steps_.size());
  lost_ = session.zeros<float>(channels_);
  only_child_ = session.upload(std::vector<std::int32_t>{0, 1, 1, 1, 1, 1, 1, 1});
}

std::size_t SteadySolve::device_bytes() const {
  std::size_t bytes = conductance_.bytes() + loss_.bytes() + solution_.bytes() + p_.bytes() + next_p_.bytes() +
                      sums_.bytes() + steps_.bytes() + lost_.bytes() + only_child_.bytes();
  for (const Level& level : levels_) {
    for (const F* field : {&level.b, &level.x, &level.y, &level.handed}) bytes += field->bytes();
    bytes += level.rounded.bytes();
    for (const I* field : {&level.neighbours, &level.children, &level.parent, &level.octant}) bytes += field->bytes();
  }
  return bytes;
}

void SteadySolve::coarse_correction() {
  cl::Queue& queue = session_.lattice_queue();
  const int sweeps = settings_.smoothing_sweeps;
  const std::size_t last = levels_.size() - 1;
  for (std::size_t i = 1; i < last; ++i) {
    Level &level = levels_[i], &finer = levels_[i - 1];
    descend_coarse_.enqueue(queue, all_blocks(level), kLocal, level.rounded, level.neighbours, level.children,
                            finer.neighbours, finer.handed, level.b, level.x, level.handed, finer.blocks, sweeps,
                            channel_, level.blocks);
  }
  Level &tail = levels_[last], &finer = levels_[last - 1];
  coarse_cycle_.enqueue(queue, {1, 1}, kLocal, tail.rounded, tail.neighbours, tail.children, finer.neighbours,
                        finer.handed, only_child_, tail.parent, tail.octant, tail.b, tail.x, tail.y, tail.handed,
                        tail_levels_, finer.blocks, sweeps, channel_, channels_);
  for (std::size_t i = last - 1; i >= 1; --i) {
    Level &level = levels_[i], &coarse = levels_[i + 1];
    ascend_coarse_.enqueue(queue, all_blocks(level), kLocal, level.rounded, level.neighbours, level.b, level.x,
                           coarse.y, level.parent, level.octant, level.y, sweeps, channel_, level.blocks);
  }
}

void SteadySolve::v_cycle(int step, int first) {
  cl::Queue& queue = session_.lattice_queue();
  Level &fine = levels_[0], &coarse = levels_[1];
  const int sweeps = settings_.smoothing_sweeps;
  // x holds A p until the block that needs it has taken it off b, and from then on what is smoothed.
  descend_.enqueue(queue, all_blocks(fine), kLocal, fine.rounded, fine.neighbours, fine.x, fine.b, fine.x, fine.handed,
                   steps_, step, first, sweeps, channel_, fine.blocks);
  coarse_correction();
  ascend_.enqueue(queue, all_blocks(fine), kLocal, fine.rounded, fine.neighbours, fine.b, fine.x, coarse.y, fine.parent,
                  fine.octant, fine.y, sums_, sweeps, channel_, fine.blocks);
  settle(steps_, TURBID_STEP * step, 1);
}

void SteadySolve::settle(F& to, int at, int parts) {
  settle_.enqueue(session_.lattice_queue(), {1, 1}, kLocal, sums_, to, at, parts, padded_);
}

void SteadySolve::write_field(F& buffer, std::span<const float> values) {
  session_.write(session_.lattice_queue(), next_p_, values, false);
  pack_.enqueue(session_.lattice_queue(), all_blocks(levels_[0]), kLocal, next_p_, buffer, levels_[0].blocks);
}

void SteadySolve::read_field(const F& buffer, float total, std::span<float> values) {
  unpack_.enqueue(session_.lattice_queue(), all_blocks(levels_[0]), kLocal, buffer, next_p_, lost_, total, channel_,
                  levels_[0].blocks);
  session_.read(session_.lattice_queue(), next_p_, values, false);
}

void SteadySolve::apply(const F& x, F& out) {
  const Level& fine = levels_[0];
  next_step_.enqueue(session_.lattice_queue(), all_blocks(fine), kLocal, conductance_, loss_, fine.neighbours, x, x,
                     next_p_, out, solution_, sums_, steps_, 0, 0, 0, padded_, channel_, fine.blocks);
}

}  // namespace turbid
