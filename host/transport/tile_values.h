// SPDX-License-Identifier: Apache-2.0
// What stands in the tiles of the medium: values with their gradients, kept in single or half precision.
#pragma once
#include <cstddef>
#include <vector>

#include "host/cl/session.h"
#include "host/scene/settings.h"
#include "kernels/shared/medium_params.h"

namespace turbid {

/// Edge of a tile with `halo` more nodes on each side.
constexpr int halo_edge(int halo) { return TURBID_TILE_EDGE + 2 * halo; }
constexpr int halo_nodes(int halo) { return halo_edge(halo) * halo_edge(halo) * halo_edge(halo); }
constexpr int kDistanceHalo = 1, kIndexHalo = 2;

/// (gradient, value) per node of a tile from values with a halo, by central differences of second order (halo 1) or
/// fourth (halo 2). Second order adds h^2/6 (u_xxx, u_yyy, u_zzz) to the gradient, which is no gradient of anything: rays
/// of different directions then have different speeds at one place, and power is not kept along them.
template <int halo>
void with_gradient(const std::vector<float>& values, float* out);

/// Numbers of tiles on the device.
struct StoredTiles {
  cl::Buffer<std::byte> bytes;
  int exponent = 0;       ///< half precision: numbers are kept 2^exponent times as large
  double rounding = 0;    ///< rel-L2 of what storing took; 0 in single precision
};

/// Half precision: to nearest, scaled by a power of two so that the largest is about 2^14; then numbers down to 2^-28 of it
/// keep 11 bits.
StoredTiles store_tiles(cl::Session&, const std::vector<float>& numbers, Storage);

}  // namespace turbid
