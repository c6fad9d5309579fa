// SPDX-License-Identifier: Apache-2.0
// See face_sources.h.
#include "host/transport/face_sources.h"

namespace turbid {
namespace {

constexpr std::size_t kVoxels = 512;

}  // namespace

BoundaryIndex::BoundaryIndex(const DiffusionMedium& medium) : medium_(medium), first_(medium.stride(), -1) {
  // make_diffusion_medium lists them by block, voxel and face.
  for (std::size_t i = medium.boundary.size(); i-- > 0;) {
    first_[medium.boundary[i].block * kVoxels + medium.boundary[i].voxel] = static_cast<std::int32_t>(i);
  }
}

const BoundaryFace* BoundaryIndex::find(std::size_t at, int face) const {
  if (first_[at] < 0) return nullptr;
  const BoundaryFace* found = medium_.boundary.data() + first_[at];
  const BoundaryFace* end = medium_.boundary.data() + medium_.boundary.size();
  for (; found < end && found->block * kVoxels + found->voxel == at; ++found) {
    if (found->face == face) return found;
  }
  return nullptr;
}

void add_first_moment(const DiffusionMedium& medium, const std::vector<double>& flux, std::vector<double>& power,
                      LeftAtOnce& left) {
  const std::size_t stride = medium.stride();
  const int channels = medium.channels;
  const std::vector<float> conductance = face_conductances(medium);
  for (int block = 0; block < medium.blocks.count(); ++block) {
    for (int v = 0; v < static_cast<int>(kVoxels); ++v) {
      const std::size_t here = block * kVoxels + v;
      if (medium.region[here] < 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const VoxelRef other = neighbour_over(medium.blocks, block, v, 2 * axis + 1);
        if (other.block < 0) continue;
        const std::size_t there = other.block * kVoxels + other.voxel;
        for (int c = 0; c < channels; ++c) {
          const double t = conductance[(3 * c + axis) * stride + here];  // 0 towards voxels that are not active
          const double* along = flux.data() + (axis * channels + c) * stride;
          const double moved =
              1.5 * t * (along[here] / medium.eta_squared[here] + along[there] / medium.eta_squared[there]);
          power[c * stride + here] -= moved;
          power[c * stride + there] += moved;
        }
      }
    }
  }
  for (const BoundaryFace& face : medium.boundary) {
    const std::size_t at = face.block * kVoxels + face.voxel;
    const double sign = face.face % 2 ? 1 : -1;
    for (int c = 0; c < channels; ++c) {
      const double along = flux[((face.face / 2) * channels + c) * stride + at];
      const double out = 3.0 * face.distance * sign * along * medium.boundary_conductance(face, c);
      power[c * stride + at] -= out;
      left.add(face, c, out);
    }
  }
}

}  // namespace turbid
