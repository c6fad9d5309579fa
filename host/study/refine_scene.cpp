// SPDX-License-Identifier: Apache-2.0
// See refine_scene.h.
#include "host/study/refine_scene.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/study/flip.h"

namespace turbid {
namespace {

// Fine enough not to show beside what is refined.
constexpr float kFineStep = 0.25f, kFineRays = 16, kFineTolerance = 1e-6f;

double h_of(const SceneParameter& p, double level, const Scene& scene) {
  if (p.name == "voxel_size") return scene.medium.frame.voxel_size;
  if (p.name == "rays" || p.name == "photons") return 1 / std::sqrt(level);
  return level;
}

/// The scene at a level. `base`: at the first resolution.
Scene scene_at(const SceneParameter& p, double level, double first, Scene base) {
  SolverSettings& s = base.solver;
  if (p.name == "voxel_size") return finer_scene(base, static_cast<int>(std::lround(level / first)));
  if (p.name == "step") s.march.step_in_voxels = static_cast<float>(level);
  if (p.name == "rays") s.march.rays_per_face = static_cast<float>(level);
  if (p.name == "tolerance") s.steady.tolerance = s.lattice.tolerance = static_cast<float>(level);
  if (p.name == "block") s.lattice.block_edge = static_cast<int>(level);
  if (p.name == "inner") s.lattice.inner_iterations = static_cast<int>(level);
  if (p.name == "block" || p.name == "inner") s.solver = "lattice";
  if (p.name == "solver") s.solver = level == 0 ? "steady" : "lattice";
  if (p.name == "photons") {
    s.solver = "photon";
    s.photon.photons = static_cast<std::int64_t>(level);
    s.photon.error = 0;
    s.photon.max_steps = std::min(s.photon.max_steps, 1 << 16);
  }
  return base;
}

Scene base_scene(const SceneParameter& p, Scene scene) {
  SolverSettings& s = scene.solver;
  s.error_estimate = EstimateEffort::off;
  if (p.name != "solver" && s.solver == "photon" && p.name != "photons") s.solver = "steady";
  if (p.name != "step") s.march.step_in_voxels = std::min(s.march.step_in_voxels, kFineStep);
  if (p.name != "rays") s.march.rays_per_face = std::max(s.march.rays_per_face, kFineRays);
  if (p.name != "tolerance") s.steady.tolerance = s.lattice.tolerance = kFineTolerance;
  if (p.name == "block" || p.name == "inner" || p.name == "solver") s.lattice.tolerance = 1e-5f;
  return scene;
}

/// One finer than the finest, and the weight w of the step from the finest to it that Richardson adds:
/// value(0) = finer + w (finer - finest).
struct Beyond {
  double level = 0, weight = 0;
};

Beyond beyond(const SceneParameter& p, double finest) {
  if (p.name == "voxel_size") return {2 * finest, 1.0 / 3};      // h^2
  if (p.name == "step") return {finest / 2, 1.0 / 3};            // h^2
  if (p.name == "rays") return {std::min(64.0, 4 * finest), 0};  // irregular: nothing to extrapolate
  if (p.name == "tolerance") return {std::max(1e-6, finest / 100), 0};
  return {};
}

std::vector<float> extrapolated(const std::vector<float>& finer, const std::vector<float>& finest, double weight) {
  std::vector<float> values(finer.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = finer[i] + static_cast<float>(weight) * (finer[i] - finest[i]);
  return values;
}

std::vector<glm::vec3> colours(const std::vector<float>& values) {
  std::vector<glm::vec3> pixels(values.size() / 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return pixels;
}

struct Answer {
  SampledFluence fluence;
  std::optional<ViewImage> image;
};

Answer answer_of(const SceneRun& run) {
  return {sample_fluence(run.solution.volume, run.on_grid.medium), run.image};
}

}  // namespace

std::vector<StageTime> median_times(const std::vector<std::vector<StageTime>>& runs) {
  std::vector<StageTime> median = runs.front();
  for (std::size_t stage = 0; stage < median.size(); ++stage) {
    std::vector<double> seconds;
    for (const auto& run : runs) seconds.push_back(run.at(stage).seconds);
    std::sort(seconds.begin(), seconds.end());
    const std::size_t n = seconds.size();
    median[stage].seconds = 0.5 * (seconds[(n - 1) / 2] + seconds[n / 2]);
  }
  return median;
}

SceneRefinement refine_scene(cl::Session& session, const ReadScene& read, const SceneParameter& parameter,
                             const RefineSettings& settings, const std::function<void(const std::string&)>& tell) {
  const double first = settings.levels.front();
  const bool grids = parameter.name == "voxel_size";
  for (const double level : settings.levels)
    if (grids && std::fmod(level, first) != 0)
      throw InputError("--levels: expected whole multiples of the first, so that voxels nest");
  const Scene base = base_scene(parameter, read(grids ? std::optional<int>(int(first)) : std::nullopt));
  if (settings.picture && !base.has_camera) throw InputError(base.path + ": has no [camera], so there is no picture");

  SceneRefinement out{.parameter = parameter, .levels = {}, .beside = settings.beside};
  std::vector<Answer> answers;
  for (const double level : settings.levels) {
    char name[64];
    std::snprintf(name, sizeof name, "%s %g", parameter.name.c_str(), level);
    tell(name);
    Scene scene = scene_at(parameter, level, first, base);
    if (settings.beside) scene = scene_at(settings.beside->parameter, settings.beside->level, 0, std::move(scene));
    std::vector<std::vector<StageTime>> times;
    SceneLevel result{.level = level, .h = h_of(parameter, level, scene)};
    // The first run on a grid compiles its kernels and is not timed; beside photons that is nothing.
    const int warming_up = scene.solver.solver == "photon" ? 0 : 1;
    for (int i = 0; i < warming_up + std::max(1, settings.repeat); ++i) {
      SceneRun run = run_scene(session, scene, settings.picture);
      if (i >= warming_up) times.push_back(run.times);
      result.peak_memory = std::max(result.peak_memory, run.peak_memory);
      if (i == 0) answers.push_back(answer_of(run));
    }
    result.stages = median_times(times);
    for (const StageTime& stage : result.stages) result.seconds += stage.seconds;
    result.picture = answers.back().image;
    out.levels.push_back(std::move(result));
  }

  std::optional<PhotonReference> photons;
  std::optional<Answer> finer;
  const Beyond step = beyond(parameter, settings.levels.back());
  const bool by_photons = settings.against_photon || parameter.name == "photons";
  if (by_photons) {
    tell("photon reference");
    ReferenceSettings reference = settings.reference;
    reference.picture = settings.picture;
    if (parameter.name == "photons") reference.photons = std::max(reference.photons, 8 * settings.levels.back());
    reference.seed += 1000;  // not that of a level
    photons.emplace(
        photon_reference(session, grids ? scene_at(parameter, settings.levels.back(), first, base) : base, reference));
    out.reference = "two photon runs";
    if (settings.picture) out.reference_picture = photons->a.image;
  } else if (step.level > 0) {
    char name[64];
    std::snprintf(name, sizeof name, "%s %g", parameter.name.c_str(), step.level);
    tell(name);
    finer.emplace(answer_of(run_scene(session, scene_at(parameter, step.level, first, base), settings.picture)));
    out.reference =
        name + std::string(step.weight > 0 ? ", extrapolated with the finest level (Richardson, order 2)" : "");
    if (settings.picture) out.reference_picture = finer->image;
  } else {
    tell("steady");
    Scene scene = base;
    scene.solver.solver = "steady";
    finer.emplace(answer_of(run_scene(session, scene, settings.picture)));
    out.reference = "the steady solver at tolerance 1e-6";
    if (settings.picture) out.reference_picture = finer->image;
  }

  std::vector<Level> fitted;
  for (std::size_t i = 0; i < out.levels.size(); ++i) {
    SceneLevel& level = out.levels[i];
    const Answer& answer = answers[i];
    std::vector<float> pixels, a, b;
    if (photons) {
      level.fluence = fluence_errors(answer.fluence, *photons);
      if (settings.picture) a = rgb_values(*photons->a.image), b = rgb_values(*photons->b.image);
    } else {
      const auto values = common_values(answer.fluence, {&finer->fluence, &answers.back().fluence});
      const std::vector<float> exact = extrapolated(values[1], values[2], step.weight);
      level.fluence = errors_against(values[0], exact, exact);
      if (settings.picture) a = b = rgb_values(*finer->image);
    }
    if (settings.picture) {
      pixels = rgb_values(*answer.image);
      level.image = errors_against(pixels, a, b);
      level.flip =
          hdr_flip(colours(pixels), colours(mean_values(a, b)), answer.image->width, answer.image->height).mean;
    }
    out.noise = std::max(out.noise, level.fluence.noise);
    fitted.push_back({level.h, level.fluence.rel_l2});
  }
  out.fit = fitted_order(fitted);
  // Beside a coarse level of another parameter the error need not fall.
  out.judged = parameter.order > 0 && (!photons || parameter.name == "photons") && !settings.beside;
  return out;
}

}  // namespace turbid
