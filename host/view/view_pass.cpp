// SPDX-License-Identifier: Apache-2.0
// What all cameras share goes to the device once; then the samples of a camera in strips of rows, and the kernel's
// radiances averaged into pixels.
#include "host/view/view_pass.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/base/parallel.h"
#include "host/transport/device_medium.h"
#include "host/transport/light_rays.h"
#include "host/view/source_tiles.h"
#include "host/view/view_samples.h"
#include "kernels/shared/view_params.h"

namespace turbid {
namespace {

constexpr int kSamplesPerLaunch = 1 << 16;  // Ctrl-C is answered between launches
constexpr int kInterleave = 32, kSamplesPerClaim = 64;  // of a CPU's work-item; a GPU's takes one sample

int kind_of(const Light& light) {
  return light.kind == LightKind::directional ? TURBID_LIGHT_DIRECTIONAL
         : light.kind == LightKind::point     ? TURBID_LIGHT_POINT
                                              : TURBID_LIGHT_SPOT;
}

/// The medium's -D integers, the kinds of lights there are, and the loop shape that suits the device.
std::vector<cl::Define> view_defines(const ViewInput& in, bool cpu) {
  long lights = 0;
  for (const Light& light : in.lights) lights |= TURBID_LIGHT_BIT(kind_of(light));
  if (in.features.general) lights = TURBID_LIGHT_BIT(3) - 1;
  std::vector<cl::Define> defines = in.solution.device->defines();
  defines.push_back({"TURBID_LIGHTS", lights});
  defines.push_back({"TURBID_INTERLEAVE", cpu ? kInterleave : 1});
  defines.push_back({"TURBID_SAMPLES_PER_CLAIM", cpu ? kSamplesPerClaim : 1});
  return defines;
}

ViewParams make_params(const ViewInput& in, const VoxelSpace& space) {
  const float h = space.frame.voxel_size;
  ViewParams p{};
  p.step = in.settings.step_in_voxels;
  p.max_steps = in.settings.max_steps;
  p.max_branches = in.settings.max_branches;
  p.min_weight = in.settings.min_weight;
  p.light_count = static_cast<int>(in.lights.size());
  if (in.surroundings.ground) {
    const Ground& ground = *in.surroundings.ground;
    p.ground = 1;
    p.ground_height = (ground.height - space.frame.origin.y) / h;
    copy(ground.colour, p.ground_colour);
    copy(ground.colour2, p.ground_colour2);
    p.checker_size = ground.checker_size / h;
  }
  copy(in.surroundings.background, p.background);
  const GroundLight& through = in.solution.ground;
  p.ground_map_size = through.size;
  p.ground_map_texel = through.texel / h;
  p.ground_map_origin[0] = (through.origin.x - space.frame.origin.x) / h;
  p.ground_map_origin[1] = (through.origin.y - space.frame.origin.z) / h;
  copy(space.frame.origin / h, p.origin);
  copy(in.features.tint, p.tint);
  return p;
}

/// Index of the ambient where the camera stands; of one outside the domain, at the nearest point of its faces.
float eta_at_camera(const MediumVolume& medium, glm::vec3 camera) {
  if (!medium.region(0).graded_index) return medium.region(0).eta;
  const glm::vec3 last(medium.frame().voxels - 1);
  const glm::vec3 y = glm::clamp(camera - 0.5f, glm::vec3(0), last);
  const glm::ivec3 lower = glm::min(glm::ivec3(y), medium.frame().voxels - 2);
  const glm::vec3 f = y - glm::vec3(lower);
  std::array<float, 8> eta{};
  medium.read_eta(0, lower, glm::ivec3(2), eta);
  float result = 0;
  for (int k = 0; k < 8; ++k)
    result += (k & 1 ? f.x : 1 - f.x) * (k & 2 ? f.y : 1 - f.y) * (k & 4 ? f.z : 1 - f.z) * eta[k];
  return result;
}

std::vector<LightParams> make_lights(const ViewInput& in, const VoxelSpace& space, std::vector<float>* depths) {
  const float h = space.frame.voxel_size;
  const glm::mat4 voxel_to_world = glm::scale(glm::translate(glm::mat4(1), space.frame.origin), glm::vec3(h));
  std::vector<LightParams> lights;
  for (std::size_t i = 0; i < in.lights.size(); ++i) {
    const Light& light = in.lights[i];
    const ShadowMap& shadow = in.solution.shadows[i];
    LightParams p{};
    p.kind = kind_of(light);
    copy(space.point(light.position), p.position);
    copy(glm::normalize(light.direction), p.direction);
    const float half_angle = glm::radians(0.5f * light.cone_angle);
    p.cos_half_angle = std::cos(half_angle);
    if (light.kind == LightKind::directional) {
      copy(light.irradiance, p.intensity);
    } else {
      const float solid_angle = 2.0f * 3.14159265f * (light.kind == LightKind::spot ? 1.0f - p.cos_half_angle : 2.0f);
      copy(light.power / solid_angle / (h * h), p.intensity);
    }
    p.map_size = shadow.size;
    p.map_offset = static_cast<int>(depths->size());
    copy(space.point(shadow.origin), p.map_origin);
    const glm::mat4 voxel_to_clip = shadow.world_to_clip * voxel_to_world;
    for (int k = 0; k < 16; ++k) p.voxel_to_clip[k] = voxel_to_clip[k / 4][k % 4];
    for (float depth : shadow.depth) depths->push_back(depth / h);
    lights.push_back(p);
  }
  return lights;
}

/// Box filter over a pixel's samples. Returns the steps that were done.
std::int64_t resolve(const Strip& strip, const std::vector<float>& radiance, int first_row, ViewImage* image) {
  const float weight = 1.0f / static_cast<float>(strip.per_pixel);
  std::atomic<std::int64_t> all_steps{0};
  parallel_ranges(strip.rows, [&](int begin, int end) {
    std::int64_t steps = 0;
    for (int row = begin; row < end; ++row) {
      for (int x = 0; x < strip.width; ++x) {
        glm::vec3 direct(0), scattered(0), normal(0);
        float coverage = 0, depth = kFarAway;
        const std::size_t first = strip.index(x, row);
        for (std::size_t i = first; i < first + strip.per_pixel; ++i) {
          const float* at = radiance.data() + 8 * i;
          direct += weight * glm::vec3(at[0], at[1], at[2]);
          steps += static_cast<std::int64_t>(at[3]);
          scattered += weight * glm::vec3(at[4], at[5], at[6]);
          normal += strip.normal[i];
          coverage += weight * strip.coverage[i];
          depth = std::min(depth, strip.depth[i]);
        }
        const std::size_t pixel = static_cast<std::size_t>(first_row + row) * strip.width + x;
        image->colour[pixel] = glm::vec4(direct + scattered, coverage);
        image->direct[pixel] = direct;
        image->scattered[pixel] = scattered;
        image->depth[pixel] = depth;
        const float length = glm::length(normal);
        image->normal[pixel] = length > 1e-6f ? normal / length : glm::vec3(0);
      }
    }
    all_steps += steps;
  });
  return all_steps;
}

}  // namespace

/// What all cameras share.
struct ViewPass::Prepared {
  cl::Session& session;
  ViewInput in;
  VoxelSpace space;
  EntrySurfaces surfaces;
  cl::Program program;
  cl::Kernel<cl::Buffer<RegionParams>, cl::Buffer<int>, cl::Buffer<int>, cl::Buffer<float>, cl::Buffer<std::byte>,
             cl::Buffer<std::byte>, cl::Buffer<int>, ViewParams, cl::Buffer<ViewSample>, cl::Buffer<int>, cl::Buffer<float>,
             cl::Buffer<LightParams>, cl::Buffer<float>, cl::Buffer<float>, cl::Buffer<float>, cl::Buffer<float>>
      kernel;
  ViewParams params;
  cl::Buffer<LightParams> lights;
  cl::Buffer<float> depths, ground, transmittance, tiles;

