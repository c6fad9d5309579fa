// SPDX-License-Identifier: Apache-2.0
// Uploads index tiles and rays, runs kernels/path.cl.
#include "host/study/ray_paths.h"

#include <algorithm>
#include <cmath>

namespace turbid::study {

DeviceMedium graded_domain(cl::Session& session, glm::ivec3 voxels,
                           const std::function<double(glm::dvec3)>& eta_squared) {
  DeviceMedium device;
  device.frame = {voxels, glm::vec3(0), 1.0f};
  device.features.channels = 1;
  device.features.graded_index = true;
  const int blocks = device.block_count();
  auto u = [&](glm::ivec3 node) { return 0.5 * eta_squared(glm::dvec3(node) + 0.5); };
  double largest = 0;
  std::vector<float> tiles;
  tiles.reserve(static_cast<std::size_t>(blocks) * TURBID_TILE_NODES * 4);
  for (int block = 0; block < blocks; ++block) {
    const glm::ivec3 n = device.frame.blocks();
    const glm::ivec3 lower = 8 * glm::ivec3(block % n.x, (block / n.x) % n.y, block / (n.x * n.y));
    for (int i = 0; i < TURBID_TILE_NODES; ++i) {
      const glm::ivec3 node = lower + glm::ivec3(i % 9, (i / 9) % 9, i / 81);
      for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        tiles.push_back(static_cast<float>(0.5 * (u(node + step) - u(node - step))));
      }
      tiles.push_back(static_cast<float>(u(node)));
      largest = std::max(largest, std::sqrt(2 * u(node)));
    }
    device.tile_map.push_back(block);
  }
  RegionParams region{};
  region.eta = 1.0f;
  region.index_set = 0;
  region.distance_set = region.coefficient_set = region.source_set = -1;
  region.tau_per_arc = static_cast<float>(1.0 / largest);
  device.region_params = {region};
  device.block_region.assign(blocks, 0);
  device.regions_buffer = session.upload(device.region_params);
  device.tile_map_buffer = session.upload(device.tile_map);
  device.block_region_buffer = session.upload(device.block_region);
  device.index_tiles = store_tiles(session, tiles, device.storage);
  device.distance_tiles = session.upload(std::vector<float>(8));
  device.coefficient_tiles = store_tiles(session, std::vector<float>(8), device.storage);
  return device;
}

std::vector<PathRay> trace(cl::Session& session, const DeviceMedium& medium, const std::vector<PathRay>& rays,
                           float step, int steps) {
  using F = cl::Buffer<float>;
  using I = cl::Buffer<int>;
  const cl::Program program = session.build("path.cl", medium.defines());
  using Bytes = cl::Buffer<std::byte>;
  cl::Kernel<cl::Buffer<RegionParams>, I, I, F, Bytes, Bytes, F, float, int, int> kernel(program, "follow_path");
  std::vector<float> packed;
  for (const PathRay& ray : rays) {
    packed.insert(packed.end(), {ray.x.x, ray.x.y, ray.x.z, ray.v.x, ray.v.y, ray.v.z, static_cast<float>(ray.region),
                                 ray.length, static_cast<float>(ray.surfaces), -1.0f});
  }
  F buffer = session.upload(packed);
  kernel.enqueue(session.march_queue(), {rays.size()}, {1}, medium.regions_buffer, medium.tile_map_buffer,
                 medium.block_region_buffer, medium.distance_tiles, medium.index_tiles.bytes, medium.coefficient_tiles.bytes,
                 buffer, step, steps, static_cast<int>(rays.size()));
  const std::vector<float> out = session.read(session.march_queue(), buffer);
  std::vector<PathRay> result(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float* at = out.data() + 10 * i;
    result[i] = {{at[0], at[1], at[2]},   {at[3], at[4], at[5]},  static_cast<int>(at[6]), at[7],
                 static_cast<int>(at[8]), static_cast<int>(at[9])};
  }
  return result;
}

}  // namespace turbid::study
