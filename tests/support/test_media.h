// SPDX-License-Identifier: Apache-2.0
// Media, devices and runs for tests of kernels and of physics: small domains, analytic bodies, one shared OpenCL
// session.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "host/cl/session.h"
#include "host/transport/device_medium.h"
#include "host/transport/march.h"
#include "host/transport/solver.h"
#include "host/view/view_pass.h"
#include "volumes/medium_volume.h"
#include "volumes/procedural.h"

namespace turbid::test {

/// The process's session on the default device.
cl::Session& session();

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
Run run(const MediumDescription&, const LightList&, const SolverSettings& = {}, const Surroundings& = {});
ViewImage look_at(const Run&, const LightList&, const Camera&, const ViewSettings& = {}, const Surroundings& = {});

/// Light along a direction with the given irradiance.
Light sunlight(glm::vec3 direction, glm::vec3 irradiance = glm::vec3(1));
Light point_light(glm::vec3 position, glm::vec3 power = glm::vec3(1));

/// A domain filled with a graded index, eta^2 given at every node (positions in voxels), also beyond the domain's
/// faces, so that central differences are undisturbed there. One region, one channel, nothing scatters.
DeviceMedium graded_domain(glm::ivec3 voxels, const std::function<double(glm::dvec3)>& eta_squared);

/// The march alone: tallies, deposits [tile][node][channel], and the rays it began with.
struct Marched {
  MarchTallies tallies;
  std::vector<std::int64_t> deposit;
  double units = 1;  ///< per watt
  LightRays rays;
  glm::dvec3 carried{0};  ///< power of all rays [W per channel]
};
Marched march(const MediumDescription&, const LightList&, const MarchSettings& = {}, bool reversed_rays = false);

/// One test ray of the probe kernels.
struct ProbeRay {
  glm::vec3 x{0}, v{0};
  int region = 0;
  float length = 0;  ///< arc length done so far [voxels]
  int surfaces = 0;  ///< surfaces met so far
  int face = -1;     ///< domain face that stopped it
};

/// Traces rays with kernels/lib/trace.h, always along the refracted branch (the reflected one where reflection is
/// total), until they stand on a face of the domain or `steps` are done.
std::vector<ProbeRay> trace(const DeviceMedium&, const std::vector<ProbeRay>&, float step, int steps);

/// log(coarse / fine) / log(refinement): error ~ C h^p.
double observed_order(double coarse_error, double fine_error, double refinement = 2.0);

}  // namespace turbid::test
