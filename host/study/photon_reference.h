// SPDX-License-Identifier: Apache-2.0
// A Monte Carlo reference of a scene, and how far a run lies from it without counting the reference's own scatter.
//
// Two independent runs A and B of half the photons each: E[(x - A)(x - B)] = (x - exact)^2, so sums of that product
// measure x alone, and |A - B| / 2 is what the mean of both scatters. Holds for any average over voxels or pixels.
#pragma once
#include <cmath>
#include <optional>
#include <string>

#include "host/study/companion.h"
#include "host/study/scene_run.h"

namespace turbid {

struct ReferenceSettings {
  double photons = 4e6;    ///< of both runs together
  std::uint64_t seed = 1;  ///< of A; B has the next one
  bool picture = false;
  std::string cache = {};  ///< folder that keeps the photons between calls, so that a second one is quick; empty: none
};

struct PhotonReference {
  SceneRun a, b;
  SampledFluence fluence_a, fluence_b;
  double seconds = 0;  ///< of both runs, from the lights to the fluence
};

/// The scene's medium, lights and camera as they are; its solver is replaced by "photon".
PhotonReference photon_reference(cl::Session&, Scene scene, const ReferenceSettings&,
                                 Verbosity talk = Verbosity::quiet);

/// Measures of x against a reference whose scatter is taken out where that is possible.
struct ReferenceErrors {
  double rel_l1 = 0, linf = 0;  ///< against the mean of both, scatter included; linf in units of the largest value
  double rel_l2 = 0;            ///< without scatter; 0 if it can't be told from scatter
  double relmse = 0;            ///< without scatter: mean (x - exact)^2 / (exact^2 + (0.1 mean exact)^2)
  double noise = 0;             ///< of the reference, as a rel_l2: what rel_l2 can't resolve
  double rel_l2_spread = 0;     ///< standard deviation of rel_l2 squared, by what the products of (x - A)(x - B) spread
  double relmse_spread = 0;     ///< standard deviation of relmse
  std::size_t values = 0;
  /// Two standard deviations above what was measured.
  double rel_l2_bound() const { return std::sqrt(rel_l2 * rel_l2 + 2 * rel_l2_spread); }
  double relmse_bound() const { return relmse + 2 * relmse_spread; }
};
/// Equally long lists. `exact`: an estimate of it that relmse divides by, where the mean of a and b is too noisy for
/// that: a pixel that no photon has reached would count as if it were black.
ReferenceErrors errors_against(const std::vector<float>& x, const std::vector<float>& a, const std::vector<float>& b,
                               const std::vector<float>& exact);
ReferenceErrors errors_against(const std::vector<float>& x, const std::vector<float>& a, const std::vector<float>& b);

/// On voxels that are active in all of them, see common_values: those of x, or x's averaged if it is finer.
ReferenceErrors fluence_errors(const SampledFluence& x, const PhotonReference&);
/// On the reference's own voxels, whatever those of x: runs on different grids can be compared by it.
ReferenceErrors fluence_errors_as_seen(const SampledFluence& x, const PhotonReference&);
/// R, G, B of all pixels; both pictures have one size.
ReferenceErrors image_errors(const ViewImage& x, const PhotonReference&);

/// R, G, B of every pixel, one after the other.
std::vector<float> rgb_values(const ViewImage&);
/// The mean of two pictures' colours.
std::vector<float> mean_values(const std::vector<float>& a, const std::vector<float>& b);

}  // namespace turbid
