// SPDX-License-Identifier: Apache-2.0
// Adds up the tiles' copies of each node in a fixed order.
#include "host/transport/light_source.h"

#include <algorithm>
#include <cmath>

#include "host/transport/nearest_voxels.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512, kTileEdge = TURBID_TILE_EDGE;

}  // namespace

LightSource gather_source(const std::vector<std::int64_t>& deposit, const std::vector<std::int64_t>& flux,
                          double watts_per_unit, const DeviceMedium& device, const DiffusionMedium& medium) {
  const int channels = medium.channels;
  const std::size_t stride = medium.stride();
  LightSource source;
  source.power = medium.emission;
  source.density.assign(stride * channels, 0.0f);
  for (int c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < stride; ++i) source.emitted[c] += source.power[c * stride + i];
  }
  // Copies of a node in neighbouring tiles are added in double precision before anything is rounded.
  const bool moments = !flux.empty() && !medium.g_star.empty();
  std::vector<double> own(stride * channels, 0.0), foreign(stride * channels, 0.0);
  std::vector<double> moment(moments ? 3 * stride * channels : 0, 0.0);
  const BoundaryIndex boundary(medium);
  const std::size_t nodes = device.source_tiles.size() * TURBID_TILE_NODES;
  for (std::size_t tile = 0; tile < device.source_tiles.size(); ++tile) {
    const SourceTile& where = device.source_tiles[tile];
    const std::int64_t* node = deposit.data() + tile * TURBID_TILE_NODES * channels;
    for (int i = 0; i < TURBID_TILE_NODES; ++i, node += channels) {
      bool empty = true;
      for (int c = 0; c < channels; ++c) empty &= node[c] == 0;
      if (empty) continue;
      const glm::ivec3 voxel =
          kEdge * where.block + glm::ivec3(i % kTileEdge, (i / kTileEdge) % kTileEdge, i / (kTileEdge * kTileEdge));
      const glm::ivec3 inside = glm::min(voxel, medium.frame.voxels - 1);
      const int block = medium.blocks.find(inside / kEdge);
      const glm::ivec3 local = inside % kEdge;
      const std::size_t at =
          block < 0 ? 0 : block * std::size_t{kVoxels} + local.x + kEdge * (local.y + kEdge * local.z);
      const auto add_moment = [&](std::size_t to, double share) {
        if (!moments) return;
        const std::size_t from = (tile * TURBID_TILE_NODES + i) * channels;
        for (int axis = 0; axis < 3; ++axis)
          for (int c = 0; c < channels; ++c)
            moment[(axis * channels + c) * stride + to] +=
                medium.g_star[to] * share * watts_per_unit *
                static_cast<double>(flux[axis * nodes * channels + from + c]);
      };
      if (block >= 0 && medium.region[at] == where.region) {
        for (int c = 0; c < channels; ++c) own[c * stride + at] += watts_per_unit * static_cast<double>(node[c]);
        add_moment(at, 1);
        continue;
      }
      const std::vector<NearVoxel> targets = nearest_voxels(medium, inside, where.region);
      for (int c = 0; c < channels && targets.empty(); ++c)
        source.unresolved[c] += watts_per_unit * static_cast<double>(node[c]);
      for (const NearVoxel& target : targets) {
        add_moment(target.at, target.weight);
        for (int c = 0; c < channels; ++c) {
          const double power = watts_per_unit * static_cast<double>(node[c]) * target.weight;
          double stays = power;
          for (int axis = 0; axis < 3; ++axis) {
            const int distance = std::abs(target.offset[axis]);
            if (distance != 1) continue;  // farther nodes only where a part is thinner than a voxel
            const BoundaryFace* face = boundary.find(target.at, 2 * axis + (target.offset[axis] > 0));
            if (!face) continue;
            const double leaves = power * share_beyond(medium, *face, c, 1);
            source.left.add(*face, c, leaves);
            stays -= leaves;
          }
          source.deposited[c] += power - stays;
          foreign[c * stride + target.at] += stays;
        }
      }
    }
  }
  for (int c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < stride; ++i) {
      const std::size_t at = c * stride + i;
      // A point outside the surface, in thick voxels, would take more from its voxel than it brought.
      const double short_of = std::min(own[at] + foreign[at], 0.0);
      for (int face = 0; face < 6 && short_of < 0; ++face) {
        const BoundaryFace* out = boundary.find(i, face);
        if (!out) continue;
        source.left.add(*out, c, short_of);
        source.deposited[c] += short_of;
        foreign[at] -= short_of;
        break;
      }
      source.deposited[c] += own[at] + foreign[at];
      source.density[at] = static_cast<float>(own[at] / medium.hat_volume[i]);
      foreign[at] += own[at];
    }
  }
  if (moments) add_first_moment(medium, moment, foreign, source.left);
  for (std::size_t at = 0; at < foreign.size(); ++at) source.power[at] += static_cast<float>(foreign[at]);
  source.deposited += source.unresolved;
  return source;
}

}  // namespace turbid
