// SPDX-License-Identifier: Apache-2.0
// See tile_values.h.
#include "host/transport/tile_values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtc/packing.hpp>
#include <mutex>
#include <span>

#include "host/base/parallel.h"

namespace turbid {

template <int halo>
void with_gradient(const std::vector<float>& values, float* out) {
  constexpr int edge = halo_edge(halo), strides[3] = {1, edge, edge * edge};
  for (int z = halo; z < halo + TURBID_TILE_EDGE; ++z) {
    for (int y = halo; y < halo + TURBID_TILE_EDGE; ++y) {
      for (int x = halo; x < halo + TURBID_TILE_EDGE; ++x, out += 4) {
        const float* at = values.data() + x + edge * (y + edge * z);
        for (int axis = 0; axis < 3; ++axis) {
          const int d = strides[axis];
          out[axis] = 0.5f * (at[d] - at[-d]);
          if constexpr (halo == 2) out[axis] = (4.0f * out[axis] - 0.25f * (at[2 * d] - at[-2 * d])) / 3.0f;
        }
        out[3] = at[0];
      }
    }
  }
}

template void with_gradient<kDistanceHalo>(const std::vector<float>&, float*);
template void with_gradient<kIndexHalo>(const std::vector<float>&, float*);

StoredTiles store_tiles(cl::Session& session, const std::vector<float>& numbers, Storage storage) {
  constexpr int kLargestExponent = 14, kPiece = 1 << 16;
  StoredTiles stored;
  if (storage == Storage::single_precision) {
    stored.bytes = session.upload(std::as_bytes(std::span(numbers)));
    return stored;
  }
  float largest = 0;
  for (float x : numbers) largest = std::max(largest, std::abs(x));
  if (largest > 0) stored.exponent = std::clamp(kLargestExponent - std::ilogb(largest), -100, 100);
  const int pieces = static_cast<int>((numbers.size() + kPiece - 1) / kPiece);
  std::vector<std::uint16_t> halves(numbers.size());
  std::vector<double> lost(pieces), kept(pieces);  // per piece, so that the sums do not depend on the threads
  parallel_ranges(pieces, [&](int begin, int end) {
    for (int piece = begin; piece < end; ++piece) {
      const std::size_t last = std::min<std::size_t>(numbers.size(), (piece + std::size_t{1}) * kPiece);
      for (std::size_t i = static_cast<std::size_t>(piece) * kPiece; i < last; ++i) {
        const float scaled = std::ldexp(numbers[i], stored.exponent);
        halves[i] = glm::packHalf1x16(scaled);
        const double off = static_cast<double>(glm::unpackHalf1x16(halves[i])) - scaled;
        lost[piece] += off * off;
        kept[piece] += static_cast<double>(scaled) * scaled;
      }
    }
  });
  double all_lost = 0, all_kept = 0;
  for (int piece = 0; piece < pieces; ++piece) all_lost += lost[piece], all_kept += kept[piece];
  if (all_kept > 0) stored.rounding = std::sqrt(all_lost / all_kept);
  stored.bytes = session.upload(std::as_bytes(std::span(halves)));
  return stored;
}

}  // namespace turbid
