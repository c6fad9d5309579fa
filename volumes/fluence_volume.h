// SPDX-License-Identifier: Apache-2.0
// The result of a solver: fluence per voxel and colour, on active blocks, with the light that scattered there first.
#pragma once
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "volumes/block_grid.h"
#include "volumes/frame.h"

namespace turbid {

class MediumVolume;

/// Values are stored [colour][block][voxel], voxel x fastest within its 8^3 block; inactive voxels hold 0.
struct FluenceVolume {
  GridFrame frame;
  BlockGrid blocks;
  std::vector<float> fluence;   ///< multiply scattered light, integral of radiance over angle [W/scene unit^2]
  std::vector<float> deposit;   ///< power that light rays scattered for the first time, per volume [W/scene unit^3]; their
                                ///< fluence is deposit / ((1 - g^2) sigma_s): the forward peak g^2 counts as not scattered
  std::vector<float> standard_error{};  ///< of the total fluence, Monte Carlo only [W/scene unit^2]; else empty

  std::size_t colour_stride() const { return static_cast<std::size_t>(blocks.count()) * blocks.voxels_per_block(); }
};

/// Writes `fluence` (RGB: diffuse plus first-flight deposit / sigma_s), `deposit` (RGB) and the medium's grids as one
/// OpenVDB file with transform and unit metadata. Throws InputError if the file can't be written.
void write_fluence_vdb(const FluenceVolume&, const MediumVolume&, const std::string& path, const std::string& unit,
                       const std::map<std::string, float>& numbers = {});

/// One line per grid of a .vdb file: name, type, class, active voxels, bounding box, transform, value range, metadata.
/// Throws InputError if the file is not a readable VDB.
std::string describe_vdb(const std::string& path);

}  // namespace turbid
