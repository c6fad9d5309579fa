// SPDX-License-Identifier: Apache-2.0
// What emitting media emit, by true volumes: voxels that a surface cuts emit by their parts.
#pragma once
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

struct EmittingPart {
  glm::ivec3 voxel;
  int region;
  glm::vec3 inside;  ///< a point of the part, from the voxel's lower corner [voxels]
  glm::vec3 power;   ///< [W]
};

/// Of voxels that a surface may cut, what each part emits.
struct CutEmission {
  std::vector<glm::ivec3> voxels;  ///< all of them: what they emit as whole voxels does not count
  std::vector<EmittingPart> parts;
};
CutEmission cut_emission(const MediumVolume&);

/// Corrects `emission` of the cut voxels. Parts in voxels that another region owns go to the nearest active voxels of
/// their own, in equal shares of inverse square distance; where there are none, the part is thinner than a voxel and
/// stays dark.
void weigh_emission(DiffusionMedium&, const MediumVolume&, int first_colour);

}  // namespace turbid
