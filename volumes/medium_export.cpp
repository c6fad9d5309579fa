// SPDX-License-Identifier: Apache-2.0
// The medium as named grids that Houdini, Blender or OpenVDB's own tools can open: what each voxel's owner sees there.
#include "volumes/medium_grids.h"
#include "volumes/vdb_file.h"

namespace turbid {
namespace {

using openvdb::FloatGrid;
using openvdb::Vec3s;
using openvdb::Vec3SGrid;
using Owners = std::array<int, kBlockVoxels>;

/// One number, or one per colour, at the voxels of a block.
template <class GridT>
struct Composed {
  std::array<typename GridT::ValueType, kBlockVoxels> values;
  std::array<bool, kBlockVoxels> active;
};

template <class GridT>
BlockContent<GridT> to_content(glm::ivec3 block, const Composed<GridT>& composed) {
  BlockContent<GridT> content;
  const auto& [values, active] = composed;
  const bool uniform = std::all_of(values.begin(), values.end(), [&](const auto& v) { return v == values[0]; }) &&
                       std::all_of(active.begin(), active.end(), [&](bool a) { return a == active[0]; });
  if (uniform) {
    content.tile = values[0];
    content.tile_active = active[0];
    return content;
  }
  content.leaf = make_leaf<GridT>(block, values[0]);
  for_block_voxels([&](int voxel, int offset) {
    content.leaf->setValueOnly(offset, values[voxel]);
    content.leaf->setActiveState(offset, active[voxel]);
  });
  return content;
}

/// Does the region's medium show in the grids? Bodies always, the ambient where it does anything to light.
bool shows(const Region& region, int r) {
  return !region.opaque && (r > 0 || region.participates() || region.absorbs);
}

template <class GridT>
void read_own(const MediumVolume::Grids& medium, const typename GridT::Ptr& grid, typename GridT::ValueType constant,
              glm::ivec3 block, std::array<typename GridT::ValueType, kBlockVoxels>& out) {
  if (grid)
    read_box(*grid, medium.frame, block * kBlockEdge, glm::ivec3(kBlockEdge),
             [&](std::size_t i, const auto& v) { out[i] = v; });
  else
    out.fill(constant);
}

/// The grid of what every voxel's owner has there; read(r, block, values) gets one region's values.
template <class GridT, class Read>
typename GridT::Ptr by_owner(const MediumVolume::Grids& medium, typename GridT::ValueType background, Read read) {
  return grid_from_blocks<GridT>(medium.frame, background, [&](glm::ivec3 block) {
    Owners owner;
    read_own<openvdb::Int32Grid>(medium, medium.owner, 0, block, owner);
    Composed<GridT> composed;
    composed.values.fill(background);
    composed.active.fill(false);
    auto own = composed.values;
    for (int r = 0; r < static_cast<int>(medium.regions.size()); ++r) {
      if (!shows(medium.regions[r], r) || std::find(owner.begin(), owner.end(), r) == owner.end()) continue;
      read(r, block, own);
      for (int i = 0; i < kBlockVoxels; ++i)
        if (owner[i] == r) {
          composed.values[i] = own[i];
          composed.active[i] = true;
        }
    }
    return to_content(block, composed);
  });
}

FloatGrid::Ptr eta_grid(const MediumVolume::Grids& medium) {
  const auto read = [&](int r, glm::ivec3 block, std::array<float, kBlockVoxels>& values) {
    const Region& region = medium.regions[r];
    read_own<FloatGrid>(medium, region.smooth_surface ? medium.blurred_eta : medium.fields[r].eta, region.eta, block,
                        values);
  };
  // The ambient's index shows wherever it is not the same as far away: a graded medium, a blurred surface.
  const Region& ambient = medium.regions[0];
  if (!ambient.graded_index || shows(ambient, 0)) return by_owner<FloatGrid>(medium, ambient.eta, read);
  return grid_from_blocks<FloatGrid>(medium.frame, ambient.eta, [&](glm::ivec3 block) {
    Owners owner;
    read_own<openvdb::Int32Grid>(medium, medium.owner, 0, block, owner);
    Composed<FloatGrid> composed;
    read(0, block, composed.values);
    for (int i = 0; i < kBlockVoxels; ++i) composed.active[i] = owner[i] == 0 && composed.values[i] != ambient.eta;
    std::array<float, kBlockVoxels> own;
    for (int r = 1; r < static_cast<int>(medium.regions.size()); ++r) {
      if (std::find(owner.begin(), owner.end(), r) == owner.end()) continue;
      if (!medium.regions[r].opaque) read(r, block, own);
      for (int i = 0; i < kBlockVoxels; ++i)
        if (owner[i] == r) {
          composed.values[i] = medium.regions[r].opaque ? ambient.eta : own[i];
          composed.active[i] = !medium.regions[r].opaque;
        }
    }
    return to_content(block, composed);
  });
}

using ColourGrids = Vec3SGrid::Ptr RegionGrids::*;
using ColourConstant = glm::vec3 Region::*;
Vec3SGrid::Ptr colour_grid(const MediumVolume::Grids& medium, ColourGrids grids, ColourConstant constants) {
  return by_owner<Vec3SGrid>(medium, Vec3s(0.0f), [&](int r, glm::ivec3 block, auto& values) {
    const glm::vec3 constant = medium.regions[r].*constants;
    read_own<Vec3SGrid>(medium, medium.fields[r].*grids, Vec3s(constant.x, constant.y, constant.z), block, values);
  });
}

/// Distance from the union of all bodies [voxels] at the voxels of a box; false if all are far outside.
bool read_union(const MediumVolume::Grids& medium, glm::ivec3 block, glm::ivec3 lower, glm::ivec3 size,
                std::span<float> out) {
  std::fill(out.begin(), out.end(), MediumVolume::band());
  bool near = false;
  for (std::size_t r = 1; r < medium.regions.size(); ++r) {
    const FloatGrid& grid = *medium.fields[r].signed_distance;
    if (!grid.tree().probeConstLeaf(first_voxel(block)) && grid.tree().getValue(first_voxel(block)) > 0) continue;
    near = true;
    read_box(grid, medium.frame, lower, size, [&](std::size_t i, float d) { out[i] = std::min(out[i], d); });
  }
  return near;
}

FloatGrid::Ptr distance_grid(const MediumVolume::Grids& medium) {
  const float h = medium.frame.voxel_size, far = MediumVolume::band() * h;
  return grid_from_blocks<FloatGrid>(medium.frame, far, [&](glm::ivec3 block) {
    Composed<FloatGrid> composed;
    if (!read_union(medium, block, block * kBlockEdge, glm::ivec3(kBlockEdge), composed.values))
      return BlockContent<FloatGrid>{};
    for (int i = 0; i < kBlockVoxels; ++i) {
      composed.active[i] = std::abs(composed.values[i]) < MediumVolume::band();
      composed.values[i] *= h;
    }
    return to_content(block, composed);
  });
}

/// Share of the voxel around `centre` of a 10^3 box where the interpolated distance is negative, from 4^3 points.
float covered_share(const std::array<float, 1000>& d, int centre) {
  int inside = 0;
  for (int s = 0; s < 64; ++s) {
    float fraction[3];
    int cell = centre;
    const int place[3] = {s & 3, (s >> 2) & 3, s >> 4}, stride[3] = {1, 10, 100};
    for (int axis = 0; axis < 3; ++axis) {
      fraction[axis] = (static_cast<float>(place[axis]) + 0.5f) / 4 - 0.5f;
      if (fraction[axis] < 0) {
        cell -= stride[axis];
        fraction[axis] += 1;
      }
    }
    float value = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int x = corner & 1, y = (corner >> 1) & 1, z = corner >> 2;
      value += d[cell + x + 10 * y + 100 * z] * (x ? fraction[0] : 1 - fraction[0]) *
               (y ? fraction[1] : 1 - fraction[1]) * (z ? fraction[2] : 1 - fraction[2]);
    }
    inside += value < 0;
  }
  return static_cast<float>(inside) / 64;
}

FloatGrid::Ptr occupancy_grid(const MediumVolume::Grids& medium) {
  return grid_from_blocks<FloatGrid>(medium.frame, 0.0f, [&](glm::ivec3 block) {
    std::array<float, 1000> d;
    if (!read_union(medium, block, block * kBlockEdge - 1, glm::ivec3(10), d)) return BlockContent<FloatGrid>{};
    Composed<FloatGrid> composed;
    for_block_voxels([&](int voxel, int) {
      const int centre = 111 + (voxel & 7) + 10 * ((voxel >> 3) & 7) + 100 * (voxel >> 6);
      const float share = std::abs(d[centre]) >= 1.0f ? static_cast<float>(d[centre] < 0) : covered_share(d, centre);
      composed.values[voxel] = share;
      composed.active[voxel] = share > 0;
    });
    return to_content(block, composed);
  });
}

}  // namespace

