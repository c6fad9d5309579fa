// SPDX-License-Identifier: Apache-2.0
// What photons need besides the ray kernels' medium: true coefficients (the others hold delta-scaled ones), majorants,
// and the voxels in which fluence is counted.
#pragma once
#include <cstdint>
#include <vector>

#include "host/transport/device_medium.h"
#include "host/transport/emission.h"
#include "kernels/shared/photon_params.h"
#include "volumes/block_grid.h"

namespace turbid {

struct PhotonMedium {
  explicit PhotonMedium(BlockGrid active) : blocks(std::move(active)) {}

  BlockGrid blocks;                  ///< the same active blocks as those of the other solvers
  std::vector<std::int16_t> region;  ///< [block][voxel]; -1: not active
  std::vector<float> volume;         ///< [block][voxel] of the voxel's part in its region [voxels]
  std::vector<glm::vec3> sigma_s;    ///< [block][voxel] at the voxel's centre, (1 - g^2) sigma_s [1/voxel]
  std::vector<glm::vec3> emission;   ///< [block][voxel] [W] of voxels that no surface cuts; empty where nothing emits
  std::vector<EmittingPart> emitting_parts;  ///< of the others
  std::size_t active_voxels = 0;
  int coefficient_tiles = 0;  ///< of one channel
  int majorant_sets = 0;
  std::uint64_t fingerprint = 0;  ///< of everything that can change a photon's path

  cl::Buffer<PhotonRegion> regions_buffer;
  cl::Buffer<float> coefficients;  ///< [channel][tile][node](sigma_s, sigma_a, g, 0)
  cl::Buffer<float> majorants;     ///< [channel][set][block of voxels]: bound of sigma_s + sigma_a
  cl::Buffer<int> block_index;     ///< [block of the domain]: active block, or -1
  cl::Buffer<std::int16_t> owner;  ///< `region`

  std::size_t stride() const { return static_cast<std::size_t>(blocks.count()) * 512; }
};

PhotonMedium upload_photon_medium(cl::Session&, const MediumVolume&, const DeviceMedium&);

/// FNV-1a, 64 bits, continued.
std::uint64_t fingerprint(std::uint64_t before, const void* bytes, std::size_t size);
template <class T>
std::uint64_t fingerprint(std::uint64_t before, const std::vector<T>& values) {
  return fingerprint(before, values.data(), values.size() * sizeof(T));
}

}  // namespace turbid
