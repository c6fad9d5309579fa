// SPDX-License-Identifier: Apache-2.0
// Adds up the tiles' copies of each node in a fixed order.
#include "host/transport/light_source.h"

#include <algorithm>
#include <cmath>

#include "host/base/parallel.h"
#include "host/transport/nearest_voxels.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512, kTileEdge = TURBID_TILE_EDGE;

/// What the nodes of one tile bring to voxels that other tiles serve too, in the order of the nodes.
struct Spread {
  struct Power {
    std::size_t at;
    glm::dvec3 watts;
    bool foreign;  // from a node outside the region's own voxels
  };
  struct Moment {
    std::size_t at;
    std::size_t node;
    double share;
  };
  std::vector<Power> powers;
  std::vector<Moment> moments;
  LeftAtOnce left;
  glm::dvec3 leaving{0};  // the sum of what has left
  glm::dvec3 unresolved{0};
};

/// Everything that the tiles' nodes are gathered from and into.
class Gathering {
 public:
  Gathering(const std::vector<std::int64_t>& deposit, const std::vector<std::int64_t>& flux, double watts_per_unit,
            const DeviceMedium& device, const DiffusionMedium& medium)
      : deposit_(deposit),
        flux_(flux),
        watts_per_unit_(watts_per_unit),
        device_(device),
        medium_(medium),
        channels_(medium.channels),
        stride_(medium.stride()),
        nodes_(device.source_tiles.size() * TURBID_TILE_NODES),
        moments_(!flux.empty() && !medium.g_star.empty()),
        own_(stride_ * channels_, 0.0),
        foreign_(stride_ * channels_, 0.0),
        moment_(moments_ ? 3 * stride_ * channels_ : 0, 0.0),
        boundary_(medium) {}

  LightSource run() {
    LightSource source;
    source.power = medium_.emission;
    source.density.assign(stride_ * channels_, 0.0f);
    // A tile's nodes at its upper faces are another tile's too: their copies are added in double precision, in the order of
    // the tiles, before anything is rounded. All others are the tile's own.
    std::vector<Spread> spreads(device_.source_tiles.size());
    parallel_ranges(static_cast<int>(spreads.size()), [&](int begin, int end) {
      std::vector<NearVoxel> targets;  // of the node at hand
      for (int tile = begin; tile < end; ++tile) gather(tile, spreads[tile], targets);
    });
    for (const Spread& spread : spreads) {
      for (const Spread::Power& power : spread.powers) {
        for (int c = 0; c < channels_; ++c) {
          (power.foreign ? foreign_ : own_)[c * stride_ + power.at] += power.watts[c];
        }
      }
      for (const Spread::Moment& moment : spread.moments) add_moment(moment);
      source.left.add(spread.left);
      source.deposited += spread.leaving;
      source.unresolved += spread.unresolved;
    }
    finish(source);
    if (moments_) add_first_moment(medium_, moment_, foreign_, source.left);
    parallel_ranges(static_cast<int>(foreign_.size()), [&](int begin, int end) {
      for (int at = begin; at < end; ++at) source.power[at] += static_cast<float>(foreign_[at]);
    });
    source.deposited += source.unresolved;
    return source;
  }

 private:
  void gather(std::size_t tile, Spread& spread, std::vector<NearVoxel>& targets) {
    const SourceTile& where = device_.source_tiles[tile];
    // The blocks of voxels that the tile's nodes lie in.
    int blocks[8];
    for (int k = 0; k < 8; ++k) blocks[k] = medium_.blocks.find(where.block + glm::ivec3(k & 1, k >> 1 & 1, k >> 2));
    const glm::ivec3 lower = kEdge * where.block, last = medium_.frame.voxels - 1 - lower;
    std::size_t node = tile * TURBID_TILE_NODES;
    for (int z = 0; z < kTileEdge; ++z) {
      for (int y = 0; y < kTileEdge; ++y) {
        for (int x = 0; x < kTileEdge; ++x, ++node) {
          const std::int64_t* sums = deposit_.data() + node * channels_;
          glm::dvec3 watts(0);
          bool empty = true;
          for (int c = 0; c < channels_; ++c) {
            empty &= sums[c] == 0;
            watts[c] = watts_per_unit_ * static_cast<double>(sums[c]);
          }
          if (empty) continue;
          const glm::ivec3 inside = glm::min(glm::ivec3(x, y, z), last), local = inside % kEdge;
          const int corner = inside.x / kEdge + 2 * (inside.y / kEdge) + 4 * (inside.z / kEdge);
          const std::size_t at = std::max(blocks[corner], 0) * std::size_t{kVoxels} + local.x + kEdge * (local.y + kEdge * local.z);
          if (blocks[corner] < 0 || medium_.region[at] != where.region) {
            spread_node(lower + inside, where.region, node, watts, spread, targets);
          } else if (x < kEdge && y < kEdge && z < kEdge) {
            for (int c = 0; c < channels_; ++c) own_[c * stride_ + at] += watts[c];
            if (moments_) add_moment({at, node, 1});
          } else {
            spread.powers.push_back({at, watts, false});
            if (moments_) spread.moments.push_back({at, node, 1});
          }
        }
      }
    }
  }

