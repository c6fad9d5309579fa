// SPDX-License-Identifier: Apache-2.0
// See ray_order.h.
#include "host/transport/ray_order.h"

#include <numeric>

namespace turbid {

float radical_inverse(std::uint64_t n, unsigned base) {
  double result = 0, digit = 1.0 / base;
  for (; n > 0; n /= base, digit /= base) result += digit * static_cast<double>(n % base);
  return static_cast<float>(result);
}

std::vector<RayState> sorted_by_block(const std::vector<RayState>& rays, const GridFrame& frame) {
  const glm::ivec3 blocks = frame.blocks();
  const auto block_of = [&](const RayState& ray) {
    const glm::ivec3 voxel(ray.position[0], ray.position[1], ray.position[2]);
    const glm::ivec3 block = glm::clamp(voxel / 8, glm::ivec3(0), blocks - 1);
    return block.x + blocks.x * (block.y + blocks.y * block.z);
  };
  std::vector<std::size_t> next(static_cast<std::size_t>(blocks.x) * blocks.y * blocks.z + 1);
  for (const RayState& ray : rays) ++next[block_of(ray) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<RayState> sorted(rays.size());
  for (const RayState& ray : rays) sorted[next[block_of(ray)]++] = ray;
  return sorted;
}

}  // namespace turbid
