// SPDX-License-Identifier: Apache-2.0
// Boxes of voxels read out of the medium's grids.
#include "volumes/medium_volume.h"

#include "volumes/medium_grids.h"

namespace turbid {

namespace {

std::size_t voxels_in(glm::ivec3 size) {
  return static_cast<std::size_t>(size.x) * size.y * size.z;
}

}  // namespace

MediumVolume::MediumVolume(std::unique_ptr<Grids> grids) : grids_(std::move(grids)) {}
MediumVolume::MediumVolume(MediumVolume&&) noexcept = default;
MediumVolume& MediumVolume::operator=(MediumVolume&&) noexcept = default;
MediumVolume::~MediumVolume() = default;

const GridFrame& MediumVolume::frame() const {
  return grids_->frame;
}
const std::array<FaceBoundary, 6>& MediumVolume::faces() const {
  return grids_->faces;
}
int MediumVolume::region_count() const {
  return static_cast<int>(grids_->regions.size());
}
const Region& MediumVolume::region(int r) const {
  return grids_->regions.at(r);
}
float MediumVolume::smoothing_voxels() const {
  return grids_->smoothing_voxels;
}

void MediumVolume::read_signed_distance(int r, glm::ivec3 lower, glm::ivec3 size, std::span<float> out) const {
  read_box(*grids_->fields.at(r).signed_distance, grids_->frame, lower, size,
           [&](std::size_t i, float d) { out[i] = d; });
}

void MediumVolume::read_eta(int r, glm::ivec3 lower, glm::ivec3 size, std::span<float> out) const {
  const Region& region = grids_->regions.at(r);
  const auto& grid = region.smooth_surface ? grids_->blurred_eta : grids_->fields[r].eta;
  if (grid)
    read_box(*grid, grids_->frame, lower, size, [&](std::size_t i, float eta) { out[i] = eta; });
  else
    std::fill_n(out.begin(), voxels_in(size), region.eta);
}

void MediumVolume::read_coefficients(int r, glm::ivec3 lower, glm::ivec3 size, std::span<Coefficients> out) const {
  const Region& region = grids_->regions.at(r);
  std::fill_n(out.begin(), voxels_in(size), Coefficients{region.sigma_s, region.sigma_a, region.emission, region.g});
  const RegionGrids& fields = grids_->fields[r];
  const auto colours = [&](const openvdb::Vec3SGrid::Ptr& grid, glm::vec3 Coefficients::*member) {
    if (!grid) return;
    read_box(*grid, grids_->frame, lower, size, [&](std::size_t i, const openvdb::Vec3s& v) {
      out[i].*member = {v[0], v[1], v[2]};
    });
  };
  colours(fields.sigma_s, &Coefficients::sigma_s);
  colours(fields.sigma_a, &Coefficients::sigma_a);
  colours(fields.emission, &Coefficients::emission);
  if (fields.g) read_box(*fields.g, grids_->frame, lower, size, [&](std::size_t i, float g) { out[i].g = g; });
}

void MediumVolume::read_owner(glm::ivec3 lower, glm::ivec3 size, std::span<int> out) const {
  const glm::ivec3 voxels = grids_->frame.voxels;
  read_box(*grids_->owner, grids_->frame, lower, size, [&](std::size_t i, int owner) { out[i] = owner; });
  if (glm::all(glm::greaterThanEqual(lower, glm::ivec3(0))) && glm::all(glm::lessThanEqual(lower + size, voxels)))
    return;
  std::size_t i = 0;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x, ++i) {
        const glm::ivec3 at = lower + glm::ivec3(x, y, z);
        if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, voxels))) out[i] = -1;
      }
}

}  // namespace turbid
