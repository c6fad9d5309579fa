// SPDX-License-Identifier: Apache-2.0
// See error_estimate.h. Where the constants come from stands beside them; case estimate_covers (cases_estimate.cpp) holds them
// to it.
#include "host/study/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/study/companion_run.h"
#include "host/study/mean_chord.h"
#include "host/study/photon_reference.h"

namespace turbid {
namespace {

// Factors between what is measured and the bound. Those of grid, steps and rays are from 11 spheres of transport depth
// 3 at 32 voxels, each against 4 times finer voxels, steps of 1/8 voxel and 64 rays per face. The model's part needs
// none: photons measure it. What comes out of all was then held against the 60 calibration bodies of trial_bodies.h and
// the ten bundled scenes, and tested on 60 other bodies; `turbid converge --estimate` repeats that.
constexpr double kGrid = 1.2;     // error / difference to voxels twice as large: .5 to .8, 1.2 at point lights
constexpr double kSharp = 1.0;    // added for what is seen through refracting edges, which does not settle as voxels
                                  // shrink: of glass.toml, error / difference is 1.8, of scattered light at most .8
constexpr double kSteps = 0.012;  // of the first flight, at 1/2 voxel: .006 to .011, falls as the square
constexpr double kRays = 0.04;    // of the first flight, with 4 rays per face: .023 to .035, falls as 1 / rays
constexpr double kLongerSteps = 0.5;  // error / difference to steps twice as long: .22 to .27, 1/3 if it is the square
constexpr double kFewerRays = 0.35;   // error / difference to a quarter of the rays: .17 to .23
constexpr double kViewSteps = 0.002;  // of the picture: 1e-4 to 8e-3 with steps of half a voxel
constexpr double kScatter = 1.5;      // of a picture: a few bright photons that the second run may lack
constexpr double kFewPhotons = 4000, kManyPhotons = 40000;  // of both runs together
constexpr double kUnresolved = 4;  // grid part without a companion: over the mean chord in voxels

/// sqrt of the share of the first flight in the squared total fluence; 1 where nothing scatters.
double first_flight_share(const FluenceVolume& solution, const SampledFluence& sampled) {
  double first = 0, all = 0;
  for (std::size_t i = 0; i < solution.fluence.size(); ++i) {
    const double total = sampled.total.fluence[i], part = total - solution.fluence[i];
    first += part * part;
    all += total * total;
  }
  return all > 0 ? std::sqrt(first / all) : 1;
}

/// sqrt(sum se^2 / sum phi^2): what the photons' scatter is expected to be in the relative L2 norm.
double photon_error(const FluenceVolume& solution, const SampledFluence& sampled) {
  double scatter = 0, all = 0;
  for (std::size_t i = 0; i < solution.standard_error.size(); ++i) {
    const double total = sampled.total.fluence[i], error = solution.standard_error[i];
    scatter += error * error;
    all += total * total;
  }
  return all > 0 ? std::sqrt(scatter / all) : 0;
}

}  // namespace

std::optional<ErrorEstimate> estimate_error(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution,
                                            ViewPass* view, Progress& progress) {
  const SolverSettings& settings = in.scene.solver;
  if (settings.error_estimate == EstimateEffort::off) return std::nullopt;
  const double started = wall_time();
  progress.stage("estimate");
  const SampledFluence sampled = sample_fluence(solution.volume, in.medium);
  ErrorEstimate estimate;
  ErrorParts &fluence = estimate.fluence, image;
  if (solution.report.photon) {
    fluence.rays = photon_error(solution.volume, sampled);
    if (view) image.rays = kScatter * picture_scatter(session, in, solution, *view);
    estimate.basis = "the photons' standard error alone";
  } else {
    const bool full = settings.error_estimate == EstimateEffort::full;
    const bool diffuses = solution.report.active_voxels > 0;
    const double first = first_flight_share(solution.volume, sampled);
    const double step = settings.march.step_in_voxels / 0.5, rays = settings.march.rays_per_face / 4;
    const CompanionRun companion(session, in, sampled, view);
    const double scattered = companion.scattered();
    fluence.steps = kSteps * first * step * step;
    fluence.rays = kRays * first / rays;
    fluence.solve = solution.report.error_estimate + solution.report.storage_error;
    image = {0, scattered * fluence.steps + kViewSteps, scattered * fluence.rays, scattered * fluence.solve, 0};
    if (const std::optional<Difference> difference = companion.coarser()) {
      fluence.grid = kGrid * difference->fluence;
      image.grid = kGrid * difference->image + kSharp * difference->through;
      estimate.basis = "a run on voxels twice as large";
    } else if (diffuses) {
      fluence.grid = kUnresolved / std::max(1.0, mean_chord(sampled));
      image.grid = scattered * fluence.grid;
      estimate.basis = "the bodies' thickness in voxels: the domain can't be cut into voxels twice as large";
    }
    if (diffuses) {
      const auto transport = companion.from_transport(full ? kManyPhotons : kFewPhotons);
      fluence.model = transport.apart.fluence;
      image.model = transport.apart.image;
      // A pixel gathers from the voxels of a column: their area decides.
      estimate.scatter_of_one = transport.picture_scatter * companion.times_as_large();
      estimate.basis += ", and two runs of a few photons";
    }
    if (full) {
      MarchSettings other = settings.march;
      other.rays_per_face /= 4;
      if (const auto difference = companion.with(other)) {
        fluence.rays = kFewerRays * difference->fluence;
        image.rays = kFewerRays * difference->image;
      }
      other = settings.march;
      other.step_in_voxels = std::min(2.0f, 2 * other.step_in_voxels);
      if (const auto difference = companion.with(other)) {
        fluence.steps = kLongerSteps * difference->fluence;
        image.steps = kLongerSteps * difference->image + kViewSteps;
      }
      estimate.basis += ", and runs with fewer rays and with longer steps";
    }
  }
  if (view) estimate.image = image;
  estimate.seconds = wall_time() - started;
  progress.finish();
  return estimate;
}

}  // namespace turbid
