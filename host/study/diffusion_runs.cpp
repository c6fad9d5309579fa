// SPDX-License-Identifier: Apache-2.0
// See diffusion_runs.h.
#include "host/study/diffusion_runs.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include "host/transport/lattice.h"
#include "host/transport/steady.h"

namespace turbid::study {

DiffusionMedium random_medium(const MediumDescription& scene, double s_low, double s_high, unsigned seed,
                              int channels) {
  DiffusionMedium medium = make_diffusion_medium(voxelise(scene), channels);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < medium.stride(); ++i) {
      if (medium.region[i] < 0) continue;
      const double s = s_low * std::pow(s_high / s_low, unit(random));
      medium.s[c * medium.stride() + i] = static_cast<float>(s);
      medium.s_a[c * medium.stride() + i] = static_cast<float>(0.2 * s * unit(random));
    }
  }
  for (BoundaryFace& face : medium.boundary) {
    for (int c = 0; c < channels; ++c) face.c[c] = static_cast<float>(0.05 + 2.95 * unit(random));
  }
  return medium;
}

DiffusionMedium uniform(glm::ivec3 voxels, const std::array<FaceBoundary, 6>& faces, double s, double s_a) {
  MediumDescription scene = empty_domain(voxels, 1.0f);
  scene.faces = faces;
  set_ambient(scene, make_material({.sigma_s = glm::vec3(static_cast<float>(s - s_a)),
                                    .sigma_a = glm::vec3(static_cast<float>(s_a))}));
  DiffusionMedium medium = make_diffusion_medium(voxelise(scene), 1);
  medium.s.assign(medium.s.size(), static_cast<float>(s));
  medium.s_a.assign(medium.s_a.size(), static_cast<float>(s_a));
  return medium;
}

glm::ivec3 voxel_of(const DiffusionMedium& medium, std::size_t i) {
  const int v = static_cast<int>(i % 512);
  return 8 * medium.blocks.coordinates(static_cast<int>(i / 512)) + glm::ivec3(v & 7, (v >> 3) & 7, v >> 6);
}

SteadyAnswer solve_steady(cl::Session& session, const DiffusionMedium& medium, const std::vector<float>& q,
                          float tolerance) {
  SteadySettings settings;
  settings.tolerance = tolerance;
  const SteadyResult result = SteadySolve(session, medium, settings).solve(q);
  SteadyAnswer answer;
  answer.light.fluence = result.u;
  for (std::size_t i = 0; i < result.u.size(); ++i) answer.light.fluence[i] *= medium.eta_squared[i % medium.stride()];
  account(medium, answer.light);
  answer.fluence = answer.light.fluence;
  answer.iterations = result.iterations;
  double emitted = 0, found = answer.light.absorbed.x + answer.light.absorbed_opaque.x;
  for (std::size_t i = 0; i < medium.stride(); ++i) emitted += q[i];
  for (const glm::dvec3& face : answer.light.escaped) found += face.x;
  answer.imbalance = emitted > 0 ? std::abs(found / emitted - 1) : 0;
  return answer;
}

std::vector<float> solve_lattice(cl::Session& session, const DiffusionMedium& medium, const std::vector<float>& q,
                                 CollisionVariant variant, float tolerance) {
  LatticeSettings settings;
  settings.collision = variant;
  settings.tolerance = tolerance;
  Lattice lattice(session, medium, settings);
  lattice.set_source(q);
  if (lattice.relax() > tolerance) throw std::runtime_error("the lattice did not reach its tolerance");
  return lattice.read_fluence();
}

}  // namespace turbid::study
