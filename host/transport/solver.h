// SPDX-License-Identifier: Apache-2.0
// The interface of every solver, split by what changes seldom (the medium) and often (the lights).
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/base/progress.h"
#include "host/cl/session.h"
#include "host/scene/camera.h"
#include "host/scene/features.h"
#include "host/scene/light.h"
#include "host/scene/settings.h"
#include "volumes/fluence_volume.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// Where the light's power went, per colour [W]. emitted = missed + reflected + absorbed + absorbed_opaque + escaped +
/// in_flight + roulette + rounding.
struct EnergyBalance {
  glm::dvec3 emitted{0};         ///< by the lights (what is aimed at the medium) and by emitting media
  glm::dvec3 missed{0};          ///< never met a medium
  glm::dvec3 reflected{0};       ///< by Fresnel where light enters
  glm::dvec3 absorbed{0};        ///< by media, on first flight and diffusing
  glm::dvec3 absorbed_opaque{0}; ///< by opaque surfaces
  glm::dvec3 escaped{0};         ///< left the media or the domain for good, in total
  std::array<glm::dvec3, 6> escaped_faces{};  ///< of it, towards -x, +x, -y, +y, -z, +z
  glm::dvec3 in_flight{0};       ///< paths cut by max_steps, max_bounces or min_power; deposits without a voxel
  glm::dvec3 roulette{0};        ///< photon solver: taken by Russian roulette less what it gave, zero on average
  glm::dvec3 rounding{0};        ///< lattice with storage "half": taken by rounding what is stored, less what it gave
  double imbalance() const;      ///< largest |emitted - sum of the rest| / emitted over the colours
};

/// What the lights throw on the ground plane through and out of the media, for the view pass: power per texel.
struct GroundLight {
  glm::vec2 origin{0};           ///< lower corner (x, z) [scene units]
  float texel = 1;               ///< edge of a texel [scene units]
  int size = 0;                  ///< texels per side; 0: none
  std::vector<glm::vec3> irradiance;  ///< [W/scene unit^2]
};

/// What one light sees: for shadows.
struct ShadowMap {
  glm::mat4 world_to_clip{1};    ///< OpenGL clip coordinates of a scene point
  int size = 0;
  std::vector<float> depth;      ///< distance from the light (point, spot) or along its direction from `origin` [scene units]
  glm::vec3 origin{0};           ///< where depths are counted from
  std::vector<glm::vec3> transmittance;  ///< share of the light that passes the media behind each texel; empty: none does,
                                         ///< it is on the ground's map instead
};

/// A Monte Carlo estimate with its standard error, per colour.
struct Estimate {
  glm::dvec3 value{0}, error{0};
};

/// What the photon solver counts, each with its standard error [W].
struct PhotonTallies {
  std::uint64_t photons = 0;     ///< followed, over all colours
  int batches = 0;               ///< independent parts that the standard errors come from
  Estimate reflected;            ///< specular, where light enters
  Estimate absorbed_opaque, in_flight, roulette;
  Estimate absorbed, escaped, unscattered;   ///< totals of the parts below
  std::vector<Estimate> absorbed_regions;    ///< by the medium of each region
  std::array<Estimate, 6> escaped_faces{};     ///< towards -x, +x, -y, +y, -z, +z
  std::array<Estimate, 6> unscattered_faces{}; ///< of it, what never scattered
};

/// How much the marching pass had to do.
struct MarchWork {
  std::int64_t steps = 0;        ///< of all rays
  std::int64_t deposits = 0;     ///< of them, such as left scattered light in voxels
  std::int64_t interfaces = 0;   ///< surfaces at which a ray was split
};

struct SolverReport {
  std::string solver;
  int channels = 3;
  std::size_t rays = 0;
  int march_batches = 0;
  MarchWork march;
  int iterations = 0;            ///< conjugate-gradient steps, or lattice sweeps
  double error_estimate = 0;     ///< relative error of the fluence that the solver's own stopping test gives
  double storage_error = 0;      ///< more that half-precision storage may leave in it; 0 in single precision
  std::size_t active_blocks = 0, active_voxels = 0;
  std::size_t diffusion_bytes = 0;  ///< device memory of the diffusion's operator and vectors [bytes]
  EnergyBalance energy;
  std::optional<PhotonTallies> photon;   ///< photon solver only
};

struct DeviceMedium;

/// A solver's answer.
struct LightSolution {
  std::shared_ptr<const DeviceMedium> device;  ///< the medium's tiles on the device, which the view pass reads too
  FluenceVolume volume;
  GroundLight ground;
  std::vector<ShadowMap> shadows;   ///< one per light; size 0: casts none
  SolverReport report;
};

/// Turns the light that enters a medium into the fluence inside it.
class TransportSolver {
 public:
  virtual ~TransportSolver() = default;
  /// All work that does not depend on the lights.
  virtual void prepare(const MediumVolume&) = 0;
  /// May be called often after one prepare.
  virtual LightSolution light(const LightList&) = 0;

  /// Seed of what `light` computes from now on, in place of that of the settings.
  virtual void set_seed(std::uint64_t seed) = 0;

  /// Whether `light` starts from the last answer where there is one: faster after a small change of the lights, to the same
  /// tolerance. By default every call starts afresh and gives the same bits whatever came before it. The photon solver, whose
  /// answers must be independent, starts afresh always.
  void set_warm_start(bool warm) { warm_start_ = warm; }
  bool warm_start() const { return warm_start_; }

 private:
  bool warm_start_ = false;
};

/// Everything a solver is made from.
struct SolverContext {
  cl::Session& session;
  Progress& progress;
  SolverSettings settings;
  SceneFeatures features;
  const MediumDescription& description;   ///< the bodies' surfaces, for rasterising
  Surroundings surroundings;
};

/// The one table of solvers: "steady", "lattice", "photon". Throws InputError for another name.
std::unique_ptr<TransportSolver> make_solver(const SolverContext&);

}  // namespace turbid
