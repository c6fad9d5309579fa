// SPDX-License-Identifier: Apache-2.0
// See pareto_scene.h.
#include "host/study/pareto_scene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace turbid {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

std::string name_of(const Scene& scene) {
  const glm::ivec3 n = scene.medium.frame.voxels;
  const MarchSettings& march = scene.solver.march;
  char text[160];
  if (scene.solver.solver == "photon")
    std::snprintf(text, sizeof text, "%lld photons", static_cast<long long>(scene.solver.photon.photons));
  else
    std::snprintf(text, sizeof text, "%d voxels, %g rays, step %g, tolerance %g", std::max({n.x, n.y, n.z}),
                  double(march.rays_per_face), double(march.step_in_voxels), double(scene.solver.steady.tolerance));
  return text;
}

/// What would be run, coarse to fine.
std::vector<Scene> settings_of(const Scene& scene) {
  std::vector<Scene> all;
  for (const int times : {4, 2, 1}) {
    std::optional<Scene> base = times == 1 ? scene : coarser_scene(scene, times);
    if (!base) continue;
    base->solver.solver = "steady";
    for (const auto& [rays, step, tolerance] :
         {std::array{1.0f, 1.0f, 1e-2f}, std::array{4.0f, 0.5f, 1e-3f}, std::array{16.0f, 0.25f, 1e-4f}}) {
      base->solver.march.rays_per_face = rays;
      base->solver.march.step_in_voxels = step;
      base->solver.steady.tolerance = base->solver.lattice.tolerance = tolerance;
      all.push_back(*base);
    }
    Scene lattice = all[all.size() - 2];
    lattice.solver.solver = "lattice";
    all.push_back(std::move(lattice));
  }
  Scene photon = scene;
  photon.solver.solver = "photon";
  photon.solver.photon.error = 0;
  photon.solver.photon.max_steps = std::min(photon.solver.photon.max_steps, 1 << 16);
  for (const std::int64_t photons : {50'000, 500'000}) {
    photon.solver.photon.photons = photons;
    all.push_back(photon);
  }
  return all;
}

double share(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& all) {
  double worst = 0;
  for (int c = 0; c < 3; ++c)
    if (all[c] > 0) worst = std::max(worst, std::abs(a[c] - b[c]) / all[c]);
  return worst;
}

}  // namespace

ParetoStudy pareto_study(cl::Session& session, const Scene& scene, const ParetoSettings& settings,
                         const std::function<void(const std::string&)>& tell) {
  ParetoStudy study;
  tell("photon reference");
  ReferenceSettings reference_settings = settings.reference;
  reference_settings.seed += 1000;  // not that of a run
  reference_settings.picture = settings.picture;
  const PhotonReference reference = photon_reference(session, scene, reference_settings);
  std::set<std::string> compiled;
  for (const Scene& one : settings_of(scene)) {
    tell(one.solver.solver + " " + name_of(one));
    // The first run on a grid compiles its kernels; later ones of this session, and of others, find them.
    const std::string kernels = one.solver.solver + std::to_string(one.medium.frame.voxel_size);
    if (one.solver.solver != "photon" && compiled.insert(kernels).second) run_scene(session, one, settings.picture);
    const SceneRun run = run_scene(session, one, settings.picture);
    const ReferenceErrors errors =
        fluence_errors_as_seen(sample_fluence(run.solution.volume, run.on_grid.medium), reference);
    SettingRun row{.setting = name_of(one), .solver = one.solver.solver, .error = errors.rel_l2};
    row.picture_error = settings.picture ? std::sqrt(image_errors(*run.image, reference).relmse) : kNotMeasured;
    row.seconds = run.seconds();
    row.peak_memory = run.peak_memory;
    study.noise = std::max(study.noise, errors.noise);
    if (one.solver.solver == "photon") {
      study.photon_error = errors.rel_l2;
      study.photon_seconds = run.seconds();
      study.photons = static_cast<double>(one.solver.photon.photons);
    }
    study.runs.push_back(std::move(row));
  }
  mark_efficient(study.runs);
  return study;
}

std::vector<AccuracyRow> accuracy_rows(cl::Session& session, Scene scene, const ReferenceSettings& settings,
                                       const std::function<void(const std::string&)>& tell) {
  ReferenceSettings reference_settings = settings;
  reference_settings.picture = scene.has_camera;
  tell(scene.name + " photon");
  const PhotonReference reference = photon_reference(session, scene, reference_settings);
  const EnergyBalance &ea = reference.a.solution.report.energy, &eb = reference.b.solution.report.energy;
  std::vector<AccuracyRow> rows;
  for (const char* solver : {"steady", "lattice"}) {
    tell(scene.name + " " + solver);
    scene.solver.solver = solver;
    run_scene(session, scene, scene.has_camera);  // compiles the kernels
    const SceneRun run = run_scene(session, scene, scene.has_camera);
    const ReferenceErrors errors = fluence_errors(sample_fluence(run.solution.volume, run.on_grid.medium), reference);
    const EnergyBalance& e = run.solution.report.energy;
    const glm::dvec3 met = e.emitted - e.missed;
    AccuracyRow row{.scene = scene.name, .solver = solver, .fluence = errors.rel_l2, .noise = errors.noise};
    row.relmse = scene.has_camera ? image_errors(*run.image, reference).relmse : kNotMeasured;
    row.reflected = share(e.reflected, 0.5 * (ea.reflected + eb.reflected), met);
    row.escaped = share(e.escaped, 0.5 * (ea.escaped + eb.escaped), met);
    row.absorbed = share(e.absorbed, 0.5 * (ea.absorbed + eb.absorbed), met);
    row.seconds = run.seconds();
    row.time_ratio =
        errors.rel_l2 > 0 ? photon_seconds(errors.noise, reference.seconds, errors.rel_l2) / row.seconds : kNotMeasured;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace turbid
