// SPDX-License-Identifier: Apache-2.0
// The stopping test, and the choice between blocks and one global lattice.
#include "host/transport/lattice_scheme.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "host/base/errors.h"
#include "host/transport/global_lattice.h"
#include "host/transport/lattice.h"

namespace turbid {
namespace {

constexpr double kRounding = 1e-7;
constexpr int kMostStored = 12;  // binary digits of the largest fluence in half precision, which ends at 16

}  // namespace

bool LatticeScheme::choose_scale(const std::vector<float>& q) {
  bool changed = false;
  const std::size_t stride = diffusion_.stride();
  for (int c = 0; half() && c < diffusion_.channels; ++c) {
    double brightest = 0, total = 0, least_absorption = 1, thickest = 0;
    for (std::size_t i = c * stride; i < (c + 1) * stride; ++i) {
      if (diffusion_.region[i % stride] < 0) continue;
      brightest = std::max(brightest, static_cast<double>(q[i]));
      total += q[i];
      least_absorption = std::min(least_absorption, static_cast<double>(diffusion_.s_a[i]));
      thickest = std::max(thickest, static_cast<double>(diffusion_.s[i]));
    }
    if (brightest <= 0) continue;
    // The fluence is at most q / s_a, what builds up over the domain's width n by diffusion, 4 (1 + s) n^2 q, or all
    // the power times the peak of one voxel's answer, 2 (1 + s).
    const glm::ivec3 n = diffusion_.frame.voxels;
    const double width = std::max({n.x, n.y, n.z}), local = 1 + thickest;
    const double build_up = std::min(1 / std::max(least_absorption, 1e-12), 4 * local * width * width) + local;
    const double most = std::min(brightest * build_up, 2 * local * total);
    const double scale = std::exp2(kMostStored - std::ilogb(most)), ratio = scale / scale_[c];
    if (sweeps_ > 0 && ratio < 8 && ratio > 1.0 / 8) continue;
    changed |= scale != scale_[c];
    scale_[c] = scale;
  }
  return changed;
}

double LatticeScheme::change_per_sweep(glm::dvec3& last_total) {
  const Change change = read_change();
  if (!half() || !std::isfinite(change.relative)) return change.relative;
  double worst = 0;
  for (int c = 0; c < diffusion_.channels; ++c) {
    if (change.total[c] > 0) worst = std::max(worst, std::abs(change.total[c] - last_total[c]) / change.total[c]);
  }
  last_total = change.total;
  return worst / sweeps_per_test();
}

double LatticeScheme::relax(const std::function<void(double)>& progress) {
  double previous = 0, estimate = 1;
  const double rest = half() ? kRounding / sweeps_per_test() : kRounding;
  glm::dvec3 last_total(0);
  int small = 0;
  while (sweeps() < settings_.max_sweeps && diffusion_.blocks.count() > 0) {
    enqueue_sweeps(sweeps_per_test());
    const double change = change_per_sweep(last_total);
    if (change < rest) {
      // As steady as single precision can be: the ratio of successive changes means nothing any more.
      estimate = change;
      break;
    }
    if (!std::isfinite(change) || change > 1e6) {
      const double largest = diffusion_.s.empty() ? 0.0 : *std::max_element(diffusion_.s.begin(), diffusion_.s.end());
      throw InputError("lattice: the collision diverges: optical thickness per voxel up to " + std::to_string(largest) +
                       ", stable to 2 with collision = \"paper\"; raise the resolution or use collision = \"trt\"");
    }
    // rho per sweep from changes that lie sweeps_per_test() sweeps apart.
    const double rho =
        previous > 0 ? std::min(std::pow(change / previous, 1.0 / sweeps_per_test()), 0.999999) : 0.999999;
    previous = change;
    estimate = change * rho / (1.0 - rho);
    if (progress) progress(std::clamp(std::log(estimate) / std::log(settings_.tolerance), 0.0, 1.0));
    // Twice in a row: one lucky ratio must not stop it.
    small = estimate < settings_.tolerance ? small + 1 : 0;
    if (small == 2) break;
  }
  settle();
  return estimate;
}

std::unique_ptr<LatticeScheme> make_lattice(cl::Session& session, const DiffusionMedium& medium,
                                            const LatticeSettings& settings) {
  if (settings.block_edge == 0) return std::make_unique<GlobalLattice>(session, medium, settings);
  return std::make_unique<Lattice>(session, medium, settings);
}

}  // namespace turbid