  /// A node outside the region's own voxels.
  void spread_node(glm::ivec3 voxel, int region, std::size_t node, glm::dvec3 watts, Spread& spread,
                   std::vector<NearVoxel>& targets) const {
    find_nearest_voxels(medium_, voxel, region, targets);
    if (targets.empty()) spread.unresolved += watts;
    for (const NearVoxel& target : targets) {
      if (moments_) spread.moments.push_back({target.at, node, target.weight});
      const glm::dvec3 power = watts * static_cast<double>(target.weight);
      glm::dvec3 stays = power;
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(target.offset[axis]) != 1) continue;  // farther nodes only where a part is thinner than a voxel
        const BoundaryFace* face = boundary_.find(target.at, 2 * axis + (target.offset[axis] > 0));
        if (!face) continue;
        for (int c = 0; c < channels_; ++c) {
          const double leaves = power[c] * share_beyond(medium_, *face, c, 1);
          spread.left.add(*face, c, leaves);
          stays[c] -= leaves;
        }
      }
      spread.powers.push_back({target.at, stays, true});
      spread.leaving += power - stays;
    }
  }

  void add_moment(const Spread::Moment& moment) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int c = 0; c < channels_; ++c) {
        moment_[(axis * channels_ + c) * stride_ + moment.at] +=
            medium_.g_star[moment.at] * moment.share * watts_per_unit_ *
            static_cast<double>(flux_[(axis * nodes_ + moment.node) * channels_ + c]);
      }
    }
  }

  void finish(LightSource& source) {
    const int blocks = medium_.blocks.count();
    // Block by block, so that the sums do not depend on the number of threads.
    std::vector<glm::dvec3> deposited(blocks, glm::dvec3(0)), emitted(blocks, glm::dvec3(0));
    std::vector<LeftAtOnce> left(blocks);
    parallel_ranges(blocks, [&](int begin, int end) {
      for (int block = begin; block < end; ++block) {
        for (int c = 0; c < channels_; ++c) {
          for (std::size_t i = block * std::size_t{kVoxels}; i < (block + 1) * std::size_t{kVoxels}; ++i) {
            const std::size_t at = c * stride_ + i;
            emitted[block][c] += source.power[at];
            // A point outside the surface, in thick voxels, would take more from its voxel than it brought.
            const double short_of = std::min(own_[at] + foreign_[at], 0.0);
            for (int face = 0; face < 6 && short_of < 0; ++face) {
              const BoundaryFace* out = boundary_.find(i, face);
              if (!out) continue;
              left[block].add(*out, c, short_of);
              deposited[block][c] += short_of;
              foreign_[at] -= short_of;
              break;
            }
            deposited[block][c] += own_[at] + foreign_[at];
            source.density[at] = static_cast<float>(own_[at] / medium_.hat_volume[i]);
            foreign_[at] += own_[at];
          }
        }
      }
    });
    for (int block = 0; block < blocks; ++block) {
      source.deposited += deposited[block];
      source.emitted += emitted[block];
      source.left.add(left[block]);
    }
  }

  const std::vector<std::int64_t>&deposit_, &flux_;
  double watts_per_unit_;
  const DeviceMedium& device_;
  const DiffusionMedium& medium_;
  int channels_;
  std::size_t stride_, nodes_;
  bool moments_;
  std::vector<double> own_, foreign_, moment_;  // [channel][block][voxel], moments per axis before
  BoundaryIndex boundary_;
};

}  // namespace

LightSource gather_source(const std::vector<std::int64_t>& deposit, const std::vector<std::int64_t>& flux,
                          double watts_per_unit, const DeviceMedium& device, const DiffusionMedium& medium) {
  return Gathering(deposit, flux, watts_per_unit, device, medium).run();
}

}  // namespace turbid
