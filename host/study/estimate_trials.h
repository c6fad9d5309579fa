// SPDX-License-Identifier: Apache-2.0
// Whether the error estimate of a run covers its true error, and how far it overshoots: the estimate beside Monte Carlo
// transport on finer voxels, scene by scene.
#pragma once
#include <string>
#include <vector>

#include "host/study/error_estimate.h"
#include "host/study/photon_reference.h"

namespace turbid {

/// An estimate beside the truth.
struct Judged {
  double estimate = 0;
  double error = 0;       ///< true one, the reference's own scatter taken out
  bool resolved = false;  ///< the true error stands out of that scatter by two standard deviations
  bool covered() const { return error <= estimate; }
};

struct EstimateTrial {
  std::string name;
  ErrorParts fluence_parts, image_parts;
  Judged fluence;      ///< relative L2
  Judged image;        ///< root of relMSE
  double seconds = 0;  ///< of the run, the estimate included
  double estimate_seconds = 0;
};

/// Runs the scene as it is, estimates its error, and finds the true one against two photon runs on voxels half as
/// large, in which the medium is met twice as finely, too. The scene has a camera.
EstimateTrial try_estimate(cl::Session&, Scene, const ReferenceSettings&);

struct Coverage {
  std::size_t trials = 0, covered = 0;
  double share = 1;         ///< covered / trials
  double median_ratio = 0;  ///< estimate / true error, of those that are resolved; 0: none is
  double largest_ratio = 0;
  double largest_shortfall = 0;  ///< true error / estimate
  std::string farthest;          ///< the trial with the largest shortfall
};
/// What an estimate must keep: it covers at least 95 % of the true errors, and is at most five times as large in the
/// median.
inline constexpr double kLeastCoverage = 0.95, kLargestMedian = 5;

Coverage fluence_coverage(const std::vector<EstimateTrial>&);
Coverage image_coverage(const std::vector<EstimateTrial>&);

}  // namespace turbid
