// SPDX-License-Identifier: Apache-2.0
// From sums over photons to fluence, tallies and the energy balance, in scene units.
#include "host/transport/photon_solver.h"

#include <algorithm>
#include <cmath>

namespace turbid {

void PhotonSolver::prepare(const MediumVolume& medium) {
  medium_ = &medium;
  photons_.reset();
  context_.progress.stage("upload");
  device_ = std::make_shared<const DeviceMedium>(upload_medium(context_.session, medium, context_.features));
  surfaces_.emplace(entry_surfaces(context_.description, medium, false));
  context_.progress.stage("prepare");
  photon_medium_.emplace(upload_photon_medium(context_.session, medium, *device_));
  photons_.emplace(context_.session, *device_, *photon_medium_, context_.settings, medium.faces(), context_.surroundings);
}

LightSolution PhotonSolver::light(const LightList& lights) {
  context_.progress.stage("lights");
  return follow(photon_sources(lights, *medium_, *surfaces_, *device_, *photon_medium_, context_.settings.march,
                               context_.settings.seed));
}

PhotonTallies PhotonSolver::tallies(const PhotonRun& run, const glm::dvec3& watts) const {
  const int channels = device_->features.channels, own = photons_->tally_count();
  auto estimate = [&](int tally) {
    Estimate result;
    for (int c = 0; c < channels; ++c) {
      const double scale = watts[c] / run.units();
      result.value[c] = scale * run.mean(run.state().tallies[c], tally);
      result.error[c] = scale * run.standard_error(run.state().tallies[c], tally);
    }
    if (channels == 1) {
      result.value = result.value.x * glm::dvec3(device_->features.tint);
      result.error = result.error.x * glm::dvec3(device_->features.tint);
    }
    return result;
  };
  PhotonTallies out;
  out.photons = run.photons();
  out.batches = static_cast<int>(run.state().batches);
  out.reflected = estimate(TURBID_PHOTON_REFLECTED);
  out.absorbed_opaque = estimate(TURBID_PHOTON_OPAQUE);
  out.in_flight = estimate(TURBID_PHOTON_IN_FLIGHT);
  out.roulette = estimate(TURBID_PHOTON_ROULETTE);
  out.absorbed = estimate(own + PhotonRun::total_absorbed);
  out.escaped = estimate(own + PhotonRun::total_escaped);
  out.unscattered = estimate(own + PhotonRun::total_unscattered);
  for (int tally = TURBID_PHOTON_ABSORBED; tally < own; ++tally) out.absorbed_regions.push_back(estimate(tally));
  for (int face = 0; face < 6; ++face) {
    out.escaped_faces[face] = estimate(TURBID_PHOTON_ESCAPED + face);
    out.unscattered_faces[face] = estimate(TURBID_PHOTON_UNSCATTERED + face);
  }
  return out;
}

LightSolution PhotonSolver::follow(PhotonSources sources) {
  context_.progress.stage("photons");
  const PhotonMedium& medium = *photon_medium_;
  const int channels = device_->features.channels;
  const std::size_t stride = medium.stride();
  PhotonRun run(*photons_, sources, context_.settings, channels, stride);
  run.run(context_.progress);

  const glm::dvec3 watts = sources.carried();
  LightSolution solution{.device = device_, .volume = {device_->frame, medium.blocks, {}, {}}, .ground = {},
                         .shadows = std::move(sources.shadows), .report = {}};
  const auto followed = static_cast<double>(std::max<std::uint64_t>(run.state().finished, 1));
  solution.ground = photons_->ground_light(run.state().device, watts / (followed * run.units()));
  SolverReport& report = solution.report;
  report.solver = "photon";
  report.channels = channels;
  report.rays = sources.sources.size();
  report.error_estimate = run.relative_error();
  report.active_blocks = medium.blocks.count();
  report.active_voxels = medium.active_voxels;
  report.photon = tallies(run, watts);

  EnergyBalance& energy = report.energy;
  const glm::dvec3 tint = channels == 3 ? glm::dvec3(1) : glm::dvec3(device_->features.tint);
  auto in_colours = [&](const glm::dvec3& value) { return channels == 3 ? value : value.x * tint; };
  energy.emitted = in_colours(sources.emitted);
  energy.missed = in_colours(sources.missed);
  energy.reflected = report.photon->reflected.value;
  energy.absorbed = report.photon->absorbed.value;
  energy.absorbed_opaque = in_colours(sources.absorbed_opaque) + report.photon->absorbed_opaque.value;
  energy.escaped = report.photon->escaped.value;
  for (int face = 0; face < 6; ++face) energy.escaped_faces[face] = report.photon->escaped_faces[face].value;
  energy.in_flight = report.photon->in_flight.value;
  energy.roulette = report.photon->roulette.value;

  // Light that has not scattered yet goes to `deposit`, as from the marching pass, where the medium scatters at all.
  const double h = device_->frame.voxel_size;
  FluenceVolume& volume = solution.volume;
  volume.fluence.assign(3 * stride, 0.0f);
  volume.deposit.assign(3 * stride, 0.0f);
  volume.standard_error.assign(3 * stride, 0.0f);
  for (int c = 0; c < 3; ++c) {
    const int from = channels == 3 ? c : 0;
    const PhotonState& state = run.state();
    for (std::size_t i = 0; i < stride; ++i) {
      if (medium.region[i] < 0) continue;
      const double scale = tint[c] * watts[from] / (run.units() * medium.volume[i] * h * h);
      const double total = scale * run.mean(state.fluence[from], i);
      const double unscattered = scale * state.unscattered[from][i] / followed;
      const double sigma_s = medium.sigma_s[i][from];
      volume.fluence[c * stride + i] = static_cast<float>(sigma_s > 0 ? total - unscattered : total);
      volume.deposit[c * stride + i] = static_cast<float>(unscattered * sigma_s / h);
      volume.standard_error[c * stride + i] = static_cast<float>(scale * run.standard_error(state.fluence[from], i));
    }
  }
  context_.progress.finish();
  return solution;
}

}  // namespace turbid
