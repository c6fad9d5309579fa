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

}  // namespace

bool LatticeScheme::choose_scale(const std::vector<float>& q) {
  bool changed = false;
  const std::size_t stride = diffusion_.stride();
  for (int c = 0; half() && c < diffusion_.channels; ++c) {
    const float brightest = *std::max_element(q.begin() + c * stride, q.begin() + (c + 1) * stride);
    if (brightest <= 0) continue;
    const double scale = std::exp2(-6 - std::ilogb(brightest)), ratio = scale / scale_[c];
    if (sweeps_ > 0 && ratio < 64 && ratio > 1.0 / 64) continue;
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
