// SPDX-License-Identifier: Apache-2.0
// Interface buffers are double: sweep n reads those of sweep n - 1 and writes its own, so neither the order of the
// blocks nor the number of queues can change a bit.
#include "host/transport/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace turbid {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr int kSums = 5, kDepartures = 7;  // per block, lattice.cl
constexpr cl::Range kLocal{1, 1};

}  // namespace

Lattice::Lattice(cl::Session& session, const DiffusionMedium& diffusion, const LatticeSettings& settings)
    : LatticeScheme(diffusion, settings),
      session_(session),
      medium_(make_lattice_medium(diffusion, settings)),
      channels_(diffusion.channels),
      blocks_(medium_.blocks.count()) {
  program_ = session.build("lattice.cl", {{"TURBID_EDGE", settings.block_edge},
                                          {"TURBID_COLLISION", static_cast<long>(settings.collision)},
                                          {"TURBID_HALF", half()}});
  sweep_ = {program_, "sweep"};
  departures_ = {program_, "departures"};
  collision_ = session.upload(medium_.collision);
  even_ = session.upload(medium_.even);
  wall_block_ = session.upload(medium_.wall_block);
  walls_ = session.upload(medium_.walls);
  first_face_ = session.upload(medium_.first_face);
  faces_ = session.upload(medium_.faces);
  open_towards_ = session.upload(medium_.open_towards);
  shares_ = session.upload(medium_.shares);
  neighbours_ = session.upload(medium_.neighbours);
  const std::size_t size = medium_.stride() * channels_, per_channel = static_cast<std::size_t>(blocks_) * channels_;
  const int face = settings.block_edge * settings.block_edge;
  source_ = session.zeros<float>(size);
  lit_ = session.zeros<std::int32_t>(per_channel);
  fluence_ = session.zeros<float>(size);
  populations_ = session.zeros<std::byte>(6 * size * stored_bytes());
  rest_ = session.zeros<std::byte>(half() ? size * stored_bytes() : 0);
  for (F& buffer : interfaces_)
    buffer = session.zeros<float>(static_cast<std::size_t>(blocks_ + 1) * 6 * face * channels_);
  sums_ = session.zeros<float>(per_channel * kSums);
  departing_ = session.zeros<float>(per_channel * kDepartures);
}

std::size_t Lattice::device_bytes() const {
  std::size_t bytes = even_.bytes() + shares_.bytes() + populations_.bytes() + rest_.bytes();
  for (const F* buffer :
       {&collision_, &source_, &walls_, &fluence_, &sums_, &departing_, &interfaces_[0], &interfaces_[1]}) {
    bytes += buffer->bytes();
  }
  for (const I* buffer : {&lit_, &wall_block_, &first_face_, &faces_, &open_towards_, &neighbours_})
    bytes += buffer->bytes();
  return bytes;
}

void Lattice::reset() {
  cl::Queue& queue = session_.lattice_queue();
  for (F* buffer : {&source_, &fluence_, &interfaces_[0], &interfaces_[1]}) session_.fill_zero(queue, *buffer);
  for (Bytes* buffer : {&populations_, &rest_}) session_.fill_zero(queue, *buffer);
  session_.fill_zero(queue, lit_);
  emitted_ = glm::dvec3(0);
  crossing_next_ = 1;
  sweeps_ = first_sweep_ = 0;
}

void Lattice::set_source(const std::vector<float>& q) {
  const std::size_t per_block = medium_.voxels();
  std::vector<float> scaled(medium_.stride() * channels_, 0.0f);
  std::vector<std::int32_t> lit(static_cast<std::size_t>(blocks_) * channels_, 0);
  if (choose_scale(q)) reset();
  emitted_ = glm::dvec3(0);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < medium_.stride(); ++i) {
      if (medium_.origin[i] == kNone) continue;
      const std::size_t at = c * medium_.stride() + i;
      const float power = q[c * diffusion_.stride() + medium_.origin[i]];
      if (power == 0.0f) continue;
      scaled[at] = static_cast<float>(scale_[c] * power) * medium_.source_factor[at];
      lit[at / per_block] = 1;
      emitted_[c] += power;
    }
  }
  session_.write(session_.lattice_queue(), source_, std::span<const float>(scaled));
  session_.write(session_.lattice_queue(), lit_, std::span<const std::int32_t>(lit));
}

