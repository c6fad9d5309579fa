// SPDX-License-Identifier: Apache-2.0
// Rasterises a mesh along x in fixed point: every triangle tells the lines through voxel centres where they cross it.
#include "volumes/winding.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

__extension__ using Wide = __int128;
using Vec3i64 = std::array<std::int64_t, 3>;

constexpr int kFractionBits = 20;
constexpr double kUnit = 1 << kFractionBits;

Vec3i64 to_fixed(glm::dvec3 p) {
  constexpr double limit = 1ll << 45;  // far outside of any domain; products of two stay within 128 bits
  Vec3i64 fixed;
  for (int axis = 0; axis < 3; ++axis) fixed[axis] = std::llround(std::clamp(p[axis] * kUnit, -limit, limit));
  return fixed;
}

/// Twice the signed area of (a, b, p) in the plane (y, z).
Wide area(const Vec3i64& a, const Vec3i64& b, std::int64_t py, std::int64_t pz) {
  return Wide(b[1] - a[1]) * (pz - a[2]) - Wide(b[2] - a[2]) * (py - a[1]);
}

/// Its sign with p moved by (e, e^2), e infinitely small; 0 only if a and b coincide in the plane.
int side(const Vec3i64& a, const Vec3i64& b, Wide area_of_abp) {
  if (area_of_abp != 0) return area_of_abp > 0 ? 1 : -1;
  if (b[2] != a[2]) return b[2] < a[2] ? 1 : -1;
  if (b[1] != a[1]) return b[1] > a[1] ? 1 : -1;
  return 0;
}

/// First and last voxel centre within [low, high], both cut to [0, count).
std::pair<int, int> centres_between(std::int64_t low, std::int64_t high, int count) {
  const std::int64_t first = (low + (1 << kFractionBits) - 1) >> kFractionBits;
  const std::int64_t last = high >> kFractionBits;
  return {static_cast<int>(std::clamp<std::int64_t>(first, 0, count)),
          static_cast<int>(std::clamp<std::int64_t>(last, -1, count - 1))};
}

}  // namespace

Winding::Winding(std::span<const glm::dvec3> positions, std::span<const glm::uvec3> triangles, glm::ivec3 voxels)
    : voxels_(voxels) {
  std::vector<Vec3i64> fixed(positions.size());
  std::transform(positions.begin(), positions.end(), fixed.begin(), to_fixed);

  struct Found {
    std::uint32_t line;
    Crossing crossing;
  };
  std::vector<Found> found;
  for (const glm::uvec3& triangle : triangles) {
    const Vec3i64 &a = fixed[triangle.x], &b = fixed[triangle.y], &c = fixed[triangle.z];
    const auto [y_min, y_max] = std::minmax({a[1], b[1], c[1]});
    const auto [z_min, z_max] = std::minmax({a[2], b[2], c[2]});
    const auto [y_first, y_last] = centres_between(y_min, y_max, voxels.y);
    const auto [z_first, z_last] = centres_between(z_min, z_max, voxels.z);
    for (int z = z_first; z <= z_last; ++z)
      for (int y = y_first; y <= y_last; ++y) {
        const std::int64_t py = std::int64_t(y) << kFractionBits, pz = std::int64_t(z) << kFractionBits;
        const Wide ab = area(a, b, py, pz), bc = area(b, c, py, pz), ca = area(c, a, py, pz);
        const int sign = side(a, b, ab);
        if (sign == 0 || side(b, c, bc) != sign || side(c, a, ca) != sign) continue;
        const double x = (double(bc) * double(a[0]) + double(ca) * double(b[0]) + double(ab) * double(c[0])) /
                         (double(ab + bc + ca) * kUnit);
        const double first = std::floor(x) + 1;
        if (first >= voxels.x) continue;
        found.push_back(
            {static_cast<std::uint32_t>(z) * voxels.y + y, {static_cast<std::int32_t>(std::max(first, 0.0)), -sign}});
      }
  }

  begin_.assign(static_cast<std::size_t>(voxels.y) * voxels.z + 1, 0);
  for (const Found& f : found) ++begin_[f.line + 1];
  for (std::size_t line = 1; line < begin_.size(); ++line) begin_[line] += begin_[line - 1];
  crossings_.resize(found.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const Found& f : found) crossings_[next[f.line]++] = f.crossing;
}

std::array<bool, 8> Winding::inside_row(int x, int y, int z) const {
  std::array<int, 8> steps{};
  const std::size_t line = static_cast<std::size_t>(z) * voxels_.y + y;
  for (std::uint32_t i = begin_[line]; i < begin_[line + 1]; ++i) {
    const Crossing& crossing = crossings_[i];
    if (crossing.first < x + 8) steps[std::max(0, crossing.first - x)] += crossing.winding;
  }
  std::array<bool, 8> inside;
  int winding = 0;
  for (int i = 0; i < 8; ++i) {
    winding += steps[i];
    inside[i] = winding > 0;
  }
  return inside;
}

}  // namespace turbid
