// SPDX-License-Identifier: Apache-2.0
// Enqueues steps in place, local and crossing in turn, each followed by the exchange at the special faces, if there are
// any.
#include "host/transport/global_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/transport/lattice_medium.h"

namespace turbid {
namespace {

constexpr int kVoxels = 512;
constexpr int kSums = 11;           // per row, global_lattice.cl
constexpr cl::Range kLocal{16, 1};  // the number of rows is a multiple of 64

}  // namespace

GlobalLattice::GlobalLattice(cl::Session& session, const DiffusionMedium& diffusion, const LatticeSettings& settings)
    : LatticeScheme(diffusion, settings),
      session_(session),
      rows_(make_global_rows(diffusion)),
      channels_(diffusion.channels),
      row_count_(static_cast<int>(rows_.rows.size())),
      block_count_(diffusion.blocks.count()),
      face_count_(static_cast<int>(rows_.faces.size())) {
  program_ = session.build("global_lattice.cl",
                           {{"TURBID_COLLISION", static_cast<long>(settings.collision)}, {"TURBID_HALF", half()}});
  steps_[0] = {program_, "step_local"};
  steps_[1] = {program_, "step_crossing"};
  measured_[0] = {program_, "measure_local"};
  measured_[1] = {program_, "measure_crossing"};
  exchange_ = {program_, "exchange"};
  const std::size_t places = rows_.place_count, stride = diffusion.stride(), blocks = block_count_;
  // Where no active voxel is, everything that arrives vanishes.
  std::vector<float> collision(2 * places * channels_, 1.0f);
  std::vector<std::array<float, 2>> even(blocks * channels_);
  for (int c = 0; c < channels_; ++c) {
    float* p0 = collision.data() + 2 * places * c;
    float* p1 = p0 + places;
    for (std::size_t i = 0; i < stride; ++i) {
      if (diffusion.region[i] < 0) continue;
      const Collision k =
          collision_coefficients(settings.collision, diffusion.s[c * stride + i], diffusion.s_a[c * stride + i]);
      p0[rows_.places[i]] = static_cast<float>(k.p0);
      p1[rows_.places[i]] = static_cast<float>(k.p1);
    }
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::int32_t* place = rows_.places.data() + block * kVoxels;
      const bool same = std::all_of(place, place + kVoxels,
                                    [&](std::int32_t i) { return p0[i] == p0[place[0]] && p1[i] == p1[place[0]]; });
      even[c * blocks + rows_.order[block]] = {same ? p0[place[0]] : -1.0f, p1[place[0]]};
    }
  }
  std::vector<std::array<std::int32_t, 4>> faces;
  for (const GlobalFace& face : rows_.faces) faces.push_back(face.places);
  collision_ = session.upload(collision);
  even_ = session.upload(even);
  rows_buffer_ = session.upload(rows_.rows);
  ends_ = session.upload(rows_.ends);
  end_walls_ = session.upload(rows_.end_walls);
  near_ = session.upload(rows_.near);
  walls_ = session.upload(rows_.walls);
  faces_ = session.upload(faces);
  links_ = session.upload(rows_.links);
  slots_ = session.zeros<std::byte>(6 * places * channels_ * stored_bytes());
  rest_ = session.zeros<std::byte>(half() ? places * channels_ * stored_bytes() : 0);
  source_ = session.zeros<float>(places * channels_);
  lit_ = session.zeros<std::int32_t>(blocks * channels_);
  fluence_ = session.zeros<float>(places * channels_);
  sums_ = session.zeros<float>(kSums * static_cast<std::size_t>(row_count_) * channels_);
  lost_ = session.zeros<float>(2 * static_cast<std::size_t>(face_count_) * channels_);
}

std::size_t GlobalLattice::device_bytes() const {
  std::size_t bytes = rows_buffer_.bytes() + ends_.bytes() + end_walls_.bytes() + near_.bytes() + faces_.bytes() +
                      links_.bytes() + slots_.bytes() + rest_.bytes() + even_.bytes() + lit_.bytes();
  for (const F* buffer : {&collision_, &source_, &walls_, &fluence_, &sums_, &lost_}) bytes += buffer->bytes();
  return bytes;
}

void GlobalLattice::reset() {
  cl::Queue& queue = session_.lattice_queue();
  for (F* buffer : {&source_, &fluence_}) session_.fill_zero(queue, *buffer);
  for (Bytes* buffer : {&slots_, &rest_}) session_.fill_zero(queue, *buffer);
  session_.fill_zero(queue, lit_);
  emitted_ = glm::dvec3(0);
  sweeps_ = first_sweep_ = 0;
}

