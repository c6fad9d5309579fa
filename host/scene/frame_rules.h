// SPDX-License-Identifier: Apache-2.0
// From what [domain] asks for to the grid of voxels: which size they get and where they lie. Private to host/scene.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "volumes/frame.h"
#include "volumes/mesh.h"

namespace turbid::scene {

inline constexpr int kMargin = 2;                ///< voxels between the objects and an automatic domain's faces
inline constexpr double kBytesPerVoxel = 200.0;  ///< rough need of a solve: medium, coefficients, several levels
inline constexpr double kMostBytes = 64e9;
inline constexpr double kMostVoxels = 2147483648.0;  ///< 2^31: voxel numbers are 32-bit

struct FrameRequest {
  std::optional<double> resolution;     ///< voxels along the longest side, or
  std::optional<double> voxel_size;     ///< [scene units]
  Box3 box;                             ///< the domain, or (automatic) the bounds of all objects
  bool automatic = true;                ///< `box` gets a margin of kMargin voxels
  std::array<FaceBoundary, 6> faces{};  ///< -x, +x, -y, +y, -z, +z
};

struct FrameAnswer {
  GridFrame frame;
  double asked_voxel_size = 0;  ///< before it was adjusted to mirror and periodic axes
};

/// Voxels per axis are rounded up to whole blocks and the domain grows to match: evenly at both ends (given bounds by whole
/// voxels at the lower one, so that `min` stays a voxel's face), only at the open end of an axis with one mirror face. An axis whose two faces are mirrors or periodic keeps its exact extent; there
/// the voxel size shrinks, by a quarter at the most, until blocks fit. Throws InputError (no place in it) if that can't
/// be, naming resolutions that work, or if the grid would be too large, naming the memory that it would need.
FrameAnswer make_frame(const FrameRequest& request);

/// Resolutions near `voxel_size` [scene units] at which a given domain is whole blocks along all sides, so that it need not
/// grow: "88, 96, 104"; empty if there are none up to 1024 blocks.
std::string fitting_resolutions(const FrameRequest& request, double voxel_size);

}  // namespace turbid::scene
