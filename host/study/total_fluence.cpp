// SPDX-License-Identifier: Apache-2.0
// See total_fluence.h.
#include "host/study/total_fluence.h"

#include <algorithm>
#include <array>

#include "host/base/parallel.h"

namespace turbid {
namespace {

constexpr float kLeastScattering = 0.01f;  // of the strongest: a trilinear deposit reaches one voxel far

}  // namespace

std::vector<LocalMedium> local_media(const FluenceVolume& volume, const MediumVolume& medium) {
  constexpr int kVoxels = kBlockEdge * kBlockEdge * kBlockEdge;
  std::vector<LocalMedium> all(volume.colour_stride());
  parallel_ranges(volume.blocks.count(), [&](int begin, int end) {
    std::array<int, kVoxels> owner;
    std::vector<Coefficients> own(kVoxels);
    for (int block = begin; block < end; ++block) {
      const glm::ivec3 lower = volume.blocks.coordinates(block) * kBlockEdge;
      medium.read_owner(lower, glm::ivec3(kBlockEdge), owner);
      for (int r = 0; r < medium.region_count(); ++r) {
        const Region& region = medium.region(r);
        if (!region.participates() || std::find(owner.begin(), owner.end(), r) == owner.end()) continue;
        if (region.heterogeneous)
          medium.read_coefficients(r, lower, glm::ivec3(kBlockEdge), own);
        else
          std::fill(own.begin(), own.end(), Coefficients{region.sigma_s, region.sigma_a, region.emission, region.g});
        for (int v = 0; v < kVoxels; ++v)
          if (owner[v] == r)
            all[std::size_t(block) * kVoxels + v] = {true, own[v].sigma_s, own[v].sigma_a, own[v].g, region.eta};
      }
    }
  });
  glm::vec3 strongest(0);
  for (const LocalMedium& m : all) strongest = glm::max(strongest, m.sigma_s);
  for (LocalMedium& m : all)
    for (int c = 0; c < 3; ++c)
      if (m.sigma_s[c] > 0 && m.sigma_s[c] < kLeastScattering * strongest[c]) m.participates = false;
  return all;
}

FluenceVolume total_fluence(const FluenceVolume& volume, const std::vector<LocalMedium>& media) {
  FluenceVolume total = volume;
  if (volume.deposit.empty()) return total;
  const std::size_t stride = volume.colour_stride();
  for (int c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < stride; ++i) {
      const float first_flight = (1.0f - media[i].g * media[i].g) * media[i].sigma_s[c];
      if (first_flight > 0) total.fluence[c * stride + i] += volume.deposit[c * stride + i] / first_flight;
    }
  return total;
}

FluenceVolume total_fluence(const FluenceVolume& volume, const MediumVolume& medium) {
  return total_fluence(volume, local_media(volume, medium));
}

}  // namespace turbid
