// SPDX-License-Identifier: Apache-2.0
// What the deterministic solvers have in common: march the first flight, diffuse what it deposited, account for every watt.
#pragma once
#include <memory>
#include <optional>

#include "host/transport/device_medium.h"
#include "host/transport/diffusion_medium.h"
#include "host/transport/light_rays.h"
#include "host/transport/light_source.h"
#include "host/transport/march.h"
#include "host/transport/solver.h"

namespace turbid {

/// Where diffuse light went [W per channel], and the fluence it left.
struct DiffuseLight {
  std::vector<float> fluence;       ///< [channel][block][voxel] [W/voxel^2]
  glm::dvec3 absorbed{0};
  glm::dvec3 absorbed_opaque{0};    ///< diffused into opaque bodies
  std::array<glm::dvec3, 6> escaped{};
  glm::dvec3 stored{0};             ///< still on its way (lattice only)
  glm::dvec3 rounding{0};           ///< taken by half-precision storage (lattice only)
  int iterations = 0;
  double error_estimate = 0;
  double storage_error = 0;         ///< of the fluence, by half-precision storage (lattice only)
};

class MarchingSolver : public TransportSolver {
 public:
  explicit MarchingSolver(const SolverContext& context) : context_(context) {}
  void prepare(const MediumVolume&) final;
  LightSolution light(const LightList&) final;
  void set_seed(std::uint64_t seed) final { context_.settings.seed = seed; }

  const DeviceMedium& device_medium() const { return *device_; }
  const DiffusionMedium& diffusion_medium() const { return *diffusion_; }

 protected:
  virtual const char* name() const = 0;
  /// Light-independent work on the diffusion's operator.
  virtual void prepare_diffusion(const DiffusionMedium&) = 0;
  /// Runs batches until no ray is left; a solver may relax what is there already meanwhile.
  virtual void march_all(March&);
  virtual DiffuseLight diffuse(const LightSource&) = 0;
  /// Device memory of what prepare_diffusion made [bytes].
  virtual std::size_t diffusion_bytes() const = 0;

  /// Share of the rays that have ended.
  double march_progress(const March&) const;

  SolverContext context_;
  std::size_t first_ray_count_ = 0;

 private:
  const MediumVolume* medium_ = nullptr;
  std::shared_ptr<const DeviceMedium> device_;
  std::optional<DiffusionMedium> diffusion_;
  std::optional<EntrySurfaces> surfaces_;
  std::optional<March> march_;
};

/// Absorbed and escaped power of a steady fluence: sums of s_a phi and T_b phi, in double precision.
void account(const DiffusionMedium&, DiffuseLight&);

}  // namespace turbid
