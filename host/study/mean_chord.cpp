// SPDX-License-Identifier: Apache-2.0
// See mean_chord.h.
#include "host/study/mean_chord.h"

#include <algorithm>

namespace turbid {
namespace {

/// Faces between voxels that take part and others, or the domain's outside; mirrors and repetitions are no surface.
std::size_t surface_faces(const SampledFluence& sampled) {
  const BlockGrid& blocks = sampled.total.blocks;
  const int edge = blocks.edge(), per_block = blocks.voxels_per_block();
  const std::array<int, 3> stride{1, edge, edge * edge};
  std::size_t faces = 0;
  for (int block = 0; block < blocks.count(); ++block)
    for (int v = 0; v < per_block; ++v) {
      if (!sampled.media[std::size_t(block) * per_block + v].participates) continue;
      for (int face = 0; face < 6; ++face) {
        const int axis = face / 2, s = stride[axis], at = v / s % edge;
        const bool up = face % 2 == 1, leaves = at == (up ? edge - 1 : 0);
        int there = block, w = up ? v + s : v - s;
        if (leaves) {
          there = blocks.neighbours()[block][face];
          w = up ? v - (edge - 1) * s : v + (edge - 1) * s;
        }
        if (there == blocks.count() || !sampled.media[std::size_t(there) * per_block + w].participates) ++faces;
      }
    }
  return faces;
}

}  // namespace

double mean_chord(const SampledFluence& sampled) {
  const auto voxels =
      std::count_if(sampled.media.begin(), sampled.media.end(), [](const LocalMedium& m) { return m.participates; });
  // A smooth surface shows 3/2 of its area in voxel faces, on average over directions.
  const double surface = std::max(static_cast<double>(surface_faces(sampled)) * 2.0 / 3.0, 1.0);
  return 4.0 * static_cast<double>(voxels) / surface;
}

}  // namespace turbid
