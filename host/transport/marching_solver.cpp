// SPDX-License-Identifier: Apache-2.0
// Order of the stages and the energy balance of the deterministic solvers.
#include "host/transport/marching_solver.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/base/parallel.h"

namespace turbid {

double EnergyBalance::imbalance() const {
  double worst = 0;
  const glm::dvec3 rest = missed + reflected + absorbed + absorbed_opaque + escaped + in_flight + roulette + rounding;
  for (int c = 0; c < 3; ++c) {
    if (emitted[c] > 0) worst = std::max(worst, std::abs(emitted[c] - rest[c]) / emitted[c]);
  }
  return worst;
}

void account(const DiffusionMedium& medium, DiffuseLight& light) {
  const std::size_t stride = medium.stride();
  const int blocks = medium.blocks.count();
  // Block by block, so that the sums do not depend on the number of threads.
  std::vector<glm::dvec3> absorbed(blocks, glm::dvec3(0));
  parallel_ranges(blocks, [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      for (int c = 0; c < medium.channels; ++c) {
        for (std::size_t at = medium.index(c, block, 0); at < medium.index(c, block + 1, 0); ++at) {
          absorbed[block][c] += static_cast<double>(medium.s_a[at]) * light.fluence[at];
        }
      }
    }
  });
  for (const glm::dvec3& watts : absorbed) light.absorbed += watts;
  for (const BoundaryFace& face : medium.boundary) {
    for (int c = 0; c < medium.channels; ++c) {
      const double power = medium.boundary_conductance(face, c) * light.fluence[c * stride + face.block * std::size_t{512} + face.voxel];
      (face.opaque ? light.absorbed_opaque : light.escaped[face.face])[c] += power;
    }
  }
}

namespace {

/// In a closed domain where nothing absorbs the light would grow without end.
void require_sink(const DiffusionMedium& medium) {
  if (medium.active_voxels == 0 || !medium.boundary.empty()) return;
  for (int c = 0; c < medium.channels; ++c) {
    const auto first = medium.s_a.begin() + c * medium.stride(), last = first + medium.stride();
    if (std::any_of(first, last, [](float s_a) { return s_a > 0.0f; })) continue;
    throw InputError("the medium has no steady state: no face of the domain is open and nothing absorbs; "
                     "open a face or give sigma_a > 0");
  }
}

}  // namespace

void MarchingSolver::prepare(const MediumVolume& medium) {
  medium_ = &medium;
  march_.reset();
  context_.progress.stage("upload");
  device_ = std::make_shared<const DeviceMedium>(upload_medium(context_.session, medium, context_.features, context_.settings.march.storage));
  surfaces_.emplace(entry_surfaces(context_.description, medium, false));
  context_.progress.stage("prepare");
  diffusion_.emplace(make_diffusion_medium(medium, context_.features.channels, context_.features.first_colour()));
  context_.progress.update(0.4);
  march_.emplace(context_.session, *device_, context_.settings.march, medium.faces(), context_.surroundings);
  require_sink(*diffusion_);
  context_.progress.update(0.6);
  if (context_.features.scattering) prepare_diffusion(*diffusion_);
  context_.progress.update(1.0);
}

double MarchingSolver::march_progress(const March& march) const {
  const double all = static_cast<double>(std::max<std::size_t>(first_ray_count_, 1));
  return std::max(0.0, 1.0 - static_cast<double>(march.rays_left()) / all);
}

void MarchingSolver::march_all(March& march) {
  while (march.rays_left() > 0) {
    march.enqueue_batch();
    march.finish_batch([&] { context_.progress.update(march_progress(march)); });
    context_.progress.update(march_progress(march));
  }
}

