// SPDX-License-Identifier: Apache-2.0
// See error_estimate.h. Where the constants come from stands beside them; tests/verify/estimate_test.cpp holds them to it.
#include "host/study/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/study/companion.h"
#include "host/study/model_error.h"
#include "host/study/photon_reference.h"

namespace turbid {
namespace {

constexpr float kCompanionTolerance = 1e-3f;  // of its solve: far below the difference that is looked for
constexpr int kSmallPicture = 96;             // pixels of the small pictures' longest side
constexpr std::size_t kEnoughValues = 3 * 64;
constexpr double kGrid = 1.2, kSteps = 0.012, kRays = 0.04;

/// The same view in a few pixels of one sample each.
Camera small_picture(Camera camera) {
  const float scale = std::min(1.0f, float(kSmallPicture) / float(std::max(camera.width, camera.height)));
  camera.width = std::max(1, static_cast<int>(std::lround(scale * float(camera.width))));
  camera.height = std::max(1, static_cast<int>(std::lround(scale * float(camera.height))));
  camera.samples = 1;
  return camera;
}

/// R, G, B of the light that comes from surfaces.
std::vector<float> surface_values(const ViewImage& image) {
  std::vector<float> values;
  values.reserve(3 * image.direct.size());
  for (const glm::vec3& pixel : image.direct) values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
  return values;
}

/// How far the answer on voxels twice as large lies from this one [relative L2].
struct Difference {
  double fluence = 0;           ///< relative_l2
  std::optional<double> image;  ///< root_relmse
  double scattered = 0;         ///< root mean square share of the picture that comes from inside media
};

class Companion {
 public:
  Companion(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution, const SampledFluence& sampled)
      : session_(session), in_(in), solution_(solution), sampled_(sampled) {}

  /// Nothing if the domain can't be cut into voxels twice as large, or too few of them lie inside.
  std::optional<Difference> coarser(bool picture) {
    std::optional<Scene> scene = coarser_scene(in_.scene, 2);
    if (!scene) return std::nullopt;
    SolverSettings& solver = scene->solver;
    solver.solver = "steady";
    solver.steady.tolerance = std::max(solver.steady.tolerance, kCompanionTolerance);
    const SceneOnGrid coarse = put_on_grid(std::move(*scene), quiet_);
    const LightSolution companion = solve_light(session_, coarse, quiet_);
    const auto values = common_values(sample_fluence(companion.volume, coarse.medium), {&sampled_});
    if (in_.features.scattering && values[0].size() < kEnoughValues) return std::nullopt;
    Difference difference{relative_l2(values[0], values[1]), {}};
    if (picture) {
      const Camera camera = small_picture(in_.scene.camera);
      const ViewImage fine = look_at(session_, in_, solution_, camera, quiet_);
      difference.image = root_relmse(rgb_values(look_at(session_, coarse, companion, camera, quiet_)), rgb_values(fine));
      difference.scattered = root_relmse(surface_values(fine), rgb_values(fine));
    }
    return difference;
  }

 private:
  cl::Session& session_;
  const SceneOnGrid& in_;
  const LightSolution& solution_;
  const SampledFluence& sampled_;
  Progress quiet_{Verbosity::quiet};
};

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
                                            bool picture, Progress& progress) {
  const double started = wall_time();
  progress.stage("estimate");
  const SampledFluence sampled = sample_fluence(solution.volume, in.medium);
  ErrorEstimate estimate;
  ErrorParts& fluence = estimate.fluence;
  if (solution.report.photon) {
    fluence.rays = photon_error(solution.volume, sampled);
    estimate.basis = "standard error of the photons";
  } else {
    const SolverSettings& settings = in.scene.solver;
    const double first = first_flight_share(solution.volume, sampled);
    const double step = settings.march.step_in_voxels / 0.5, rays = settings.march.rays_per_face / 4;
    fluence.steps = kSteps * first * step * step;
    fluence.rays = kRays * first / rays;
    fluence.solve = solution.report.error_estimate;
    fluence.model = model_error(medium_character(solution.volume, sampled));
    const std::optional<Difference> difference = Companion(session, in, solution, sampled).coarser(picture);
    if (difference) fluence.grid = kGrid * difference->fluence;
    estimate.basis = "a run on voxels twice as large";
    if (picture) {
      ErrorParts& image = estimate.image.emplace(fluence);
      const double share = difference ? difference->scattered : 1;
      for (double* part : {&image.steps, &image.rays, &image.solve, &image.model}) *part *= share;
      if (difference) image.grid = kGrid * *difference->image;
    }
  }
  estimate.seconds = wall_time() - started;
  progress.finish();
  return estimate;
}

}  // namespace turbid
