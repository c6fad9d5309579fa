// SPDX-License-Identifier: Apache-2.0
// Enqueues steps in place, local and crossing in turn, each followed by the exchange at the special faces.
#include "host/transport/global_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/transport/lattice_medium.h"

namespace turbid {

GlobalLattice::GlobalLattice(cl::Session& session, const DiffusionMedium& diffusion, const LatticeSettings& settings)
    : LatticeScheme(diffusion, settings), session_(session), rows_(make_global_rows(diffusion)),
      channels_(diffusion.channels), row_count_(static_cast<int>(rows_.rows.size())),
      face_count_(static_cast<int>(rows_.faces.size())) {
  program_ = session.build("global_lattice.cl", {{"TURBID_COLLISION", static_cast<long>(settings.collision)}});
  step_ = {program_, "step_in_place"};
  exchange_ = {program_, "exchange"};
  const std::size_t places = rows_.place_count, stride = diffusion.stride();
  // Where no active voxel is, everything that arrives vanishes.
  std::vector<float> collision(2 * places * channels_, 1.0f);
  for (int c = 0; c < channels_; ++c) {
    float* p0 = collision.data() + 2 * places * c;
    for (std::size_t i = 0; i < stride; ++i) {
      if (diffusion.region[i] < 0) continue;
      const Collision k =
          collision_coefficients(settings.collision, diffusion.s[c * stride + i], diffusion.s_a[c * stride + i]);
      p0[rows_.places[i]] = static_cast<float>(k.p0);
      p0[places + rows_.places[i]] = static_cast<float>(k.p1);
    }
  }
  std::vector<std::array<std::int32_t, 4>> faces;
  std::vector<std::int32_t> axes;
  for (const GlobalFace& face : rows_.faces) {
    faces.push_back(face.places);
    axes.push_back(face.axis);
  }
  collision_ = session.upload(collision);
  rows_buffer_ = session.upload(rows_.rows);
  near_buffer_ = session.upload(rows_.near);
  faces_buffer_ = session.upload(faces);
  axes_buffer_ = session.upload(axes);
  links_buffer_ = session.upload(rows_.links);
  slots_ = session.zeros<float>(6 * places * channels_);
  source_ = session.zeros<float>(places * channels_);
  fluence_ = session.zeros<float>(places * channels_);
  sums_ = session.zeros<float>(4 * static_cast<std::size_t>(row_count_) * channels_);
  lost_ = session.zeros<float>(static_cast<std::size_t>(face_count_) * channels_);
}

std::size_t GlobalLattice::device_bytes() const {
  std::size_t bytes = rows_buffer_.bytes() + near_buffer_.bytes() + faces_buffer_.bytes() + axes_buffer_.bytes() +
                      links_buffer_.bytes();
  for (const F* buffer : {&slots_, &collision_, &source_, &fluence_, &sums_, &lost_}) bytes += buffer->bytes();
  return bytes;
}

void GlobalLattice::reset() {
  cl::Queue& queue = session_.lattice_queue();
  for (F* buffer : {&slots_, &source_, &fluence_}) session_.fill_zero(queue, *buffer);
  emitted_ = glm::dvec3(0);
  sweeps_ = first_sweep_ = 0;
}

void GlobalLattice::set_source(const std::vector<float>& q) {
  const std::size_t places = rows_.place_count, stride = diffusion_.stride();
  std::vector<float> scaled(places * channels_, 0.0f);
  emitted_ = glm::dvec3(0);
  for (int c = 0; c < channels_; ++c) {
    for (std::size_t i = 0; i < stride; ++i) {
      const std::size_t at = c * stride + i;
      if (diffusion_.region[i] < 0 || q[at] == 0.0f) continue;
      const Collision k = collision_coefficients(settings_.collision, diffusion_.s[at], diffusion_.s_a[at]);
      scaled[c * places + rows_.places[i]] = static_cast<float>(q[at] * k.source);
      emitted_[c] += q[at];
    }
  }
  session_.write(session_.lattice_queue(), source_, std::span<const float>(scaled));
}

void GlobalLattice::enqueue_step(bool measure) {
  cl::Queue& queue = session_.lattice_queue();
  const std::size_t channels = channels_;
  const int crossing = sweeps_ & 1;
  step_.enqueue(queue, {static_cast<std::size_t>(row_count_), channels}, {1, 1}, slots_, collision_, source_, rows_buffer_,
                near_buffer_, fluence_, sums_, row_count_, rows_.place_count, channels_, crossing, measure);
  exchange_.enqueue(queue, {static_cast<std::size_t>(face_count_), channels}, {64, 1}, slots_, faces_buffer_, axes_buffer_,
                    links_buffer_, lost_, face_count_, rows_.place_count, channels_, crossing, measure);
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
      const float* at = sums.data() + 4 * (static_cast<std::size_t>(c) * row_count_ + row);
      change += at[0];
      total += at[1];
    }
    if (!std::isfinite(change) || !std::isfinite(total)) return {std::numeric_limits<double>::quiet_NaN()};
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
      if (diffusion_.region[i] >= 0) result[c * stride + i] = from[rows_.places[i]];
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
    result.absorbed[c] = emitted_[c];
    for (int row = 0; row < row_count_; ++row) {
      const std::size_t at = 4 * (static_cast<std::size_t>(c) * row_count_ + row);
      result.absorbed[c] += first[at + 2];
      result.stored[c] += static_cast<double>(second[at + 3]) - first[at + 3];
    }
    for (int face = 0; face < face_count_; ++face) {
      const int towards = rows_.faces[face].open_towards;
      if (towards >= 0) result.escaped[towards][c] += lost[static_cast<std::size_t>(c) * face_count_ + face];
    }
  }
  return result;
}

}  // namespace turbid
