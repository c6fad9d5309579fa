// SPDX-License-Identifier: Apache-2.0
// See small_media.h.
#include "host/study/small_media.h"

#include <algorithm>

namespace turbid::study {

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

Run run(cl::Session& session, const MediumDescription& description, const LightList& lights,
        const SolverSettings& settings, const Surroundings& surroundings) {
  MediumVolume medium = voxelise(description);
  const SceneFeatures features = scene_features(medium, lights);
  Progress progress(Verbosity::quiet);
  const SolverContext context{.session = session,
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

ViewImage look_at(cl::Session& session, const Run& run, const LightList& lights, const Camera& camera,
                  const ViewSettings& settings, const Surroundings& surroundings) {
  Progress progress(Verbosity::quiet);
  return render_view(session,
                     {.description = run.description,
                      .medium = run.medium,
                      .features = run.features,
                      .solution = run.solution,
                      .lights = lights,
                      .surroundings = surroundings,
                      .settings = settings},
                     camera, progress);
}

Marched march(cl::Session& session, const MediumDescription& scene, const LightList& lights,
              const MarchSettings& settings, bool reversed_rays) {
  const MediumVolume volume = voxelise(scene);
  const DeviceMedium medium = upload_medium(session, volume, scene_features(volume, lights));
  LightRays rays = start_rays(lights, volume, entry_surfaces(scene, volume, false), medium, settings, 0);
  if (reversed_rays) std::reverse(rays.rays.begin(), rays.rays.end());
  March pass(session, medium, settings, volume.faces(), {});
  pass.start(rays);
  while (pass.rays_left() > 0) {
    pass.enqueue_batch();
    pass.finish_batch();
  }
  Marched result{pass.read_tallies(), pass.read_deposit(), 1.0 / pass.watts_per_unit(), std::move(rays)};
  for (const RayState& ray : result.rays.rays) result.carried += glm::dvec3(ray.power[0], ray.power[1], ray.power[2]);
  return result;
}

}  // namespace turbid::study
