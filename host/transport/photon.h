// SPDX-License-Identifier: Apache-2.0
// Runs the photon kernel: any stretch of photons of one colour adds to fixed-point sums on the device.
#pragma once
#include <cstdint>
#include <vector>

#include "host/scene/settings.h"
#include "host/transport/photon_medium.h"
#include "host/transport/photon_sources.h"
#include "host/transport/solver.h"

namespace turbid {

/// The device's fixed-point sums. Voxels and tallies are of one colour and batch, the ground's of the whole run.
struct PhotonSums {
  std::vector<std::int64_t> voxels;       ///< weight times length [voxels]: [scattered, not yet scattered][block][voxel]
  std::vector<std::int64_t> tallies;      ///< weight: TURBID_PHOTON_...
  std::vector<std::int64_t> ground;       ///< weight: [channel][texel]
  std::vector<std::int32_t> ground_rays;  ///< photons per texel
};

/// A stretch of photons of one colour. What it adds depends on these numbers alone, not on how stretches are cut.
struct PhotonStretch {
  int channel = 0;
  std::uint64_t first = 0;           ///< number of its first photon among all of the colour
  std::uint64_t first_in_batch = 0;
  std::uint64_t batch = 0;           ///< photons in the batch: their starts are stratified over the sources
  std::uint64_t count = 0;
};

class Photons {
 public:
  Photons(cl::Session&, const DeviceMedium&, const PhotonMedium&, const SolverSettings&, const std::array<FaceBoundary, 6>& faces,
          const Surroundings&);

  /// Loads sources and clears all sums. `units`: fixed-point units of a photon's start weight, a power of two.
  void start(const PhotonSources&, double units);
  /// Follows photons to their ends, and returns when they are there.
  void follow(const PhotonStretch&);

  void read(PhotonSums&);
  void write(const PhotonSums&);
  /// Clears voxels and tallies.
  void clear_batch();

  int tally_count() const { return static_cast<int>(tallies_.count()); }
  std::uint64_t fingerprint() const;  ///< of medium, sources and parameters
  /// The ground's map in scene units from its sums; watts[channel]: of one fixed-point unit.
  GroundLight ground_light(const PhotonSums&, const glm::dvec3& watts) const;

 private:
  cl::Session& session_;
  const DeviceMedium& device_;
  const PhotonMedium& medium_;
  PhotonParams params_{};
  std::uint64_t sources_fingerprint_ = 0;
  cl::Program program_;
  cl::Kernel<cl::Buffer<RegionParams>, cl::Buffer<int>, cl::Buffer<int>, cl::Buffer<float>, cl::Buffer<std::byte>, cl::Buffer<float>,
             PhotonParams, cl::Buffer<PhotonRegion>, cl::Buffer<PhotonSource>, cl::Buffer<std::uint64_t>, cl::Buffer<float>,
             cl::Buffer<int>, cl::Buffer<std::int16_t>, cl::Buffer<std::int64_t>, cl::Buffer<std::int64_t>,
             cl::Buffer<std::int64_t>, cl::Buffer<std::int32_t>>
      kernel_;
  cl::Buffer<PhotonSource> sources_;
  cl::Buffer<std::uint64_t> cumulative_;
  cl::Buffer<std::int64_t> voxels_, tallies_, ground_;
  cl::Buffer<std::int32_t> ground_rays_;
};

}  // namespace turbid
