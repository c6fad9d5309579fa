// SPDX-License-Identifier: Apache-2.0
// The Monte Carlo reference as a solver: the same medium and lights, the same kind of answer, with standard errors.
#pragma once
#include <optional>

#include "host/transport/photon_run.h"

namespace turbid {

class PhotonSolver final : public TransportSolver {
 public:
  explicit PhotonSolver(const SolverContext& context) : context_(context) {}
  void prepare(const MediumVolume&) override;
  LightSolution light(const LightList&) override;
  void set_seed(std::uint64_t seed) override { context_.settings.seed = seed; }
  /// The same for any sources.
  LightSolution follow(PhotonSources);

  const DeviceMedium& device_medium() const { return *device_; }

 private:
  PhotonTallies tallies(const PhotonRun&, const glm::dvec3& watts) const;

  SolverContext context_;
  const MediumVolume* medium_ = nullptr;
  std::shared_ptr<const DeviceMedium> device_;
  std::optional<PhotonMedium> photon_medium_;
  std::optional<EntrySurfaces> surfaces_;
  std::optional<Photons> photons_;
};

}  // namespace turbid
