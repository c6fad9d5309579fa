// SPDX-License-Identifier: Apache-2.0
// Which regions diffuse light spreads in, and which blocks hold them.
#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "host/base/parallel.h"
#include "host/transport/diffusion_medium.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512;

}  // namespace

std::vector<float> floors_of_s(const MediumVolume& medium) {
  // Voxels that hardly scatter: light crosses the domain there in one flight, so the diffusion coefficient is held at that of one
  // mean free path per domain (numerics section 4).
  const glm::ivec3 n = medium.frame().voxels;
  const float floor_s = 1.0f / static_cast<float>(std::max({n.x, n.y, n.z}));
  std::vector<float> floors(medium.region_count(), -1.0f);
  bool any_clear = false;
  for (int r = 0; r < medium.region_count(); ++r) {
    if (medium.region(r).participates()) floors[r] = floor_s;
    else any_clear |= r > 0 && !medium.region(r).opaque;
  }
  if (!any_clear) return floors;
  // Clear bodies that touch nothing but scattering regions and each other: found by what each voxel's upper neighbours are.
  const auto clear_body = [&](int r) { return r > 0 && floors[r] < 0.0f && !medium.region(r).opaque; };
  std::set<std::pair<int, int>> joined;
  std::vector<char> open(floors.size(), 0);
  std::vector<glm::ivec3> low(floors.size(), n), high(floors.size(), glm::ivec3(-1));
  open[0] = 1;
  std::vector<int> rows(static_cast<std::size_t>(n.x + 1) * 4);
  for (int z = -1; z < n.z; ++z) {
    for (int y = -1; y < n.y; ++y) {
      medium.read_owner({-1, y, z}, {n.x + 1, 2, 2}, rows);
      const int width = n.x + 1;
      for (int x = 0; x < width; ++x) {
        const int here = rows[x];
        const int upper[3] = {x + 1 < width ? rows[x + 1] : -1, rows[x + width], rows[x + 2 * width]};
        if (here > 0) {
          low[here] = glm::min(low[here], glm::ivec3(x - 1, y, z));
          high[here] = glm::max(high[here], glm::ivec3(x - 1, y, z));
        }
        for (int axis = 0; axis < 3; ++axis) {
          if (here == upper[axis]) continue;
          if (clear_body(here) && clear_body(upper[axis])) {
            joined.insert(std::minmax(here, upper[axis]));
            continue;
          }
          for (const auto& [a, b] : {std::pair(here, upper[axis]), std::pair(upper[axis], here)}) {
            if (a >= 0 && (b < 0 || floors[b] < 0.0f)) open[a] = 1;
          }
        }
      }
    }
  }
  // A void that opens into another one lets out what the other lets out.
  for (bool more = true; more;) {
    more = false;
    for (const auto& [a, b] : joined) {
      more |= open[a] != open[b];
      open[a] = open[b] = open[a] | open[b];
    }
  }
  for (int r = 1; r < medium.region_count(); ++r) {
    if (floors[r] >= 0.0f || medium.region(r).opaque || open[r] || high[r].x < 0) continue;
    const glm::ivec3 extent = high[r] - low[r] + 1;
    floors[r] = std::max(0.1f, 1.0f / static_cast<float>(std::max({extent.x, extent.y, extent.z})));
  }
  return floors;
}

BlockGrid active_blocks(const MediumVolume& medium, const std::vector<float>& floors) {
  const glm::ivec3 blocks = medium.frame().blocks();
  std::vector<char> active(blocks.x * blocks.y * blocks.z, 0);
  parallel_ranges(static_cast<int>(active.size()), [&](int begin, int end) {
    std::vector<int> owner(kVoxels);
    for (int i = begin; i < end; ++i) {
      const glm::ivec3 at(i % blocks.x, (i / blocks.x) % blocks.y, i / (blocks.x * blocks.y));
      medium.read_owner(kEdge * at, glm::ivec3(kEdge), owner);
      active[i] = std::any_of(owner.begin(), owner.end(),
                              [&](int r) { return r >= 0 && floors[r] >= 0.0f; });
    }
  });
  const auto& faces = medium.faces();
  return BlockGrid(
      blocks, kEdge, [&](glm::ivec3 b) { return active[b.x + blocks.x * (b.y + blocks.y * b.z)] != 0; },
      {faces[0] == FaceBoundary::periodic, faces[2] == FaceBoundary::periodic, faces[4] == FaceBoundary::periodic});
}

}  // namespace turbid
