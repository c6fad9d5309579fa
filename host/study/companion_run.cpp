// SPDX-License-Identifier: Apache-2.0
// See companion_run.h.
#include "host/study/companion_run.h"

#include <algorithm>
#include <cmath>

#include "host/study/error_measures.h"
#include "host/study/photon_reference.h"

namespace turbid {
namespace {

constexpr float kTolerance = 1e-3f;  // of its solve: far below the difference that is looked for
constexpr int kAround = 4;           // pixels to each side that a noisy picture is smoothed over
constexpr int kSmallPicture = 64;    // pixels of the small pictures' longest side
constexpr std::size_t kEnoughValues = 3 * 64;
constexpr int kProbeSteps = 4096;            // of one photon: bounds the probe's time where light is trapped
constexpr double kShorter = 16;              // times fewer photons than those of the run that it stands beside
constexpr std::uint64_t kProbeSeed = 77777;  // beside the run's own

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

/// The same, black where nothing or the ground stands before what the pixel shows: what is left is seen through or in
/// bodies. A pixel has one sample, at its middle.
std::vector<float> seen_through(const ViewImage& image, const Camera& camera, const std::optional<Ground>& ground) {
  std::vector<float> values = surface_values(image);
  const glm::vec3 forward = glm::normalize(camera.target - camera.position),
                  right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const float half = std::tan(glm::radians(0.5f * camera.fov));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
      const float u = half * (2 * (float(x) + 0.5f) - float(camera.width)) / float(camera.height),
                  v = half * (1 - 2 * (float(y) + 0.5f) / float(camera.height));
      const glm::vec3 hit = camera.position + image.depth[i] * glm::normalize(forward + u * right + v * up);
      const bool on_ground = ground && std::abs(hit.y - ground->height) < 1e-3f * image.depth[i];
      if (image.depth[i] >= 1e10f || on_ground) std::fill_n(values.begin() + std::ptrdiff_t(3 * i), 3, 0.0f);
    }
  return values;
}

/// A picture without the noise of `noisy`: `own` and the mean of what `noisy` differs by around each pixel.
std::vector<float> corrected(const std::vector<float>& own, const std::vector<float>& noisy, int width, int height) {
  std::vector<float> result(own.size());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        int pixels = 0;
        for (int v = std::max(0, y - kAround); v <= std::min(height - 1, y + kAround); ++v)
          for (int u = std::max(0, x - kAround); u <= std::min(width - 1, x + kAround); ++u, ++pixels) {
            const std::size_t i = 3 * (std::size_t(v) * std::size_t(width) + std::size_t(u)) + std::size_t(c);
            sum += double(noisy[i]) - double(own[i]);
          }
        const std::size_t i = 3 * (std::size_t(y) * std::size_t(width) + std::size_t(x)) + std::size_t(c);
        result[i] = std::max(0.0f, own[i] + static_cast<float>(sum / pixels));
      }
  return result;
}

/// sqrt(mean (a - b)^2 / (exact^2 + (0.1 mean exact)^2))
double root_relmse_of(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& exact) {
  double sum = 0, relative = 0;
  for (const float value : exact) sum += value;
  const double floor = std::pow(0.1 * sum / static_cast<double>(exact.size()), 2);
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const double d = double(a[i]) - double(b[i]), scale = double(exact[i]) * double(exact[i]) + floor;
    if (scale > 0) relative += d * d / scale;
  }
  return std::sqrt(relative / static_cast<double>(exact.size()));
}

/// Settings of a short photon run.
SolverSettings few_photons(SolverSettings settings, double photons) {
  settings.solver = "photon";
  settings.photon.photons = std::max<std::int64_t>(1, static_cast<std::int64_t>(photons));
  settings.photon.error = 0;
  settings.photon.batches = 2;
  settings.photon.checkpoint.clear();
  return settings;
}

}  // namespace

double picture_scatter(cl::Session& session, const SceneOnGrid& in, const LightSolution& solution, ViewPass& of_it) {
  Progress quiet(Verbosity::quiet);
  const Camera camera = small_picture(in.scene.camera);
  const SolverSettings settings =
      few_photons(in.scene.solver, static_cast<double>(solution.report.photon->photons) / kShorter);
  const LightSolution second =
      std::move(solve_light(session, in, settings, {settings.seed + kProbeSeed}, quiet).front());
  const std::vector<float> first = rgb_values(of_it.look(camera)),
                           other = rgb_values(view_of(session, in, second).look(camera));
  // Both scatter, the second sqrt(kShorter) times as much.
  return root_relmse_of(first, other, first) / std::sqrt(1 + kShorter);
}

