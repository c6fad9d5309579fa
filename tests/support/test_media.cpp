// SPDX-License-Identifier: Apache-2.0
// Builds small media, runs solvers and views on them, and traces probe rays.
#include "tests/support/test_media.h"

#include <algorithm>
#include <cmath>

#include "tests/support/paths.h"
#include "volumes/solid.h"

namespace turbid::test {

cl::Session& session() {
  static cl::Session shared(cl::choose_device(""));
  return shared;
}

Material make_material(const MaterialSpec& spec) {
  Material material;
  material.name = "test";
  material.eta = constant_field(glm::vec3(spec.eta));
  material.sigma_s = constant_field(spec.sigma_s);
  material.sigma_a = constant_field(spec.sigma_a);
  material.g = constant_field(glm::vec3(spec.g));
  material.emission = constant_field(spec.emission);
  return material;
}

MediumDescription empty_domain(glm::ivec3 voxels, float voxel_size, FaceBoundary faces, bool centred) {
  MediumDescription description;
  description.frame = {voxels, centred ? -0.5f * voxel_size * glm::vec3(voxels) : glm::vec3(0), voxel_size};
  description.faces = all_faces(faces);
  return description;
}

void set_ambient(MediumDescription& description, const Material& material) {
  description.materials.push_back(material);
  description.ambient_material = static_cast<int>(description.materials.size()) - 1;
}

void add_body(MediumDescription& description, Solid solid, const Material& material, SurfaceKind surface) {
  description.materials.push_back(material);
  description.bodies.push_back({.name = "body " + std::to_string(description.bodies.size() + 1),
                                .solid = std::move(solid),
                                .material = static_cast<int>(description.materials.size()) - 1,
                                .surface = surface});
}

Placement at(glm::vec3 translation) {
  Placement placement;
  placement.translation = translation;
  return placement;
}

namespace {

float value_at(const FluenceVolume& volume, const std::vector<float>& values, glm::ivec3 voxel, int colour) {
  const int block = volume.blocks.find(voxel / 8);
  if (block < 0) return 0;
  const glm::ivec3 local = voxel % 8;
  return values[colour * volume.colour_stride() + block * std::size_t{512} + local.x + 8 * (local.y + 8 * local.z)];
}

}  // namespace

float Run::fluence(glm::ivec3 voxel, int colour) const {
  return value_at(solution.volume, solution.volume.fluence, voxel, colour);
}
float Run::deposit(glm::ivec3 voxel, int colour) const {
  return value_at(solution.volume, solution.volume.deposit, voxel, colour);
}

Run run(const MediumDescription& description, const LightList& lights, const SolverSettings& settings,
        const Surroundings& surroundings) {
  MediumVolume medium = voxelise(description);
  const SceneFeatures features = scene_features(medium, lights);
  Progress progress(Verbosity::quiet);
  const SolverContext context{.session = session(),
                              .progress = progress,
                              .settings = settings,
                              .features = features,
                              .description = description,
                              .surroundings = surroundings};
  const auto solver = make_solver(context);
  solver->prepare(medium);
  LightSolution solution = solver->light(lights);
  return {description, std::move(medium), features, std::move(solution)};
}

ViewImage look_at(const Run& run, const LightList& lights, const Camera& camera, const ViewSettings& settings,
                  const Surroundings& surroundings) {
  Progress progress(Verbosity::quiet);
  return render_view(session(),
                     {.description = run.description,
                      .medium = run.medium,
                      .features = run.features,
                      .solution = run.solution,
                      .lights = lights,
                      .surroundings = surroundings,
                      .settings = settings},
                     camera, progress);
}

Light sunlight(glm::vec3 direction, glm::vec3 irradiance) {
  Light light;
  light.kind = LightKind::directional;
  light.name = "sun";
  light.direction = glm::normalize(direction);
  light.irradiance = irradiance;
  return light;
}

Light point_light(glm::vec3 position, glm::vec3 power) {
  Light light;
  light.kind = LightKind::point;
  light.name = "lamp";
  light.position = position;
  light.power = power;
  return light;
}

DeviceMedium graded_domain(glm::ivec3 voxels, const std::function<double(glm::dvec3)>& eta_squared) {
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
  device.regions_buffer = session().upload(device.region_params);
  device.tile_map_buffer = session().upload(device.tile_map);
  device.block_region_buffer = session().upload(device.block_region);
  device.index_tiles = session().upload(tiles);
  device.distance_tiles = session().upload(std::vector<float>(8));
  device.coefficient_tiles = session().upload(std::vector<float>(8));
  return device;
}

Marched march(const MediumDescription& scene, const LightList& lights, const MarchSettings& settings,
              bool reversed_rays) {
  const MediumVolume volume = voxelise(scene);
  const DeviceMedium medium = upload_medium(session(), volume, scene_features(volume, lights));
  LightRays rays = start_rays(lights, volume, entry_surfaces(scene, volume, false), medium, settings, 0);
  if (reversed_rays) std::reverse(rays.rays.begin(), rays.rays.end());
  March pass(session(), medium, settings, volume.faces(), {});
  pass.start(rays);
  while (pass.rays_left() > 0) {
    pass.enqueue_batch();
    pass.finish_batch();
  }
  Marched result{pass.read_tallies(), pass.read_deposit(), 1.0 / pass.watts_per_unit(), std::move(rays)};
  for (const RayState& ray : result.rays.rays) result.carried += glm::dvec3(ray.power[0], ray.power[1], ray.power[2]);
  return result;
}

std::vector<ProbeRay> trace(const DeviceMedium& medium, const std::vector<ProbeRay>& rays, float step, int steps) {
  using F = cl::Buffer<float>;
  using I = cl::Buffer<int>;
  const cl::Program program = session().build(test_kernel("probe_path.cl"), medium.defines());
  cl::Kernel<cl::Buffer<RegionParams>, I, I, F, F, F, F, float, int, int> kernel(program, "probe_path");
  std::vector<float> packed;
  for (const ProbeRay& ray : rays) {
    packed.insert(packed.end(), {ray.x.x, ray.x.y, ray.x.z, ray.v.x, ray.v.y, ray.v.z, static_cast<float>(ray.region),
                                 ray.length, static_cast<float>(ray.surfaces), -1.0f});
  }
  F buffer = session().upload(packed);
  kernel.enqueue(session().march_queue(), {rays.size()}, {1}, medium.regions_buffer, medium.tile_map_buffer,
                 medium.block_region_buffer, medium.distance_tiles, medium.index_tiles, medium.coefficient_tiles,
                 buffer, step, steps, static_cast<int>(rays.size()));
  const std::vector<float> out = session().read(session().march_queue(), buffer);
  std::vector<ProbeRay> result(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const float* at = out.data() + 10 * i;
    result[i] = {{at[0], at[1], at[2]},   {at[3], at[4], at[5]},  static_cast<int>(at[6]), at[7],
                 static_cast<int>(at[8]), static_cast<int>(at[9])};
  }
  return result;
}

double observed_order(double coarse_error, double fine_error, double refinement) {
  return std::log(coarse_error / fine_error) / std::log(refinement);
}

}  // namespace turbid::test
