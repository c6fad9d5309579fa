// SPDX-License-Identifier: Apache-2.0
// See photon_runs.h.
#include "host/study/photon_runs.h"

namespace turbid::study {
namespace {

template <class Answer>
PhotonAnswer with_solver(cl::Session& session, const MediumDescription& description, const SolverSettings& settings,
                         const LightList& lights, const Surroundings& surroundings, const Answer& answer) {
  const MediumVolume medium = voxelise(description);
  Progress progress(Verbosity::quiet);
  PhotonSolver solver({.session = session,
                       .progress = progress,
                       .settings = settings,
                       .features = scene_features(medium, lights),
                       .description = description,
                       .surroundings = surroundings});
  solver.prepare(medium);
  const double started = wall_time();
  LightSolution solution = answer(solver);
  PhotonAnswer out{.solution = std::move(solution), .region = {}, .sigma_s = {}, .seconds = wall_time() - started};
  const PhotonMedium active = upload_photon_medium(session, medium, solver.device_medium());
  out.region = active.region;
  for (const glm::vec3& sigma_s : active.sigma_s) out.sigma_s.push_back(sigma_s.x / medium.frame().voxel_size);
  return out;
}

}  // namespace

double PhotonAnswer::fluence(std::size_t at) const {
  const FluenceVolume& volume = solution.volume;
  return volume.fluence[at] + (sigma_s[at] > 0 ? volume.deposit[at] / sigma_s[at] : 0.0);
}

glm::ivec3 PhotonAnswer::voxel(std::size_t at) const {
  const int v = static_cast<int>(at % 512);
  return 8 * solution.volume.blocks.coordinates(static_cast<int>(at / 512)) + glm::ivec3(v & 7, (v >> 3) & 7, v >> 6);
}

SolverSettings photons(std::int64_t count, std::uint64_t seed, int batches) {
  SolverSettings settings;
  settings.solver = "photon";
  settings.seed = seed;
  settings.photon.photons = count;
  settings.photon.batches = batches;
  return settings;
}

PhotonSource source(int kind, glm::vec3 position, glm::vec3 direction, int region) {
  PhotonSource result{};
  const glm::vec3 unit = glm::normalize(direction);
  for (int i = 0; i < 3; ++i) {
    result.position[i] = position[i];
    result.direction[i] = unit[i];
    result.normal[i] = -unit[i];
  }
  result.kind = kind;
  result.region = region;
  result.cos_half_angle = -1.0f;
  return result;
}

PhotonAnswer follow(cl::Session& session, const MediumDescription& description, const SolverSettings& settings,
                    const std::vector<PhotonSource>& sources) {
  return with_solver(session, description, settings, {}, {}, [&](PhotonSolver& solver) {
    PhotonSources all;
    for (const PhotonSource& one : sources) all.add(one, {1, 1, 1});
    all.emitted = all.carried();
    return solver.follow(std::move(all));
  });
}

PhotonAnswer follow(cl::Session& session, const MediumDescription& description, const SolverSettings& settings,
                    const LightList& lights, const Surroundings& surroundings) {
  return with_solver(session, description, settings, lights, surroundings,
                     [&](PhotonSolver& solver) { return solver.light(lights); });
}

MediumDescription slab(int n, float voxel, const Material& material) {
  MediumDescription description = empty_domain({8, 8, n}, voxel, FaceBoundary::periodic);
  description.faces[4] = description.faces[5] = FaceBoundary::open;
  set_ambient(description, material);
  return description;
}

}  // namespace turbid::study
