// SPDX-License-Identifier: Apache-2.0
// Private to volumes/: the OpenVDB side of a MediumVolume and the steps that voxelise() takes to fill it.
#pragma once
#include <string>
#include <vector>

#include "volumes/grid_boxes.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// One region's fields; a null grid means that the constant of Region holds (or, for the ambient's distance, none).
struct RegionGrids {
  openvdb::FloatGrid::Ptr signed_distance;  ///< [voxels], clamped to +-band(); interior tiles hold -band()
  openvdb::FloatGrid::Ptr eta, g;           ///< background: mean over the voxels that the region owns
  openvdb::Vec3SGrid::Ptr sigma_s, sigma_a, emission;
};

struct MediumVolume::Grids {
  GridFrame frame;
  std::array<FaceBoundary, 6> faces{};
  float smoothing_voxels = 1.0f;
  std::vector<Region> regions;
  std::vector<RegionGrids> fields;      ///< one per region
  openvdb::Int32Grid::Ptr owner;        ///< background 0: the ambient
  openvdb::FloatGrid::Ptr blurred_eta;  ///< index of the smooth group; null if there is none

  bool periodic(int axis) const { return faces[2 * axis] == FaceBoundary::periodic; }
};

/// Called with the fraction done of one step.
using StepProgress = std::function<void(double)>;

/// Signed distance of a body in voxels; active within the band. (body_distance.cpp)
openvdb::FloatGrid::Ptr body_distance(const Solid&, const GridFrame&);

/// Who owns each voxel, from the distances of all bodies. (voxelise.cpp)
openvdb::Int32Grid::Ptr owner_of_voxels(const MediumVolume::Grids&);

/// What a region was before its material changed: fields that are the same objects are not evaluated again.
struct KnownRegion {
  const Material& material;
  const Region& region;
  const RegionGrids& fields;
};

/// Number of evaluations that fill_coefficients() will report as steps of their own: the varying fields that are not
/// known.
int varying_fields(const Material&, const KnownRegion* known);

/// Fills the constants, flags and grids of region `r` from its material. `after_each` ends one varying field. `known`
/// may be null. (region_coefficients.cpp)
void fill_coefficients(MediumVolume::Grids&, int r, const Material&, const KnownRegion* known,
                       const StepProgress& within, const std::function<void()>& after_each);

/// Index of the ambient and all smooth bodies, composed and blurred by a Gaussian. (smooth_index.cpp)
openvdb::FloatGrid::Ptr blurred_index(const MediumVolume::Grids&);

/// All named grids of the medium, ready to write. (medium_export.cpp)
openvdb::GridCPtrVec export_grids(const MediumVolume::Grids&, const std::string& unit);

}  // namespace turbid