LightSolution MarchingSolver::light(const LightList& lights) {
  const DiffusionMedium& diffusion = *diffusion_;
  const int channels = diffusion.channels;
  const std::size_t stride = diffusion.stride();
  context_.progress.stage("lights");
  const LightRays rays =
      start_rays(lights, *medium_, *surfaces_, *device_, context_.settings.march, context_.settings.seed);
  first_ray_count_ = rays.rays.size();
  context_.progress.stage("march");
  march_->start(rays);
  march_all(*march_);

  context_.progress.stage("diffuse");
  LightSource source;
  DiffuseLight diffuse_light;
  diffuse_light.fluence.assign(stride * channels, 0.0f);
  if (context_.features.scattering) {
    source = gather_source(march_->read_deposit(), march_->read_flux(), march_->watts_per_unit(), *device_, diffusion);
    diffuse_light = diffuse(source);
  }

  const MarchTallies tallies = march_->read_tallies();
  LightSolution solution{.device = device_, .volume = {diffusion.frame, diffusion.blocks, {}, {}}, .ground = march_->read_ground(),
                         .shadows = rays.shadows, .report = {}};
  march_->read_transmittance(rays, &solution.shadows);
  SolverReport& report = solution.report;
  report.solver = name();
  report.channels = channels;
  report.rays = rays.rays.size();
  report.march_batches = march_->batches();
  report.march = tallies.work;
  report.iterations = diffuse_light.iterations;
  report.error_estimate = diffuse_light.error_estimate;
  report.storage_error = diffuse_light.storage_error + device_->storage_error();
  report.active_blocks = diffusion.blocks.count();
  report.active_voxels = diffusion.active_voxels;
  report.diffusion_bytes = diffusion_bytes();
  EnergyBalance& energy = report.energy;
  energy.emitted = rays.emitted + source.emitted;
  energy.missed = rays.missed;
  energy.reflected = tallies.reflected;
  energy.absorbed = tallies.absorbed + diffuse_light.absorbed;
  energy.absorbed_opaque = rays.absorbed_opaque + tallies.opaque + diffuse_light.absorbed_opaque + source.left.absorbed_opaque;
  energy.in_flight = tallies.in_flight + source.unresolved + diffuse_light.stored;
  energy.rounding = diffuse_light.rounding;
  for (int face = 0; face < 6; ++face) {
    energy.escaped_faces[face] = tallies.escaped[face] + diffuse_light.escaped[face] + source.left.escaped[face];
    energy.escaped += energy.escaped_faces[face];
  }

  // To scene units, and from one grey channel to three by the scene's tint.
  const float h = diffusion.frame.voxel_size;
  const float to_fluence = 1.0f / (h * h), to_density = 1.0f / (h * h * h);
  solution.volume.fluence.assign(3 * stride, 0.0f);
  solution.volume.deposit.assign(3 * stride, 0.0f);
  const glm::vec3 tint = channels == 3 ? glm::vec3(1) : context_.features.tint;
  for (int c = 0; c < 3; ++c) {
    const std::size_t from = channels == 3 ? c : 0;
    parallel_ranges(diffusion.blocks.count(), [&](int begin, int end) {
      for (std::size_t i = begin * std::size_t{512}; i < end * std::size_t{512}; ++i) {
        solution.volume.fluence[c * stride + i] = tint[c] * to_fluence * diffuse_light.fluence[from * stride + i];
        if (!source.density.empty()) {
          solution.volume.deposit[c * stride + i] = tint[c] * to_density * source.density[from * stride + i];
        }
      }
    });
  }
  if (channels == 1) {
    auto spread = [&](glm::dvec3& value) { value = value.x * glm::dvec3(tint); };
    for (glm::dvec3* value : {&energy.emitted, &energy.missed, &energy.reflected, &energy.absorbed, &energy.absorbed_opaque,
                              &energy.in_flight, &energy.escaped, &energy.rounding}) {
      spread(*value);
    }
    for (glm::dvec3& value : energy.escaped_faces) spread(value);
  }
  context_.progress.finish();
  return solution;
}

}  // namespace turbid
