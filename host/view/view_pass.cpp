// SPDX-License-Identifier: Apache-2.0
// Camera samples from the rasterised first hits, in strips of rows; the kernel's radiances averaged into pixels.
#include "host/view/view_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "host/raster/raster.h"
#include "host/transport/device_medium.h"
#include "host/transport/light_rays.h"
#include "host/view/source_tiles.h"
#include "kernels/shared/view_params.h"

namespace turbid {
namespace {

constexpr int kSamplesPerLaunch = 1 << 16;  // Ctrl-C is answered between launches
constexpr int kInterleave = 8, kSamplesPerClaim = 64;  // of a CPU's work-item
constexpr float kFarAway = 1e10f;

void copy(glm::vec3 from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

/// The frame's voxel coordinates of scene points.
struct VoxelSpace {
  GridFrame frame;
  glm::vec3 point(glm::vec3 x) const { return (x - frame.origin) / frame.voxel_size; }
};

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

std::vector<LightParams> make_lights(const ViewInput& in, const VoxelSpace& space, std::vector<float>* depths) {
  const float h = space.frame.voxel_size;
  const glm::mat4 voxel_to_world =
      glm::scale(glm::translate(glm::mat4(1), space.frame.origin), glm::vec3(h));
  std::vector<LightParams> lights;
  for (std::size_t i = 0; i < in.lights.size(); ++i) {
    const Light& light = in.lights[i];
    const ShadowMap& shadow = in.solution.shadows[i];
    LightParams p{};
    p.kind = light.kind == LightKind::directional ? TURBID_LIGHT_DIRECTIONAL
             : light.kind == LightKind::point     ? TURBID_LIGHT_POINT
                                                  : TURBID_LIGHT_SPOT;
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

/// The samples of a strip of rows, and what the host knows of their first hits.
struct Strip {
  std::vector<ViewSample> samples;
  std::vector<float> depth;        // per sample
  std::vector<glm::vec3> normal;
  std::vector<float> coverage;
};

class SampleMaker {
 public:
  SampleMaker(const ViewInput& in, const EntrySurfaces& surfaces, const VoxelSpace& space)
      : in_(in), space_(space), grid_(static_cast<int>(std::lround(std::sqrt(in.camera.samples)))) {
    const Camera& camera = in.camera;
    view_ = camera_view(camera.position, camera.target, camera.up, camera.fov, camera.width * grid_,
                        camera.height * grid_, surfaces.bounds);
    if (!surfaces.meshes.empty()) image_ = rasterise(surfaces.meshes, view_);
    clip_to_world_ = glm::inverse(glm::dmat4(view_.projection) * glm::dmat4(view_.view));
    ambient_ = surfaces.ambient;
    const glm::vec3 x = space.point(camera.position);
    std::vector<int> owner(1);
    in.medium.read_owner(glm::ivec3(glm::floor(x)), glm::ivec3(1), owner);
    camera_region_ = owner[0];
  }
  int grid() const { return grid_; }

  /// Samples of pixel rows [first, last).
  Strip strip(int first, int last) const {
    const int width = in_.camera.width * grid_;
    Strip result;
    for (int y = first * grid_; y < last * grid_; ++y) {
      for (int x = 0; x < width; ++x) add(x, y, &result);
    }
    return result;
  }

 private:
  glm::vec3 direction_of(int x, int y) const {
    const glm::dvec4 ndc(2.0 * (x + 0.5) / view_.width - 1.0, 1.0 - 2.0 * (y + 0.5) / view_.height, 0.5, 1.0);
    const glm::dvec4 far_point = clip_to_world_ * ndc;
    return glm::normalize(glm::dvec3(far_point) / far_point.w - glm::dvec3(in_.camera.position));
  }

  void add(int x, int y, Strip* out) const {
    const std::size_t i = static_cast<std::size_t>(y) * view_.width + x;
    const glm::vec3 direction = direction_of(x, y), eye = in_.camera.position;
    ViewSample sample{};
    sample.region = -1;
    copy(direction, sample.direction);
    copy(space_.point(eye), sample.position);
    float depth = kFarAway, coverage = 0;
    glm::vec3 normal(0);
    const float to_ground = ground_distance(eye, direction);
    if (to_ground < kFarAway) {
      depth = to_ground;
      normal = glm::vec3(0, direction.y < 0 ? 1 : -1, 0);
      coverage = 1;
    }
    const bool inside = camera_region_ > 0 || (camera_region_ == 0 && ambient_);
    if (inside) {
      // The camera stands in a medium: start there.
      sample.region = camera_region_;
      depth = 0;
      coverage = 1;
    } else if (!image_.id.empty() && image_.id[i] >= 0 && image_.front[i]) {
      const float to_hit = glm::length(image_.position[i] - eye);
      if (to_hit < to_ground) {
        depth = to_hit;
        normal = image_.normal[i];
        coverage = 1;
        start_at(image_.position[i], direction, image_.id[i], normal, &sample);
      }
    }
    out->samples.push_back(sample);
    out->depth.push_back(depth);
    out->normal.push_back(normal);
    out->coverage.push_back(coverage);
  }

  void start_at(glm::vec3 hit, glm::vec3 direction, int region, glm::vec3 normal, ViewSample* sample) const {
    const glm::vec3 domain(space_.frame.voxels);
    glm::vec3 x = space_.point(hit);
    const glm::vec3 slack(0.02f);
    if (glm::any(glm::lessThan(x, -slack)) || glm::any(glm::greaterThan(x, domain + slack))) return;  // cut off by the domain
    sample->entering = region > 0;
    if (region > 0 && in_.medium.region(region).smooth_surface) {
      // Before the blurred index begins.
      x -= (4.0f * in_.medium.smoothing_voxels() + 2.0f) * direction;
      region = 0;
      sample->entering = 0;
    }
    sample->region = region;
    copy(glm::clamp(x, glm::vec3(0), domain), sample->position);
    // Shading normals may face away from the eye at silhouettes.
    if (glm::dot(normal, direction) > -1e-3f) normal = glm::normalize(normal - (glm::dot(normal, direction) + 1e-3f) * direction);
    copy(normal, sample->normal);
  }

  float ground_distance(glm::vec3 eye, glm::vec3 direction) const {
    if (!in_.surroundings.ground || std::abs(direction.y) < 1e-7f) return kFarAway;
    const float t = (in_.surroundings.ground->height - eye.y) / direction.y;
    return t > 0 ? std::min(t, kFarAway) : kFarAway;
  }

  const ViewInput& in_;
  VoxelSpace space_;
  int grid_;
  RasterView view_;
  RasterImage image_;
  glm::dmat4 clip_to_world_{1};
  bool ambient_ = false;
  int camera_region_ = -1;
};

/// Box filter over a pixel's samples.
void resolve(const Strip& strip, const std::vector<float>& radiance, int first_row, int last_row, int grid, ViewImage* image) {
  const int width = image->width;
  const float weight = 1.0f / static_cast<float>(grid * grid);
  for (int y = first_row; y < last_row; ++y) {
    for (int x = 0; x < width; ++x) {
      glm::vec3 direct(0), scattered(0), normal(0);
      float coverage = 0, depth = kFarAway;
      for (int k = 0; k < grid * grid; ++k) {
        const std::size_t i = static_cast<std::size_t>((y - first_row) * grid + k / grid) * (width * grid) + x * grid + k % grid;
        direct += weight * glm::vec3(radiance[8 * i], radiance[8 * i + 1], radiance[8 * i + 2]);
        scattered += weight * glm::vec3(radiance[8 * i + 4], radiance[8 * i + 5], radiance[8 * i + 6]);
        normal += strip.normal[i];
        coverage += weight * strip.coverage[i];
        depth = std::min(depth, strip.depth[i]);
      }
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      image->colour[pixel] = glm::vec4(direct + scattered, coverage);
      image->direct[pixel] = direct;
      image->scattered[pixel] = scattered;
      image->depth[pixel] = depth;
      const float length = glm::length(normal);
      image->normal[pixel] = length > 1e-6f ? normal / length : glm::vec3(0);
    }
  }
}

}  // namespace

ViewImage render_view(cl::Session& session, const ViewInput& in, Progress& progress) {
  progress.stage("view");
  const VoxelSpace space{in.medium.frame()};
  const EntrySurfaces surfaces = entry_surfaces(in.description, in.medium, true);
  const DeviceMedium& medium = *in.solution.device;
  const bool cpu = session.device().cpu;
  std::vector<cl::Define> defines = medium.defines();
  defines.push_back({"TURBID_INTERLEAVE", cpu ? kInterleave : 1});
  defines.push_back({"TURBID_SAMPLES_PER_CLAIM", cpu ? kSamplesPerClaim : 1});
  const cl::Program program = session.build("view.cl", defines);
  cl::Kernel<cl::Buffer<RegionParams>, cl::Buffer<int>, cl::Buffer<int>, cl::Buffer<float>, cl::Buffer<float>,
             cl::Buffer<float>, ViewParams, cl::Buffer<ViewSample>, cl::Buffer<int>, cl::Buffer<float>,
             cl::Buffer<LightParams>,
             cl::Buffer<float>, cl::Buffer<float>, cl::Buffer<float>, cl::Buffer<float>>
      kernel(program, "view");

  ViewParams params = make_params(in, space);
  std::vector<float> depths, ground;
  const std::vector<LightParams> lights = make_lights(in, space, &depths);
  for (const glm::vec3& texel : in.solution.ground.irradiance) ground.insert(ground.end(), {texel.r, texel.g, texel.b});
  std::vector<float> transmittance;
  for (const ShadowMap& shadow : in.solution.shadows) {
    for (const glm::vec3& share : shadow.transmittance) transmittance.insert(transmittance.end(), {share.r, share.g, share.b});
  }
  params.transmittance = !transmittance.empty();
  const cl::Buffer<LightParams> light_buffer = session.upload(lights);
  const cl::Buffer<float> depth_buffer = session.upload(depths), ground_buffer = session.upload(ground);
  const cl::Buffer<float> transmittance_buffer = session.upload(transmittance);
  const cl::Buffer<float> tiles = session.upload(
      in.features.scattering ? make_source_tiles(in.solution.volume, in.medium, medium) : std::vector<float>{});

  const SampleMaker maker(in, surfaces, space);
  ViewImage image;
  image.width = in.camera.width;
  image.height = in.camera.height;
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  image.colour.resize(pixels);
  image.direct.resize(pixels);
  image.scattered.resize(pixels);
  image.depth.resize(pixels);
  image.normal.resize(pixels);
  const int per_row = image.width * maker.grid() * maker.grid();
  const int rows = std::clamp(kSamplesPerLaunch / per_row, 1, image.height);
  cl::Buffer<ViewSample> samples = session.allocate<ViewSample>(static_cast<std::size_t>(rows) * per_row);
  cl::Buffer<float> radiance = session.allocate<float>(8 * static_cast<std::size_t>(rows) * per_row);
  cl::Buffer<int> claims = session.allocate<int>(1);
  cl::Queue& queue = session.march_queue();
  for (int row = 0; row < image.height; row += rows) {
    const int end = std::min(row + rows, image.height);
    const Strip strip = maker.strip(row, end);
    session.write(queue, samples, std::span<const ViewSample>(strip.samples));
    params.sample_count = static_cast<int>(strip.samples.size());
    session.fill_zero(queue, claims);
    // A CPU's work-items take samples until none is left, one work-item per core; a GPU's take one each.
    const std::size_t items = cpu ? session.device().compute_units : strip.samples.size();
    kernel.enqueue(queue, {items}, {cpu ? std::size_t{1} : std::size_t{64}}, medium.regions_buffer, medium.tile_map_buffer,
                   medium.block_region_buffer, medium.distance_tiles, medium.index_tiles, medium.coefficient_tiles,
                   params, samples, claims, tiles, light_buffer, depth_buffer, transmittance_buffer, ground_buffer, radiance);
    std::vector<float> values(8 * strip.samples.size());
    session.read(queue, radiance, std::span<float>(values));
    resolve(strip, values, row, end, maker.grid(), &image);
    for (std::size_t i = 0; i < strip.samples.size(); ++i) image.steps += static_cast<std::int64_t>(values[8 * i + 3]);
    progress.update(static_cast<double>(end) / image.height);
  }
  progress.finish();
  return image;
}

}  // namespace turbid
