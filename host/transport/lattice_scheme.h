// SPDX-License-Identifier: Apache-2.0
// What the ways to run the lattice have in common: sweeps until the estimated error is small, and what is read then.
#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "host/cl/session.h"
#include "host/scene/settings.h"
#include "host/transport/diffusion_medium.h"

namespace turbid {

/// Energy of one lattice step [W per channel].
struct LatticeEnergy {
  glm::dvec3 absorbed{0};
  glm::dvec3 stored{0};  ///< what the step added to the populations: 0 in the steady state
  std::array<glm::dvec3, 6> escaped{};
};

class LatticeScheme {
 public:
  virtual ~LatticeScheme() = default;

  /// Clears populations and source.
  virtual void reset() = 0;
  /// Replaces the source by q [W]: [channel][block][voxel] of the diffusion medium; populations stay.
  virtual void set_source(const std::vector<float>& q) = 0;
  /// Enqueues `count` sweeps on the lattice queue and returns at once. A sweep is what happens between two exchanges.
  virtual void enqueue_sweeps(int count) = 0;
  /// Since the last reset or resume.
  int sweeps() const { return sweeps_ - first_sweep_; }
  /// Counts sweeps from here on; populations stay.
  void resume() { first_sweep_ = sweeps_; }
  bool at_rest() const { return sweeps_ == 0; }

  struct Change {
    double relative = 0;  ///< summed |change| of the last sweep / summed fluence, worst channel
  };
  /// Waits for the sweeps and reads the last one's change.
  virtual Change read_change() = 0;
  /// [channel][block][voxel] of the diffusion medium [W/voxel^2].
  virtual std::vector<float> read_fluence() = 0;
  virtual LatticeEnergy read_energy() = 0;
  /// Device memory held [bytes].
  virtual std::size_t device_bytes() const = 0;

  /// Sweeps until the estimated error, change * rho / (1 - rho) with rho the ratio of successive changes (numerics
  /// section 5), is below the tolerance. Returns that estimate. `progress(fraction)` may throw to stop.
  double relax(const std::function<void(double)>& progress = {});

 protected:
  LatticeScheme(const DiffusionMedium& diffusion, const LatticeSettings& settings)
      : diffusion_(diffusion), settings_(settings) {}
  virtual int sweeps_per_test() const = 0;
  /// After the last sweep of relax: whatever read_energy needs.
  virtual void settle() {}

  const DiffusionMedium& diffusion_;
  LatticeSettings settings_;
  int sweeps_ = 0, first_sweep_ = 0;
};

/// Blocks that exchange interfaces, or one global lattice where block_edge is 0.
std::unique_ptr<LatticeScheme> make_lattice(cl::Session&, const DiffusionMedium&, const LatticeSettings&);

}  // namespace turbid
