// SPDX-License-Identifier: Apache-2.0
// The fluence that a user gets: diffuse light and the first flight together, as write_fluence_vdb writes it.
#pragma once
#include "host/transport/solver.h"
#include "volumes/fluence_volume.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// The medium as the solvers' diffuse and first-flight light see it at one voxel centre, by the voxel's owner.
struct LocalMedium {
  bool participates = false;         ///< and scatters enough for its fluence to be known, see local_media
  glm::vec3 sigma_s{0}, sigma_a{0};  ///< [1/scene unit]
  float g = 0;
  float eta = 1;  ///< of the region; its mean if it varies
};

/// Of every voxel of the volume's blocks: [block][voxel]. Voxels that scatter less than a hundredth of what the
/// strongest one does (in any colour) do not take part: there the first flight's fluence, deposit / sigma_s, is made of
/// what the voxels around them scatter.
std::vector<LocalMedium> local_media(const FluenceVolume&, const MediumVolume&);

/// phi = fluence + deposit / ((1 - g^2) sigma_s) [W/scene unit^2] in the `fluence` of the result, the diffuse part
/// alone where sigma_s = 0; `deposit` and `standard_error` are kept.
FluenceVolume total_fluence(const FluenceVolume&, const std::vector<LocalMedium>&);
FluenceVolume total_fluence(const FluenceVolume&, const MediumVolume&);

}  // namespace turbid