void Lattice::enqueue_sweeps(int count, int inner) {
  cl::Queue& queue = session_.lattice_queue();
  const cl::Range global{static_cast<std::size_t>(blocks_), static_cast<std::size_t>(channels_)};
  for (int i = 0; i < count; ++i, ++sweeps_) {
    sweep_.enqueue(queue, global, kLocal, collision_, even_, source_, lit_, wall_block_, walls_, first_face_, faces_,
                   shares_, neighbours_, interfaces_[sweeps_ & 1], interfaces_[(sweeps_ + 1) & 1], populations_, rest_,
                   fluence_, sums_, blocks_, medium_.wall_blocks, channels_, inner, 1 - crossing_next_);
    crossing_next_ ^= inner & 1;
  }
  cl::check(clFlush(queue.get()), "starting the lattice");
}

Lattice::Change Lattice::read_change() {
  const std::vector<float> sums = session_.read(session_.lattice_queue(), sums_);
  Change result;
  for (int c = 0; c < channels_; ++c) {
    double change = 0, total = 0;
    for (int block = 0; block < blocks_; ++block) {
      const float* at = sums.data() + kSums * (static_cast<std::size_t>(c) * blocks_ + block);
      change += at[0];
      total += at[1];
    }
    // A lattice that has overflowed must not look like one that has come to rest.
    if (!std::isfinite(change) || !std::isfinite(total)) return {.relative = std::numeric_limits<double>::quiet_NaN()};
    result.total[c] = total;
    if (total > 0) result.relative = std::max(result.relative, change / total);
  }
  return result;
}

std::vector<float> Lattice::read_fluence() {
  const std::vector<float> values = session_.read(session_.lattice_queue(), fluence_);
  std::vector<float> result(diffusion_.stride() * channels_, 0.0f);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < medium_.stride(); ++i) {
      if (medium_.origin[i] != kNone)
        result[c * diffusion_.stride() + medium_.origin[i]] =
            static_cast<float>(values[c * medium_.stride() + i] / scale_[c]);
    }
  }
  return result;
}

void Lattice::settle() {
  enqueue_sweeps(1, 1);
  if (!crossing_next_) enqueue_sweeps(1, 1);
}

LatticeEnergy Lattice::read_energy() {
  cl::Queue& queue = session_.lattice_queue();
  if (!crossing_next_) enqueue_sweeps(1, 1);
  departures_.enqueue(queue, {static_cast<std::size_t>(blocks_), static_cast<std::size_t>(channels_)}, kLocal,
                      wall_block_, walls_, first_face_, faces_, open_towards_, shares_, interfaces_[sweeps_ & 1],
                      populations_, rest_, departing_, blocks_, medium_.wall_blocks, channels_);
  enqueue_sweeps(1, 1);
  const std::vector<float> departing = session_.read(queue, departing_), sums = session_.read(queue, sums_);
  LatticeEnergy result;
  for (int c = 0; c < channels_; ++c) {
    double absorbed = 0;
    for (int block = 0; block < blocks_; ++block) {
      const std::size_t at = static_cast<std::size_t>(c) * blocks_ + block;
      const float *last = sums.data() + kSums * at, *before = departing.data() + kDepartures * at;
      absorbed += last[2];
      // Storing comes after the sum of what departs, and does not touch what was sent.
      result.stored[c] += (static_cast<double>(last[3]) - last[4] - before[0]) / scale_[c];
      result.rounding[c] += last[4] / scale_[c];
      for (int face = 0; face < 6; ++face) result.escaped[face][c] += before[1 + face] / scale_[c];
    }
    result.absorbed[c] = emitted_[c] + absorbed / scale_[c];
  }
  return result;
}

}  // namespace turbid
