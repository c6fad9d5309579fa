// SPDX-License-Identifier: Apache-2.0
// The reference numbers its blocks along rows; the diffusion medium along a curve.
#include "host/bench/measure_blocks.h"

#include <cmath>
#include <limits>

#include "host/bench/figures.h"
#include "host/bench/hard_media.h"
#include "host/bench/reference_lattice.h"
#include "host/profile/spread.h"
#include "host/transport/lattice_medium.h"
#include "host/transport/lattice_scheme.h"

namespace turbid {
namespace {

constexpr int kVoxels = 512, kInner = 8, kSweeps = 4;
constexpr double kRounding = 1e-5;  // 32 steps in single precision, summed in another order: 7e-8 measured

/// Number of each block of the medium in the reference's order.
std::vector<std::size_t> row_order(const DiffusionMedium& medium) {
  const glm::ivec3 size = medium.blocks.dimensions();
  std::vector<std::size_t> order;
  for (int block = 0; block < medium.blocks.count(); ++block) {
    const glm::ivec3 at = medium.blocks.coordinates(block);
    order.push_back(at.x + static_cast<std::size_t>(size.x) * (at.y + size.y * at.z));
  }
  return order;
}

reference::LatticeCube reference_cube(const DiffusionMedium& medium, const std::vector<float>& q) {
  const std::size_t stride = medium.stride(), size = stride * medium.channels;
  const std::vector<std::size_t> order = row_order(medium);
  reference::LatticeCube cube{.n = medium.frame.voxels.x,
                              .channels = medium.channels,
                              .reflection = 0,
                              .p0 = std::vector<float>(size),
                              .p1 = std::vector<float>(size),
                              .q0 = std::vector<float>(size)};
  const float c = medium.boundary.at(0).c[0];  // the same on all faces: flat ones, half a voxel away
  cube.reflection = (c - 1.0f) / (c + 1.0f);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t channel = i / stride, block = i % stride / kVoxels;
    const std::size_t to = channel * stride + order[block] * kVoxels + i % kVoxels;
    const Collision k = collision_coefficients(CollisionVariant::trt, medium.s[i], medium.s_a[i]);
    cube.p0[to] = static_cast<float>(k.p0);
    cube.p1[to] = static_cast<float>(k.p1);
    cube.q0[to] = static_cast<float>(q[i] * k.source);
  }
  return cube;
}

double difference(const DiffusionMedium& medium, const std::vector<float>& ours, const std::vector<float>& reference) {
  const std::size_t stride = medium.stride();
  const std::vector<std::size_t> order = row_order(medium);
  double apart = 0, norm = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const double theirs = reference[i / stride * stride + order[i % stride / kVoxels] * kVoxels + i % kVoxels];
    apart += std::pow(ours[i] - theirs, 2);
    norm += theirs * theirs;
  }
  return std::sqrt(apart / norm);
}

}  // namespace

Goal blocked_steps(cl::Session& session, int voxels, int repeats) {
  const DiffusionMedium medium = hard_medium(HardMedium::random, voxels, 1, 0.9999, 3);
  const std::vector<float> q(medium.stride() * medium.channels, 1.0f);
  LatticeSettings settings;
  settings.block_edge = 8;
  settings.inner_iterations = kInner;
  const auto lattice = make_lattice(session, medium, settings);
  lattice->set_source(q);
  const int threads = session.device().compute_units;
  const reference::LatticeCube cube = reference_cube(medium, q);
  reference::BlockLattice written(cube, threads);
  const auto ours = [&] {
    lattice->enqueue_sweeps(kSweeps);
    session.lattice_queue().finish();
  };
  const auto theirs = [&] { written.sweep(kSweeps, kInner); };
  ours();
  theirs();
  const double apart = difference(medium, lattice->read_fluence(), written.fluence());
  std::vector<double> kernel, hand;
  for (int i = 0; i < repeats; ++i) {
    kernel.push_back(seconds_of(ours));
    hand.push_back(seconds_of(theirs));
  }
  const double updates = std::pow(voxels, 3) * kInner * kSweeps;
  const double kernel_time = spread_of(kernel).median, hand_time = spread_of(hand).median;
  return {.name = figures("blocks of 8^3, m = 8, %d^3 / hand-written C++", voxels),
          .ratio = apart < kRounding ? hand_time / kernel_time : std::numeric_limits<double>::quiet_NaN(),
          .aim = 0.85,
          .ours = figures("%.0f million RGB updates/s", 1e-6 * updates / kernel_time),
          .against = figures("%.0f million RGB updates/s on %d threads", 1e-6 * updates / hand_time, threads),
          .error = figures("the two fluences differ by %.1e", apart)};
}

}  // namespace turbid
