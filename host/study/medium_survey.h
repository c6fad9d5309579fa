// SPDX-License-Identifier: Apache-2.0
// What a voxelised medium amounts to: counts, optical thickness per voxel, index steps, memory; and what is doubtful in
// it.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "volumes/medium_volume.h"

namespace turbid {

struct MediumSurvey {
  std::size_t voxels = 0, blocks = 0;  ///< of the domain
  std::size_t active_blocks = 0;       ///< 8^3 blocks that hold scattering or emitting voxels
  std::size_t active_voxels = 0;       ///< scattering or emitting voxels
  float thickness_min = 0;             ///< sigma_t * voxel size over active voxels and colours [-]
  float thickness_median = 0, thickness_max = 0;
  float first_flight_max = 0;      ///< the largest with the forward share of scattering set aside, as the march sees it [-]
  float first_flight_ambient = 0;  ///< of it, in the domain's own medium [-]
  float index_step = 0;            ///< largest |difference of eta| between neighbours in varying indices [-]
  std::string index_step_region;   ///< where that is
  std::vector<std::string> unseen;  ///< bodies that would take part but in which no voxel's centre lies
  std::uint64_t memory_bytes = 0;  ///< rough need of a run, host and device together
};

MediumSurvey survey_medium(const MediumVolume&);

/// One sentence each: voxels optically too thick, index steps too large, lights or camera inside a medium, thin
/// objects.
std::vector<std::string> survey_warnings(const Scene&, const MediumVolume&, const MediumSurvey&);

}  // namespace turbid
