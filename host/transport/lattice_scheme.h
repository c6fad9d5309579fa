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
  glm::dvec3 stored{0};    ///< what the step added to the populations: 0 in the steady state
  glm::dvec3 rounding{0};  ///< what storing the populations in half precision took away
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
    glm::dvec3 total{0};  ///< summed fluence, in the units of the populations
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
  bool half() const { return settings_.storage == Storage::half_precision; }
  /// Bytes of one stored population.
  std::size_t stored_bytes() const { return half() ? 2 : 4; }
  /// Chooses scale_ for source q [channel][block and voxel of the diffusion medium] where populations are stored in
  /// half precision, so that the largest fluence that q can lead to fits. Keeps the scale in use, once there are
  /// populations, while it lies within a factor of 8; returns whether it changed.
  bool choose_scale(const std::vector<float>& q);
  /// After the last sweep of relax: whatever read_energy needs.
  virtual void settle() {}

  const DiffusionMedium& diffusion_;
  LatticeSettings settings_;
  /// Change per sweep since the last test. In half precision populations keep jumping by roundings when all is at rest,
  /// but what they add up to does not: there the change of the summed fluence counts.
  double change_per_sweep(glm::dvec3& last_total);

  int sweeps_ = 0, first_sweep_ = 0;
  glm::dvec3 scale_{1};  ///< power of two per channel by which source, populations and fluence are kept larger
};

/// Relative error (rel-L2) that half-precision storage leaves in the fluence, for the run's own error estimate.
/// Rounding errs by up to 2^-11 = 4.9e-4 of a population, each of six by itself, and the next step evens it out; tests
/// hold even and uneven media to it.
inline constexpr double kHalfError = 5e-4;

/// Blocks that exchange interfaces, or one global lattice where block_edge is 0.
std::unique_ptr<LatticeScheme> make_lattice(cl::Session&, const DiffusionMedium&, const LatticeSettings&);

}  // namespace turbid
