// SPDX-License-Identifier: Apache-2.0
// Small domains with analytic bodies, and complete runs on them: the media of cases and of tests.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "host/cl/session.h"
#include "host/transport/march.h"
#include "host/transport/solver.h"
#include "host/view/view_pass.h"
#include "volumes/medium_volume.h"
#include "volumes/procedural.h"
#include "volumes/solid.h"

namespace turbid::study {

constexpr std::array<FaceBoundary, 6> all_faces(FaceBoundary kind) {
  return {kind, kind, kind, kind, kind, kind};
}

struct MaterialSpec {
  glm::vec3 sigma_s{0}, sigma_a{0}, emission{0};
  float eta = 1.0f, g = 0.0f;
};
Material make_material(const MaterialSpec&);

/// An empty domain of voxels^3 whose lower corner is the origin unless `centred`.
MediumDescription empty_domain(glm::ivec3 voxels, float voxel_size, FaceBoundary faces = FaceBoundary::open,
                               bool centred = false);
/// Fills the domain itself.
void set_ambient(MediumDescription&, const Material&);
void add_body(MediumDescription&, Solid, const Material&, SurfaceKind = SurfaceKind::sharp);
Placement at(glm::vec3 translation);

/// Light along a direction with the given irradiance.
Light sunlight(glm::vec3 direction, glm::vec3 irradiance = glm::vec3(1));
Light point_light(glm::vec3 position, glm::vec3 power = glm::vec3(1));

/// A light solution with what it was computed from.
struct Run {
  MediumDescription description;
  MediumVolume medium;
  SceneFeatures features;
  LightSolution solution;

  const EnergyBalance& energy() const { return solution.report.energy; }
  /// Fluence of one voxel [W/scene unit^2].
  float fluence(glm::ivec3 voxel, int colour = 0) const;
  float deposit(glm::ivec3 voxel, int colour = 0) const;
};
Run run(cl::Session&, const MediumDescription&, const LightList&, const SolverSettings& = {}, const Surroundings& = {});
ViewImage look_at(cl::Session&, const Run&, const LightList&, const Camera&, const ViewSettings& = {},
                  const Surroundings& = {});

/// The march alone: tallies, deposits [tile][node][channel], and the rays it began with.
struct Marched {
  MarchTallies tallies;
  std::vector<std::int64_t> deposit;
  double units = 1;  ///< per watt
  LightRays rays;
  glm::dvec3 carried{0};  ///< power of all rays [W per channel]
};
Marched march(cl::Session&, const MediumDescription&, const LightList&, const MarchSettings& = {},
              bool reversed_rays = false);

}  // namespace turbid::study
