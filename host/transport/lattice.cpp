// SPDX-License-Identifier: Apache-2.0
// Interface buffers are double: sweep n reads those of sweep n - 1 and writes its own, so neither the order of the blocks nor
// the number of queues can change a bit.
#include "host/transport/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace turbid {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

}  // namespace

Lattice::Lattice(cl::Session& session, const DiffusionMedium& diffusion, const LatticeSettings& settings)
    : LatticeScheme(diffusion, settings), session_(session), medium_(make_lattice_medium(diffusion, settings)),
      channels_(diffusion.channels), blocks_(medium_.blocks.count()) {
  program_ = session.build("lattice.cl", {{"TURBID_EDGE", settings.block_edge},
                                          {"TURBID_COLLISION", static_cast<long>(settings.collision)}});
  sweep_ = {program_, "sweep"};
  balance_ = {program_, "balance"};
  collision_ = session.upload(medium_.collision);
  links_ = session.upload(medium_.links);
  link_block_ = session.upload(medium_.link_block);
  neighbours_ = session.upload(medium_.neighbours);
  const std::size_t size = medium_.stride() * channels_;
  const int face = settings.block_edge * settings.block_edge;
  source_ = session.zeros<float>(size);
  injected_ = session.zeros<float>(size);
  fluence_ = session.zeros<float>(size);
  populations_ = session.zeros<float>(6 * size);
  for (F& buffer : interfaces_) buffer = session.zeros<float>(static_cast<std::size_t>(blocks_ + 1) * 6 * face * channels_);
  sums_ = session.zeros<float>(static_cast<std::size_t>(blocks_) * channels_ * 2);
  energy_ = session.zeros<float>(static_cast<std::size_t>(blocks_) * channels_ * 8);
}

std::size_t Lattice::device_bytes() const {
  std::size_t bytes = link_block_.bytes() + neighbours_.bytes();
  for (const F* buffer : {&collision_, &source_, &injected_, &links_, &populations_, &fluence_, &sums_, &energy_,
                          &interfaces_[0], &interfaces_[1]}) {
    bytes += buffer->bytes();
  }
  return bytes;
}

void Lattice::reset() {
  cl::Queue& queue = session_.lattice_queue();
  for (F* buffer : {&source_, &injected_, &fluence_, &populations_, &interfaces_[0], &interfaces_[1]}) {
    session_.fill_zero(queue, *buffer);
  }
  sweeps_ = first_sweep_ = 0;
}

void Lattice::set_source(const std::vector<float>& q) {
  std::vector<float> injected(medium_.stride() * channels_, 0.0f), scaled(injected.size(), 0.0f);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < medium_.stride(); ++i) {
      if (medium_.origin[i] == kNone) continue;
      const std::size_t at = c * medium_.stride() + i;
      injected[at] = q[c * diffusion_.stride() + medium_.origin[i]];
      scaled[at] = injected[at] * medium_.source_factor[at];
    }
  }
  session_.write(session_.lattice_queue(), injected_, std::span<const float>(injected));
  session_.write(session_.lattice_queue(), source_, std::span<const float>(scaled));
}

void Lattice::enqueue_sweeps(int count, int inner) {
  cl::Queue& queue = session_.lattice_queue();
  const cl::Range global{static_cast<std::size_t>(blocks_), static_cast<std::size_t>(channels_)}, local{1, 1};
  for (int i = 0; i < count; ++i, ++sweeps_) {
    sweep_.enqueue(queue, global, local, collision_, source_, link_block_, links_, neighbours_, interfaces_[sweeps_ & 1],
                   interfaces_[(sweeps_ + 1) & 1], populations_, fluence_, sums_, blocks_, medium_.link_blocks, channels_,
                   inner);
  }
  cl::check(clFlush(queue.get()), "starting the lattice");
}

Lattice::Change Lattice::read_change() {
  const std::vector<float> sums = session_.read(session_.lattice_queue(), sums_);
  Change result;
  for (int c = 0; c < channels_; ++c) {
    double change = 0, total = 0;
    for (int block = 0; block < blocks_; ++block) {
      change += sums[2 * (static_cast<std::size_t>(c) * blocks_ + block)];
      total += sums[2 * (static_cast<std::size_t>(c) * blocks_ + block) + 1];
    }
    // A lattice that has overflowed must not look like one that has come to rest.
    if (!std::isfinite(change) || !std::isfinite(total)) return {std::numeric_limits<double>::quiet_NaN()};
    if (total > 0) result.relative = std::max(result.relative, change / total);
  }
  return result;
}

std::vector<float> Lattice::read_fluence() {
  const std::vector<float> values = session_.read(session_.lattice_queue(), fluence_);
  std::vector<float> result(diffusion_.stride() * channels_, 0.0f);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < medium_.stride(); ++i) {
      if (medium_.origin[i] != kNone) result[c * diffusion_.stride() + medium_.origin[i]] = values[c * medium_.stride() + i];
    }
  }
  return result;
}

LatticeEnergy Lattice::read_energy() {
  cl::Queue& queue = session_.lattice_queue();
  const cl::Range global{static_cast<std::size_t>(blocks_), static_cast<std::size_t>(channels_)}, local{1, 1};
  balance_.enqueue(queue, global, local, collision_, source_, injected_, link_block_, links_, neighbours_,
                   interfaces_[sweeps_ & 1], populations_, energy_, blocks_, medium_.link_blocks, channels_);
  const std::vector<float> sums = session_.read(queue, energy_);
  LatticeEnergy result;
  for (int c = 0; c < channels_; ++c) {
    for (int block = 0; block < blocks_; ++block) {
      const float* at = sums.data() + 8 * (static_cast<std::size_t>(c) * blocks_ + block);
      result.absorbed[c] += at[0];
      for (int face = 0; face < 6; ++face) result.escaped[face][c] += at[1 + face];
      result.stored[c] += at[7];
    }
  }
  return result;
}

}  // namespace turbid
