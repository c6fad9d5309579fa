// SPDX-License-Identifier: Apache-2.0
// The result as OpenVDB grids, beside the medium's own.
#include "volumes/fluence_volume.h"

#include <stdexcept>

#include "volumes/medium_grids.h"
#include "volumes/vdb_file.h"

namespace turbid {

void write_fluence_vdb(const FluenceVolume& result, const MediumVolume& medium, const std::string& path,
                       const std::string& unit, const std::map<std::string, float>& numbers) {
  const std::size_t expected = 3 * result.colour_stride();
  if (result.blocks.edge() != kBlockEdge || result.fluence.size() != expected ||
      (!result.deposit.empty() && result.deposit.size() != expected))
    throw std::invalid_argument("write_fluence_vdb: the result does not fit its blocks");
  initialise_vdb();

  using openvdb::Vec3SGrid;
  /// value(index into the result, the voxel's sigma_s as the first flight sees it) at the voxels where light is solved for.
  const auto compose = [&](auto value) {
    return grid_from_blocks<Vec3SGrid>(result.frame, openvdb::Vec3s(0.0f), [&](glm::ivec3 block) {
      BlockContent<Vec3SGrid> content;
      const int index = result.blocks.find(block);
      if (index < 0) return content;
      std::array<int, kBlockVoxels> owner;
      medium.read_owner(block * kBlockEdge, glm::ivec3(kBlockEdge), owner);
      std::vector<Coefficients> own(kBlockVoxels), coefficients(kBlockVoxels);
      for (int r = 0; r < medium.region_count(); ++r) {
        if (std::find(owner.begin(), owner.end(), r) == owner.end()) continue;
        medium.read_coefficients(r, block * kBlockEdge, glm::ivec3(kBlockEdge), own);
        for (int i = 0; i < kBlockVoxels; ++i)
          if (owner[i] == r) coefficients[i] = own[i];
      }
      content.leaf = make_leaf<Vec3SGrid>(block, openvdb::Vec3s(0.0f));
      for_block_voxels([&](int voxel, int offset) {
        openvdb::Vec3s colours;
        for (int c = 0; c < 3; ++c)
          colours[c] = value(c * result.colour_stride() + static_cast<std::size_t>(index) * kBlockVoxels + voxel,
                             coefficients[voxel].sigma_s[c] * (1.0f - coefficients[voxel].g * coefficients[voxel].g));
        content.leaf->setValueOnly(offset, colours);
        content.leaf->setActiveState(offset,
                                     medium.region(owner[voxel]).participates() || colours != openvdb::Vec3s(0.0f));
      });
      return content;
    });
  };
  const auto deposit = [&](std::size_t i) { return result.deposit.empty() ? 0.0f : result.deposit[i]; };
  const auto fluence_grid = compose(
      [&](std::size_t i, float sigma_s) { return result.fluence[i] + (sigma_s > 0 ? deposit(i) / sigma_s : 0.0f); });
  const auto deposit_grid = compose([&](std::size_t i, float) { return deposit(i); });
  label_grid(*fluence_grid, "fluence", openvdb::GRID_FOG_VOLUME, unit, "W/" + unit + "^2");
  label_grid(*deposit_grid, "deposit", openvdb::GRID_FOG_VOLUME, unit, "W/" + unit + "^3");

  for (const auto& [name, number] : numbers) fluence_grid->insertMeta(name, openvdb::FloatMetadata(number));

  openvdb::GridCPtrVec grids{fluence_grid, deposit_grid};
  for (const auto& grid : export_grids(medium.grids(), unit)) grids.push_back(grid);
  write_vdb_file(path, grids);
}

}  // namespace turbid
