// SPDX-License-Identifier: Apache-2.0
// The gathered source on the nodes of the rays' tiles, continued smoothly beyond each region's own voxels.
#pragma once
#include <vector>

#include "host/transport/device_medium.h"
#include "volumes/fluence_volume.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// 4 pi j = sigma_s fluence + deposit + emission per voxel edge, [tile][node][4 or 1 values], in the order of
/// DeviceMedium::source_tiles. Nodes that another region owns, or none, get values extrapolated from the region's own
/// voxels, geometrically along 26 directions, so that a camera ray meets no staircase at the surface.
std::vector<float> make_source_tiles(const FluenceVolume&, const MediumVolume&, const DeviceMedium&);

}  // namespace turbid