  Prepared(cl::Session& on, const ViewInput& input)
      : session(on),
        in(input),
        space{in.medium.frame()},
        surfaces(entry_surfaces(in.description, in.medium, true)),
        program(session.build("view.cl", view_defines(in, session.device().cpu))),
        kernel(program, "view"),
        params(make_params(in, space)) {
    std::vector<float> depth_values, ground_values, transmittance_values;
    lights = session.upload(make_lights(in, space, &depth_values));
    const auto append = [](std::vector<float>& to, glm::vec3 texel) {
      to.insert(to.end(), {texel.r, texel.g, texel.b});
    };
    for (const glm::vec3& texel : in.solution.ground.irradiance) append(ground_values, texel);
    for (const ShadowMap& shadow : in.solution.shadows) {
      for (const glm::vec3& share : shadow.transmittance) append(transmittance_values, share);
    }
    params.transmittance = !transmittance_values.empty();
    depths = session.upload(depth_values);
    ground = session.upload(ground_values);
    transmittance = session.upload(transmittance_values);
    tiles =
        session.upload(in.features.scattering ? make_source_tiles(in.solution.volume, in.medium, *in.solution.device)
                                              : std::vector<float>{});
  }
};

ViewPass::ViewPass(cl::Session& session, const ViewInput& in) : prepared_(std::make_unique<Prepared>(session, in)) {}
ViewPass::~ViewPass() = default;
ViewPass::ViewPass(ViewPass&&) noexcept = default;

ViewImage ViewPass::look(const Camera& camera, const std::function<void(double)>& progress) {
  Prepared& p = *prepared_;
  const DeviceMedium& medium = *p.in.solution.device;
  const SampleMaker maker(p.in, camera, p.surfaces, p.space);
  ViewImage image;
  image.width = camera.width;
  image.height = camera.height;
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  image.colour.resize(pixels);
  image.direct.resize(pixels);
  image.scattered.resize(pixels);
  image.depth.resize(pixels);
  image.normal.resize(pixels);
  const int per_row = image.width * maker.grid() * maker.grid();
  // Whole squares of samples, if a launch has room for any.
  int rows = std::clamp(kSamplesPerLaunch / per_row, 1, image.height);
  if (rows > Strip::kSquare) rows -= rows % Strip::kSquare;
  cl::Buffer<ViewSample> samples = p.session.allocate<ViewSample>(static_cast<std::size_t>(rows) * per_row);
  cl::Buffer<float> radiance = p.session.allocate<float>(8 * static_cast<std::size_t>(rows) * per_row);
  cl::Buffer<int> claims = p.session.allocate<int>(1);
  const bool cpu = p.session.device().cpu;
  cl::Queue& queue = p.session.march_queue();
  ViewParams params = p.params;
  params.eta_observer = eta_at_camera(p.in.medium, p.space.point(camera.position));
  for (int row = 0; row < image.height; row += rows) {
    const int end = std::min(row + rows, image.height);
    const Strip strip = maker.strip(row, end);
    p.session.write(queue, samples, std::span<const ViewSample>(strip.samples));
    params.sample_count = static_cast<int>(strip.samples.size());
    p.session.fill_zero(queue, claims);
    // A CPU's work-items take samples until none is left, one work-item per core; a GPU's take one each.
    const std::size_t items = cpu ? p.session.device().compute_units : strip.samples.size();
    p.kernel.enqueue(queue, {items}, {cpu ? std::size_t{1} : std::size_t{64}}, medium.regions_buffer, medium.tile_map_buffer,
                     medium.block_region_buffer, medium.distance_tiles, medium.index_tiles.bytes,
                     medium.coefficient_tiles.bytes,
                     medium.region_tiles, params, samples, claims, p.tiles, p.lights, p.depths, p.transmittance, p.ground, radiance);
    std::vector<float> values(8 * strip.samples.size());
    p.session.read(queue, radiance, std::span<float>(values));
    image.steps += resolve(strip, values, row, &image);
    if (progress) progress(static_cast<double>(end) / image.height);
  }
  return image;
}

ViewImage render_view(cl::Session& session, const ViewInput& in, const Camera& camera, Progress& progress) {
  progress.stage("view");
  ViewImage image = ViewPass(session, in).look(camera, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  return image;
}

}  // namespace turbid
