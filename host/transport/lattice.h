// SPDX-License-Identifier: Apache-2.0
// Runs the blockwise lattice (kernels/lattice.cl): sweeps of m inner steps, stopping test, energy.
#pragma once
#include <functional>
#include <vector>

#include "host/cl/session.h"
#include "host/transport/lattice_medium.h"

namespace turbid {

/// Energy of one lattice step [W per channel].
struct LatticeEnergy {
  glm::dvec3 absorbed{0};
  glm::dvec3 stored{0};   ///< what the step added to the populations: 0 in the steady state
  std::array<glm::dvec3, 6> escaped{};
};

class Lattice {
 public:
  Lattice(cl::Session&, const DiffusionMedium&, const LatticeSettings&);

  /// Clears populations and source.
  void reset();
  /// Replaces the source by q [W]: [channel][block][voxel] of the diffusion medium; populations stay.
  void set_source(const std::vector<float>& q);
  /// Enqueues `count` sweeps on the lattice queue and returns at once.
  void enqueue_sweeps(int count) { enqueue_sweeps(count, settings_.inner_iterations); }
  /// Since the last reset or resume.
  int sweeps() const { return sweeps_ - first_sweep_; }
  /// Counts sweeps from here on; populations stay.
  void resume() { first_sweep_ = sweeps_; }
  bool at_rest() const { return sweeps_ == 0; }

  struct Change {
    double relative = 0;   ///< summed |change| of the last sweep / summed fluence, worst channel
  };
  /// Waits for the sweeps and reads the last one's change.
  Change read_change();
  /// [channel][block][voxel] of the diffusion medium [W/voxel^2].
  std::vector<float> read_fluence();
  LatticeEnergy read_energy();
  /// Device memory held [bytes].
  std::size_t device_bytes() const;

  /// Sweeps until the estimated error, change * rho / (1 - rho) with rho the ratio of successive changes (numerics section 5),
  /// is below the tolerance. Returns that estimate. `progress(fraction)` may throw to stop.
  double relax(const std::function<void(double)>& progress = {});

 private:
  void enqueue_sweeps(int count, int inner);
  double largest_s() const;

  using F = cl::Buffer<float>;
  using I = cl::Buffer<std::int32_t>;

  cl::Session& session_;
  const DiffusionMedium& diffusion_;
  LatticeSettings settings_;
  LatticeMedium medium_;
  int channels_ = 3, blocks_ = 0, sweeps_ = 0, first_sweep_ = 0;
  cl::Program program_;
  cl::Kernel<F, F, I, F, I, F, F, F, F, F, int, int, int, int> sweep_;
  cl::Kernel<F, F, F, I, F, I, F, F, F, int, int, int> balance_;
  F collision_, source_, injected_, links_, populations_, fluence_, sums_, energy_;
  F interfaces_[2];
  I link_block_, neighbours_;
};

}  // namespace turbid
