// SPDX-License-Identifier: Apache-2.0
// See companion_run.h.
#include "host/study/companion_run.h"

#include <algorithm>
#include <cmath>

#include "host/study/photon_reference.h"

namespace turbid {
namespace {

constexpr float kTolerance = 1e-3f;  // of its solve: far below the difference that is looked for
constexpr int kAround = 4;           // pixels to each side that a noisy picture is smoothed over
constexpr int kSmallPicture = 64;    // pixels of the small pictures' longest side
constexpr std::size_t kEnoughValues = 3 * 64;
constexpr int kProbeSteps = 4096;            // of one photon: bounds the probe's time where light is trapped
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

}  // namespace

CompanionRun::CompanionRun(cl::Session& session, const SceneOnGrid& in, const SampledFluence& sampled, ViewPass* view)
    : session_(session), in_(in), sampled_(sampled) {
  if (view) {
    camera_ = small_picture(in.scene.camera);
    const ViewImage image = view->look(camera_);
    picture_ = rgb_values(image);
    scattered_ = root_relmse(surface_values(image), picture_);
  }
  std::optional<Scene> scene = coarser_scene_of_same_size(in.scene, 2);
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
  Answer result{sample_fluence(solution.volume, grid.medium), {}};
  if (!picture_.empty()) result.picture = rgb_values(view_of(session_, grid, solution).look(camera_));
  return result;
}

std::optional<Difference> CompanionRun::coarser() const {
  if (!base_) return std::nullopt;
  const auto values = common_values(base_->fluence, {&sampled_});
  return Difference{relative_l2(values[0], values[1]), root_relmse(base_->picture, picture_)};
}

std::optional<Difference> CompanionRun::with(const MarchSettings& march) const {
  if (!base_) return std::nullopt;
  SolverSettings settings = coarse_->scene.solver;
  settings.march = march;
  const Answer other = seen(*coarse_, solve_light(session_, *coarse_, settings, {settings.seed}, quiet_).front());
  const auto values = common_values(base_->fluence, {&other.fluence});
  return Difference{relative_l2(values[1], values[0]), root_relmse(other.picture, base_->picture)};
}

Difference CompanionRun::from_transport(double photons) const {
  const SceneOnGrid& grid = coarse_ ? *coarse_ : in_;
  SolverSettings settings = in_.scene.solver;
  settings.solver = "photon";
  settings.photon.photons = std::max<std::int64_t>(1, static_cast<std::int64_t>(photons / 2));
  settings.photon.error = 0;
  settings.photon.batches = 2;
  settings.photon.max_steps = kProbeSteps;
  settings.photon.checkpoint.clear();
  const std::uint64_t seed = settings.seed + kProbeSeed;
  const std::vector<LightSolution> two = solve_light(session_, grid, settings, {seed, seed + 1}, quiet_);
  const Answer a = seen(grid, two[0]), b = seen(grid, two[1]);
  // The fluence of the run itself, but the picture of the companion: the small pictures of two grids differ where their
  // surfaces do, which is the grid's error and not that of diffusion.
  const auto of_a = common_values(a.fluence, {&sampled_}, 0.5), of_b = common_values(b.fluence, {&sampled_}, 0.5);
  Difference result{errors_against(of_a[1], of_a[0], of_b[0]).rel_l2_bound(), 0};
  if (!picture_.empty()) {
    const std::vector<float>& own = base_ ? base_->picture : picture_;
    const std::vector<float> exact = corrected(own, mean_values(a.picture, b.picture), camera_.width, camera_.height);
    result.image = std::sqrt(errors_against(own, a.picture, b.picture, exact).relmse_bound());
  }
  return result;
}

}  // namespace turbid