openvdb::GridCPtrVec export_grids(const MediumVolume::Grids& medium, const std::string& unit) {
  openvdb::GridCPtrVec grids;
  const auto add = [&](const openvdb::GridBase::Ptr& grid, const char* name, openvdb::GridClass grid_class,
                       const std::string& unit_of_values) {
    label_grid(*grid, name, grid_class, unit, unit_of_values);
    grids.push_back(grid);
  };
  const auto fog = openvdb::GRID_FOG_VOLUME;
  add(eta_grid(medium), "eta", fog, "1");
  add(colour_grid(medium, &RegionGrids::sigma_s, &Region::sigma_s), "sigma_s", fog, "1/" + unit);
  add(colour_grid(medium, &RegionGrids::sigma_a, &Region::sigma_a), "sigma_a", fog, "1/" + unit);
  add(by_owner<FloatGrid>(medium, 0.0f,
                          [&](int r, glm::ivec3 block, auto& values) {
                            read_own<FloatGrid>(medium, medium.fields[r].g, medium.regions[r].g, block, values);
                          }),
      "g", fog, "1");
  if (std::any_of(medium.regions.begin(), medium.regions.end(), [](const Region& region) { return region.emits; }))
    add(colour_grid(medium, &RegionGrids::emission, &Region::emission), "emission", fog, "W/" + unit + "^3");
  add(occupancy_grid(medium), "occupancy", fog, "1");
  add(distance_grid(medium), "signed_distance", openvdb::GRID_LEVEL_SET, unit);
  const auto owner = medium.owner->deepCopy();
  add(owner, "region", openvdb::GRID_UNKNOWN, "1");
  return grids;
}

void MediumVolume::write_vdb(const std::string& path, const std::string& unit) const {
  write_vdb_file(path, export_grids(*grids_, unit));
}

}  // namespace turbid