CompanionRun::CompanionRun(cl::Session& session, const SceneOnGrid& in, const SampledFluence& sampled, ViewPass* view)
    : session_(session), in_(in), sampled_(sampled) {
  if (view) {
    camera_ = small_picture(in.scene.camera);
    const ViewImage image = view->look(camera_);
    picture_ = rgb_values(image);
    through_ = seen_through(image, camera_, in.scene.surroundings.ground);
    scattered_ = root_relmse(surface_values(image), picture_);
  }
  std::optional<Scene> scene = coarser_scene_of_same_size(in.scene, kTimes);
  if (!scene) return;
  SolverSettings& settings = scene->solver;
  settings.solver = "steady";
  settings.steady.tolerance = std::max(settings.steady.tolerance, kTolerance);
  coarse_.emplace(put_on_grid(std::move(*scene), quiet_));
  base_.emplace(seen(*coarse_, solve_light(session_, *coarse_, quiet_)));
  const auto values = common_values(base_->fluence, {&sampled_});
  if (in.features.scattering && values[0].size() < kEnoughValues) {
    base_.reset();
    coarse_.reset();
  }
}

CompanionRun::Answer CompanionRun::seen(const SceneOnGrid& grid, const LightSolution& solution) const {
  Answer result{sample_fluence(solution.volume, grid.medium), {}, {}};
  if (picture_.empty()) return result;
  const ViewImage image = view_of(session_, grid, solution).look(camera_);
  result.picture = rgb_values(image);
  result.through = seen_through(image, camera_, grid.scene.surroundings.ground);
  return result;
}

std::optional<Difference> CompanionRun::coarser() const {
  if (!base_) return std::nullopt;
  const auto values = common_values(base_->fluence, {&sampled_});
  return Difference{relative_l2(values[0], values[1]), root_relmse(base_->picture, picture_),
                    root_relmse_of(base_->through, through_, picture_)};
}

std::optional<Difference> CompanionRun::with(const MarchSettings& march) const {
  if (!base_) return std::nullopt;
  SolverSettings settings = coarse_->scene.solver;
  settings.march = march;
  const Answer other = seen(*coarse_, solve_light(session_, *coarse_, settings, {settings.seed}, quiet_).front());
  const auto values = common_values(base_->fluence, {&other.fluence});
  return Difference{relative_l2(values[1], values[0]), root_relmse(other.picture, base_->picture), 0};
}

CompanionRun::Transport CompanionRun::from_transport(double photons) const {
  const SceneOnGrid& grid = coarse_ ? *coarse_ : in_;
  SolverSettings settings = few_photons(in_.scene.solver, photons / 2);
  settings.photon.max_steps = kProbeSteps;
  const std::uint64_t seed = settings.seed + kProbeSeed;
  const std::vector<LightSolution> two = solve_light(session_, grid, settings, {seed, seed + 1}, quiet_);
  const Answer a = seen(grid, two[0]), b = seen(grid, two[1]);
  // The fluence of the run itself, but the picture of the companion: the small pictures of two grids differ where their
  // surfaces do, which is the grid's error and not that of diffusion.
  const auto of_a = common_values(a.fluence, {&sampled_}, 0.5), of_b = common_values(b.fluence, {&sampled_}, 0.5);
  Transport result;
  result.apart.fluence = errors_against(of_a[1], of_a[0], of_b[0]).rel_l2_bound();
  if (!picture_.empty()) {
    const std::vector<float>& own = base_ ? base_->picture : picture_;
    const std::vector<float> exact = corrected(own, mean_values(a.picture, b.picture), camera_.width, camera_.height);
    result.apart.image = std::sqrt(errors_against(own, a.picture, b.picture, exact).relmse_bound());
    result.picture_scatter = 0.5 * root_relmse_of(a.picture, b.picture, exact) * std::sqrt(photons);
  }
  return result;
}

}  // namespace turbid
