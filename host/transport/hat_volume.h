// SPDX-License-Identifier: Apache-2.0
// How much of its region each voxel, or its trilinear weight, covers: sums near a surface turn into densities, and
// densities into sums.
#pragma once
#include <vector>

#include "host/transport/diffusion_medium.h"

namespace turbid {

/// [block][voxel]: integral over the voxel's own region of its trilinear (hat) weight, in voxels; 1 away from surfaces,
/// in [0.02, 1] near them. Power spread with these weights divided by them is a power density without a staircase.
std::vector<float> hat_volumes(const MediumVolume&, const DiffusionMedium&);

/// [block][voxel]: volume of the voxel's part in its own region [voxels], in [0.02, 1]; 0 where `region` is -1.
std::vector<float> box_volumes(const MediumVolume&, const BlockGrid&, const std::vector<std::int16_t>& region);

/// A voxel's part in one region, of a voxel that a surface may cut.
struct VoxelPart {
  glm::ivec3 voxel;
  int region;
  float volume;      ///< [voxels], in [0, 1]
  glm::vec3 inside;  ///< a point of it, from the voxel's lower corner [voxels]
};
/// The parts of all such voxels of the domain, by regions from 0 up; the part that holds no sample is left out.
std::vector<VoxelPart> parts_of_cut_voxels(const MediumVolume&);

}  // namespace turbid
