// SPDX-License-Identifier: Apache-2.0
// See error_estimate.h. Where the constants come from stands beside them; tests/verify/estimate_test.cpp holds them to
// it.
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

// Factors between what is measured and the bound, from 11 spheres of transport depth 3 at 32
// voxels, each against 4 times finer voxels, steps of 1/8 voxel and 64 rays per face (`turbid converge` repeats it).
constexpr double kGrid = 1.2;         // error / difference to voxels twice as large: .5 to .8, 1.2 at point lights
constexpr double kSteps = 0.012;      // of the first flight, at 1/2 voxel: .006 to .011, falls as the square
constexpr double kRays = 0.04;        // of the first flight, with 4 rays per face: .023 to .035, falls as 1 / rays
constexpr double kLongerSteps = 0.5;  // error / difference to steps twice as long: .22 to .27, 1/3 if it is the square
constexpr double kFewerRays = 0.35;   // error / difference to a quarter of the rays: .17 to .23
constexpr double kViewSteps = 0.002;  // of the picture: 1e-4 to 8e-3 with steps of half a voxel
constexpr double kUnresolved = 4;     // grid part without a companion: over the mean chord in voxels

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

/// Of two answers, relative.
struct Difference {
  double fluence = 0;  ///< relative_l2
  double image = 0;    ///< root_relmse
};

class Companion {
 public:
  Companion(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution, const SampledFluence& sampled,
            bool picture)
      : session_(session), in_(in), solution_(solution), sampled_(sampled) {
    if (picture) {
      camera_ = small_picture(in.scene.camera);
      const ViewImage image = look_at(session, in, solution, camera_, quiet_);
      picture_ = rgb_values(image);
      scattered_ = root_relmse(surface_values(image), picture_);
    }
    std::optional<Scene> scene = coarser_scene(in.scene, 2);
    if (!scene) return;
    SolverSettings& solver = scene->solver;
    solver.solver = "steady";
    solver.steady.tolerance = std::max(solver.steady.tolerance, kCompanionTolerance);
    coarse_.emplace(put_on_grid(std::move(*scene), quiet_));
    base_.emplace(run(coarse_->scene.solver.march));
  }

  /// Root mean square share of the picture that comes from inside media.
  double scattered() const { return scattered_; }

  /// How far the answer on voxels twice as large lies from the run's own; nothing if the domain can't be cut so, or too
  /// few of those voxels lie inside.
  std::optional<Difference> coarser() const {
    if (!base_) return std::nullopt;
    const auto values = common_values(base_->fluence, {&sampled_});
    if (in_.features.scattering && values[0].size() < kEnoughValues) return std::nullopt;
    return Difference{relative_l2(values[0], values[1]), root_relmse(base_->picture, picture_)};
  }

  /// How far other light rays change the answer on those voxels; nothing if there is none.
  std::optional<Difference> with(const MarchSettings& march) {
    if (!base_) return std::nullopt;
    const Answer other = run(march);
    const auto values = common_values(base_->fluence, {&other.fluence});
    return Difference{relative_l2(values[1], values[0]), root_relmse(other.picture, base_->picture)};
  }

 private:
  struct Answer {
    SampledFluence fluence;
    std::vector<float> picture;
  };

  Answer run(const MarchSettings& march) {
    coarse_->scene.solver.march = march;
    const LightSolution solution = solve_light(session_, *coarse_, quiet_);
    Answer answer{sample_fluence(solution.volume, coarse_->medium), {}};
    if (!picture_.empty()) answer.picture = rgb_values(look_at(session_, *coarse_, solution, camera_, quiet_));
    return answer;
  }

  cl::Session& session_;
  const SceneOnGrid& in_;
  const LightSolution& solution_;
  const SampledFluence& sampled_;
  Progress quiet_{Verbosity::quiet};
  Camera camera_;
  std::vector<float> picture_;
  double scattered_ = 0;
  std::optional<SceneOnGrid> coarse_;
  std::optional<Answer> base_;
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

/// 4 V / S [voxels]
double mean_chord(const MediumCharacter& character, const SampledFluence& sampled) {
  return character.chord / sampled.total.frame.voxel_size;
}

}  // namespace

std::optional<ErrorEstimate> estimate_error(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution,
                                            bool picture, Progress& progress) {
  const SolverSettings& settings = in.scene.solver;
  if (settings.error_estimate == EstimateEffort::off) return std::nullopt;
  const double started = wall_time();
  progress.stage("estimate");
  const SampledFluence sampled = sample_fluence(solution.volume, in.medium);
  ErrorEstimate estimate;
  ErrorParts &fluence = estimate.fluence, image;
  if (solution.report.photon) {
    fluence.rays = image.rays = photon_error(solution.volume, sampled);
    estimate.basis = "the photons' standard error";
  } else {
    const MediumCharacter character = medium_character(solution.volume, sampled);
    const double first = first_flight_share(solution.volume, sampled);
    const double step = settings.march.step_in_voxels / 0.5, rays = settings.march.rays_per_face / 4;
    Companion companion(session, in, solution, sampled, picture);
    const double scattered = companion.scattered();
    fluence.steps = kSteps * first * step * step;
    fluence.rays = kRays * first / rays;
    fluence.solve = solution.report.error_estimate;
    fluence.model = model_error(character);
    image = {0, scattered * fluence.steps + kViewSteps, scattered * fluence.rays, scattered * fluence.solve,
             scattered * fluence.model};
    if (const std::optional<Difference> difference = companion.coarser()) {
      fluence.grid = kGrid * difference->fluence;
      image.grid = kGrid * difference->image;
      estimate.basis = "a run on voxels twice as large";
    } else if (in.features.scattering) {
      fluence.grid = kUnresolved / std::max(1.0, mean_chord(character, sampled));
      image.grid = scattered * fluence.grid;
      estimate.basis = "the bodies' thickness in voxels: the domain can't be cut into voxels twice as large";
    }
    if (settings.error_estimate == EstimateEffort::full) {
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
  if (picture) estimate.image = image;
  estimate.seconds = wall_time() - started;
  progress.finish();
  return estimate;
}

}  // namespace turbid
