// SPDX-License-Identifier: Apache-2.0
// Bodies and materials become voxels: distances, then who owns each voxel, then coefficients, then the blurred index.
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "host/base/errors.h"
#include "kernels/shared/medium_params.h"
#include "volumes/medium_grids.h"
#include "volumes/vdb_file.h"

namespace turbid {
namespace {

/// Turns steps of equal weight into one fraction for the caller, who may throw to stop.
class Steps {
 public:
  Steps(const std::function<void(double)>& progress, int count) : progress_(progress), count_(count) {}
  void within(double fraction) const {
    if (progress_) progress_(std::min(1.0, (done_ + fraction) / count_));
  }
  void next() {
    ++done_;
    within(0);
  }

 private:
  const std::function<void(double)>& progress_;
  int count_, done_ = 0;
};

void require_consistent(const MediumDescription& scene) {
  const GridFrame& frame = scene.frame;
  for (int axis = 0; axis < 3; ++axis)
    if (frame.voxels[axis] <= 0 || frame.voxels[axis] % kBlockEdge != 0)
      throw std::invalid_argument("voxelise: the domain is no whole number of blocks");
  if (!(frame.voxel_size > 0) || !std::isfinite(frame.voxel_size)) throw std::invalid_argument("voxelise: voxel size");
  if (!(scene.smoothing_voxels >= 0) || scene.smoothing_voxels > 64)
    throw std::invalid_argument("voxelise: smoothing_voxels");
  const int materials = static_cast<int>(scene.materials.size());
  if (scene.ambient_material < -1 || scene.ambient_material >= materials)
    throw std::invalid_argument("voxelise: ambient");
  for (const Body& body : scene.bodies)
    if (body.material < 0 || body.material >= materials)
      throw std::invalid_argument("voxelise: material of " + body.name);
  if (scene.ambient_material >= 0 && scene.materials[scene.ambient_material].opaque)
    throw InputError("material \"" + scene.materials[scene.ambient_material].name +
                     "\": is opaque and fills the domain: give the domain a medium, or none for vacuum");
}

}  // namespace

// As region_with_room in kernels/lib/medium.h decides for points: the last body that holds a voxel's centre, or in the
// gap between two that touch the later one.
openvdb::Int32Grid::Ptr owner_of_voxels(const MediumVolume::Grids& medium) {
  return grid_from_blocks<openvdb::Int32Grid>(medium.frame, 0, [&](glm::ivec3 block) {
    BlockContent<openvdb::Int32Grid> content;
    const auto at = first_voxel(block);
    constexpr int kUndecided = -1;
    std::array<int, kBlockVoxels> owner, nearest_region;
    std::array<float, kBlockVoxels> nearest;  // of the bodies passed over
    owner.fill(kUndecided);
    nearest.fill(1e9f);
    int everywhere = 0;  // of the voxels that no surface comes near
    bool mixed = false;
    for (int r = static_cast<int>(medium.regions.size()) - 1; r >= 1 && everywhere == 0; --r) {
      const auto& tree = medium.fields[r].signed_distance->tree();
      const auto* leaf = tree.probeConstLeaf(at);
      if (!leaf) {
        if (tree.getValue(at) < 0) everywhere = r;
        continue;
      }
      const float* d = leaf->buffer().data();
      for (int i = 0; i < kBlockVoxels; ++i) {
        if (owner[i] != kUndecided) continue;
        if (d[i] < 0) {
          owner[i] = r;
        } else if (nearest[i] + d[i] < TURBID_TOUCH) {
          owner[i] = nearest_region[i];
        } else if (d[i] < nearest[i]) {
          nearest[i] = d[i];
          nearest_region[i] = r;
        }
        mixed = mixed || owner[i] != kUndecided;
      }
    }
    if (mixed) {
      content.leaf = make_leaf<openvdb::Int32Grid>(block, everywhere, everywhere > 0);
      for (int i = 0; i < kBlockVoxels; ++i)
        if (owner[i] != kUndecided) content.leaf->setValueOn(i, owner[i]);
    } else if (everywhere > 0) {
      content.tile = everywhere;
      content.tile_active = true;
    }
    return content;
  });
}

namespace {

/// What is known from before: grids, and the description that they were made from.
struct Known {
  const MediumVolume::Grids& grids;
  const MediumDescription& description;
};

const Material* material_of(const MediumDescription& scene, int region) {
  const int material = region > 0 ? scene.bodies[region - 1].material : scene.ambient_material;
  return material >= 0 ? &scene.materials[material] : nullptr;
}

/// What is known of a region's coefficients; nothing of a surface that was opaque.
std::optional<KnownRegion> known_region(const Known* known, int region) {
  const Material* material = known ? material_of(known->description, region) : nullptr;
  if (!material || material->opaque) return std::nullopt;
  return KnownRegion{*material, known->grids.regions[region], known->grids.fields[region]};
}

/// Whether no index that the blur mixes has another field now.
bool same_blur(const MediumVolume::Grids& medium, const MediumDescription& scene, const Known& known) {
  if (!known.grids.blurred_eta) return false;
  for (int r = 0; r < static_cast<int>(medium.regions.size()); ++r) {
    if (medium.regions[r].smooth_surface != known.grids.regions[r].smooth_surface) return false;
    const Material *now = material_of(scene, r), *then = material_of(known.description, r);
    if ((now != nullptr) != (then != nullptr) || (now && now->eta != then->eta)) return false;
  }
  return true;
}

MediumVolume voxelise_all(const MediumDescription& scene, const Known* known,
                          const std::function<void(double)>& progress) {
  require_consistent(scene);
  initialise_vdb();
  auto medium = std::make_unique<MediumVolume::Grids>();
  medium->frame = scene.frame;
  medium->faces = scene.faces;
  medium->smoothing_voxels = scene.smoothing_voxels;
  medium->regions.resize(1 + scene.bodies.size());
  medium->fields.resize(1 + scene.bodies.size());

  const int regions = static_cast<int>(medium->regions.size());
  int step_count = regions + 1;  // a distance per body, the owners, the blur
  for (int r = 0; r < regions; ++r) {
    const auto before = known_region(known, r);
    if (const Material* material = material_of(scene, r))
      step_count += varying_fields(*material, before ? &*before : nullptr);
  }
  Steps steps(progress, step_count);
  steps.within(0);

  for (int r = 1; r < regions; ++r) {
    medium->fields[r].signed_distance =
        known ? known->grids.fields[r].signed_distance : body_distance(scene.bodies[r - 1].solid, scene.frame);
    steps.next();
  }
  medium->owner = known ? known->grids.owner : owner_of_voxels(*medium);
  steps.next();

  bool any_smooth = false;
  for (int r = 0; r < regions; ++r) {
    Region& region = medium->regions[r];
    region.name = r > 0 ? scene.bodies[r - 1].name : "ambient";
    const auto before = known_region(known, r);
    if (const Material* material = material_of(scene, r))
      fill_coefficients(
          *medium, r, *material, before ? &*before : nullptr, [&](double fraction) { steps.within(fraction); },
          [&] { steps.next(); });
    region.smooth_surface = r > 0 && !region.opaque && scene.bodies[r - 1].surface == SurfaceKind::smooth;
    any_smooth = any_smooth || region.smooth_surface;
  }
  if (any_smooth) {
    medium->regions[0].smooth_surface = true;
    medium->blurred_eta =
        known && same_blur(*medium, scene, *known) ? known->grids.blurred_eta : blurred_index(*medium);
    for (Region& region : medium->regions) region.graded_index = region.graded_index || region.smooth_surface;
  }
  steps.next();
  return MediumVolume(std::move(medium));
}

}  // namespace

MediumVolume voxelise(const MediumDescription& scene, const std::function<void(double)>& progress) {
  return voxelise_all(scene, nullptr, progress);
}

MediumVolume revoxelise(const MediumVolume& medium, const MediumDescription& known, const MediumDescription& scene,
                        const std::function<void(double)>& progress) {
  const Known before{medium.grids(), known};
  if (known.bodies.size() != scene.bodies.size() || known.frame.voxels != scene.frame.voxels)
    throw std::invalid_argument("revoxelise: other bodies or another frame");
  return voxelise_all(scene, &before, progress);
}

}  // namespace turbid
