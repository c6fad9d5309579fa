// SPDX-License-Identifier: Apache-2.0
// Composes the two queues. The number of sweeps per batch is fixed, so the result does not depend on which queue is
// faster.
#include "host/transport/lattice_solver.h"

#include <algorithm>

namespace turbid {

void LatticeSolver::prepare_diffusion(const DiffusionMedium& medium) {
  lattice_ = make_lattice(context_.session, medium, context_.settings.lattice);
}

void LatticeSolver::march_all(March& march) {
  // A warm start keeps the last answer, which sweeps with an unfinished source would spoil.
  if (!lattice_) return MarchingSolver::march_all(march);
  if (warm_start() && !lattice_->at_rest()) {
    lattice_->resume();
    return MarchingSolver::march_all(march);
  }
  lattice_->reset();
  while (march.rays_left() > 0) {
    march.enqueue_batch();
    // Transport is linear: what batch i left may relax while batch i + 1 is under way.
    if (march.batches() > 1) lattice_->enqueue_sweeps(context_.settings.lattice.sweeps_per_batch);
    march.finish_batch([&] { context_.progress.update(march_progress(march)); });
    context_.session.lattice_queue().finish();
    if (march.rays_left() > 0) {
      const LightSource so_far = gather_source(march.read_deposit(), march.read_flux(), march.watts_per_unit(),
                                               device_medium(), diffusion_medium());
      lattice_->set_source(so_far.power);
    }
    context_.progress.update(march_progress(march));
  }
}

DiffuseLight LatticeSolver::diffuse(const LightSource& source) {
  lattice_->set_source(source.power);
  DiffuseLight light;
  light.error_estimate = lattice_->relax([&](double fraction) { context_.progress.update(fraction); });
  if (context_.settings.lattice.storage == Storage::half_precision) light.storage_error = kHalfError;
  light.iterations = lattice_->sweeps();
  light.fluence = lattice_->read_fluence();
  const LatticeEnergy energy = lattice_->read_energy();
  light.absorbed = energy.absorbed;
  light.escaped = energy.escaped;
  light.stored = energy.stored;
  light.rounding = energy.rounding;
  // The lattice tells what crosses each boundary face; of it, what went into opaque bodies.
  const DiffusionMedium& medium = diffusion_medium();
  for (const BoundaryFace& face : medium.boundary) {
    if (!face.opaque) continue;
    for (int c = 0; c < medium.channels; ++c) {
      const double power =
          medium.boundary_conductance(face, c) * light.fluence[medium.index(c, face.block, face.voxel)];
      light.escaped[face.face][c] -= power;
      light.absorbed_opaque[c] += power;
    }
  }
  return light;
}

}  // namespace turbid