void GlobalLattice::set_source(const std::vector<float>& q) {
  const std::size_t places = rows_.place_count, stride = diffusion_.stride(), blocks = block_count_;
  std::vector<float> scaled(places * channels_, 0.0f);
  std::vector<std::int32_t> lit(blocks * channels_, 0);
  if (choose_scale(q)) reset();
  emitted_ = glm::dvec3(0);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < stride; ++i) {
      const std::size_t at = c * stride + i;
      if (diffusion_.region[i] < 0 || q[at] == 0.0f) continue;
      const Collision k = collision_coefficients(settings_.collision, diffusion_.s[at], diffusion_.s_a[at]);
      scaled[c * places + rows_.places[i]] = static_cast<float>(scale_[c] * q[at] * k.source);
      lit[c * blocks + rows_.order[i / kVoxels]] = 1;
      emitted_[c] += q[at];
    }
  }
  session_.write(session_.lattice_queue(), source_, std::span<const float>(scaled));
  session_.write(session_.lattice_queue(), lit_, std::span<const std::int32_t>(lit));
}

void GlobalLattice::enqueue_step(bool measure) {
  cl::Queue& queue = session_.lattice_queue();
  const std::size_t channels = channels_;
  const int crossing = sweeps_ & 1;
  const cl::Range global{static_cast<std::size_t>(row_count_), channels};
  if (measure) {
    measured_[crossing].enqueue(queue, global, kLocal, slots_, rest_, collision_, even_, source_, lit_, rows_buffer_,
                                ends_, end_walls_, near_, walls_, row_count_, block_count_, rows_.wall_count,
                                rows_.place_count, channels_, fluence_, sums_);
  } else {
    steps_[crossing].enqueue(queue, global, kLocal, slots_, rest_, collision_, even_, source_, lit_, rows_buffer_,
                             ends_, end_walls_, near_, walls_, row_count_, block_count_, rows_.wall_count,
                             rows_.place_count, channels_);
  }
  exchange_.enqueue(queue, {static_cast<std::size_t>(face_count_), channels}, {64, 1}, slots_, faces_, links_, lost_,
                    face_count_, rows_.place_count, channels_, crossing, measure);
  ++sweeps_;
}

void GlobalLattice::enqueue_sweeps(int count) {
  // The change of one step needs the fluence of the one before.
  for (int i = 0; i < count; ++i) enqueue_step(i >= count - 2);
  cl::check(clFlush(session_.lattice_queue().get()), "starting the lattice");
}

LatticeScheme::Change GlobalLattice::read_change() {
  const std::vector<float> sums = session_.read(session_.lattice_queue(), sums_);
  Change result;
  for (int c = 0; c < channels_; ++c) {
    double change = 0, total = 0;
    for (int row = 0; row < row_count_; ++row) {
      const float* at = sums.data() + kSums * (static_cast<std::size_t>(c) * row_count_ + row);
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

std::vector<float> GlobalLattice::read_fluence() {
  const std::vector<float> values = session_.read(session_.lattice_queue(), fluence_);
  const std::size_t stride = diffusion_.stride();
  std::vector<float> result(stride * channels_, 0.0f);
  for (int c = 0; c < channels_; ++c) {
    const float* from = values.data() + static_cast<std::size_t>(c) * rows_.place_count;
    for (std::size_t i = 0; i < stride; ++i) {
      if (diffusion_.region[i] >= 0) result[c * stride + i] = static_cast<float>(from[rows_.places[i]] / scale_[c]);
    }
  }
  return result;
}

LatticeEnergy GlobalLattice::read_energy() {
  cl::Queue& queue = session_.lattice_queue();
  LatticeEnergy result;
  enqueue_step(true);
  const std::vector<float> first = session_.read(queue, sums_), lost = session_.read(queue, lost_);
  enqueue_step(true);
  const std::vector<float> second = session_.read(queue, sums_);
  for (int c = 0; c < channels_; ++c) {
    double absorbed = 0;
    for (int row = 0; row < row_count_; ++row) {
      const std::size_t at = kSums * (static_cast<std::size_t>(c) * row_count_ + row);
      absorbed += first[at + 2];
      for (int side = 0; side < 6; ++side) result.escaped[side][c] += first[at + 4 + side] / scale_[c];
      result.stored[c] += (static_cast<double>(second[at + 3]) - first[at + 3]) / scale_[c];
      result.rounding[c] += first[at + 10] / scale_[c];
    }
    result.absorbed[c] = emitted_[c] + absorbed / scale_[c];
    for (int face = 0; face < face_count_; ++face) {
      const int towards = rows_.faces[face].open_towards;
      if (towards >= 0)
        result.escaped[towards][c] += lost[static_cast<std::size_t>(c) * face_count_ + face] / scale_[c];
      result.rounding[c] += lost[static_cast<std::size_t>(channels_ + c) * face_count_ + face] / scale_[c];
    }
  }
  return result;
}

}  // namespace turbid
