// SPDX-License-Identifier: Apache-2.0
// Integrals of the emission over the parts of cut voxels.
#include "host/transport/emission.h"

#include "host/transport/hat_volume.h"
#include "host/transport/nearest_voxels.h"

namespace turbid {

CutEmission cut_emission(const MediumVolume& medium) {
  CutEmission result;
  bool any = false;
  for (int r = 0; r < medium.region_count(); ++r) any |= medium.region(r).emits;
  if (!any) return result;
  const float h = medium.frame().voxel_size;
  for (const VoxelPart& part : parts_of_cut_voxels(medium)) {
    if (result.voxels.empty() || result.voxels.back() != part.voxel) result.voxels.push_back(part.voxel);
    const Region& region = medium.region(part.region);
    if (!region.emits) continue;
    Coefficients k{region.sigma_s, region.sigma_a, region.emission, region.g};
    if (region.heterogeneous) medium.read_coefficients(part.region, part.voxel, glm::ivec3(1), {&k, 1});
    result.parts.push_back({part.voxel, part.region, part.inside, h * h * h * part.volume * k.emission});
  }
  return result;
}

void weigh_emission(DiffusionMedium& out, const MediumVolume& medium, int first_colour) {
  const CutEmission cut = cut_emission(medium);
  for (const glm::ivec3& voxel : cut.voxels) {
    const std::int64_t at = active_voxel(out, voxel);
    for (int c = 0; at >= 0 && c < out.channels; ++c)
      out.emission[c * out.stride() + static_cast<std::size_t>(at)] = 0.0f;
  }
  std::vector<NearVoxel> nearest;
  for (const EmittingPart& part : cut.parts) {
    const auto give = [&](std::size_t at, float share) {
      for (int c = 0; c < out.channels; ++c)
        out.emission[c * out.stride() + at] += share * part.power[first_colour + c];
    };
    const std::int64_t own = active_voxel(out, part.voxel);
    if (own >= 0 && out.region[static_cast<std::size_t>(own)] == part.region) {
      give(static_cast<std::size_t>(own), 1.0f);
      continue;
    }
    find_nearest_voxels(out, part.voxel, part.region, nearest);
    for (const NearVoxel& near : nearest) give(near.at, near.weight);
  }
}

}  // namespace turbid
