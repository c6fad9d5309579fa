// SPDX-License-Identifier: Apache-2.0
// Lights in; rays at the medium's surface and shadow maps out. One ray per texel of a map that OSMesa rasterises from the
// light: a regular grid, fine enough for the wanted rays per voxel face. Where the domain's own faces bound the light (they
// mirror or repeat, or its ambient medium is lit) texels are clipped there: power is irradiance times area times cosine.
#include "host/transport/light_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "host/transport/parallel_texels.h"
#include "host/transport/ray_order.h"

namespace turbid {
namespace {

constexpr float kPi = glm::pi<float>();
constexpr int kLargestMap = 4096;

class RayStarter {
 public:
  RayStarter(const MediumVolume& medium, const EntrySurfaces& surfaces, const DeviceMedium& device,
             const MarchSettings& march, std::uint64_t seed)
      : medium_(medium), surfaces_(surfaces), device_(device), march_(march), frame_(medium.frame()), seed_(seed) {
    centre_ = surfaces.bounds.centre();
    radius_ = 0.5f * glm::length(surfaces.bounds.size()) * 1.001f + 1e-3f * frame_.voxel_size;
    texel_ = frame_.voxel_size / std::sqrt(march.rays_per_face);
  }

  void add(const Light& light) {
    shadow_ = {};
    const bool nothing = surfaces_.meshes.empty();
    if (light.kind == LightKind::directional) {
      directional(light);
    } else if (const int region = region_of(light.position); region > 0 || (region == 0 && surfaces_.ambient) || nothing) {
      if (region >= 0) from_inside(light, region);
    } else {
      from_outside(light);
    }
    texels_before_ += shadow_.depth.size();
    result_.texel_power.resize(texels_before_, glm::dvec3(0));
    result_.shadows.push_back(std::move(shadow_));
  }

  LightRays take() {
    result_.missed = result_.emitted - carried_ - result_.absorbed_opaque;
    result_.rays = sorted_by_block(result_.rays, frame_);
    return std::move(result_);
  }

 private:
  /// -1: outside the domain.
  int region_of(glm::vec3 position) const {
    const glm::ivec3 voxel(glm::floor((position - frame_.origin) / frame_.voxel_size));
    std::array<int, 1> owner{};
    medium_.read_owner(voxel, glm::ivec3(1), owner);
    return owner[0];
  }

  float ambient_eta(glm::vec3 position) const {
    if (!medium_.region(0).graded_index) return medium_.region(0).eta;
    std::array<float, 1> eta{};
    medium_.read_eta(0, glm::ivec3(glm::floor((position - frame_.origin) / frame_.voxel_size)), glm::ivec3(1), eta);
    return eta[0];
  }

  glm::vec3 channels(glm::vec3 rgb) const { return device_.features.to_channels(rgb); }

  /// `velocity`: direction times the index at the start.
  void push(glm::vec3 position, glm::vec3 velocity, glm::vec3 normal, int region, bool entering, glm::dvec3 power,
            std::ptrdiff_t texel = -1) {
    RayState ray{};
    const glm::vec3 x = glm::clamp((position - frame_.origin) / frame_.voxel_size, glm::vec3(0), glm::vec3(frame_.voxels));
    for (int i = 0; i < 3; ++i) {
      ray.position[i] = x[i];
      ray.velocity[i] = velocity[i];
      ray.normal[i] = normal[i];
      ray.power[i] = static_cast<float>(power[i]);
    }
    ray.region = region;
    ray.entering = entering;
    ray.grace = entering ? 1.5f : 0.0f;  // see kernels/lib/trace.h: the sampled surface is coarser than the rasterised one
    ray.texel = static_cast<int>(texel);
    ray.floor_power = march_.min_power * std::max({ray.power[0], ray.power[1], ray.power[2]});
    if (ray.floor_power == 0.0f && std::max({ray.power[0], ray.power[1], ray.power[2]}) == 0.0f) return;
    carried_ += glm::dvec3(ray.power[0], ray.power[1], ray.power[2]);
    result_.rays.push_back(ray);
  }

  /// A ray that meets the rasterised surface at pixel `i`.
  void launch(const RasterImage& image, std::size_t i, glm::vec3 direction, glm::dvec3 power, bool has_map = true) {
    if (image.id[i] < 0 || !image.front[i]) return;
    start_at(image.position[i], image.normal[i], image.id[i], direction, power, has_map ? static_cast<std::ptrdiff_t>(i) : -1);
  }

  /// A ray that meets a region's surface; `texel` of this light's map, or -1.
  void start_at(glm::vec3 hit, glm::vec3 normal, int region, glm::vec3 direction, glm::dvec3 power, std::ptrdiff_t texel) {
    const glm::vec3 slack(0.01f * frame_.voxel_size);
    if (glm::any(glm::lessThan(hit, frame_.origin - slack)) || glm::any(glm::greaterThan(hit, frame_.upper() + slack))) return;
    if (medium_.region(region).opaque) {
      result_.absorbed_opaque += power;
      return;
    }
    if (medium_.region(region).smooth_surface && region > 0) {
      // The index starts to change before the surface: start at least four standard deviations of its blur ahead.
      const float back = (4.0f * medium_.smoothing_voxels() + 2.0f) * frame_.voxel_size;
      const glm::vec3 start = inside_domain(hit, direction, back);
      push(start, ambient_eta(start) * direction, -direction, 0, false, power);
      return;
    }
    if (texel >= 0) {
      texel += static_cast<std::ptrdiff_t>(texels_before_);
      result_.texel_power.resize(std::max(result_.texel_power.size(), static_cast<std::size_t>(texel) + 1), glm::dvec3(0));
      result_.texel_power[texel] += power;
    }
    push(hit, ambient_eta(hit) * direction, normal, region, region > 0, power, texel);
  }

  /// hit - back * direction, or where the ray enters the domain if that lies outside.
  glm::vec3 inside_domain(glm::vec3 hit, glm::vec3 direction, float back) const {
    float t = back;
    for (int axis = 0; axis < 3; ++axis) {
      const float limit = direction[axis] > 0 ? hit[axis] - frame_.origin[axis] : frame_.upper()[axis] - hit[axis];
      if (std::abs(direction[axis]) > 1e-6f) t = std::min(t, std::max(limit, 0.0f) / std::abs(direction[axis]));
    }
    return hit - t * direction;
  }

  RasterView shifted(RasterView view) const {
    if (seed_ == 0) return view;
    const glm::vec3 offset((2 * radical_inverse(seed_, 2) - 1) / static_cast<float>(view.width),
                           (2 * radical_inverse(seed_, 3) - 1) / static_cast<float>(view.height), 0);
    view.projection = glm::translate(glm::mat4(1), offset) * view.projection;
    return view;
  }

  static glm::vec2 ndc_of(int x, int y, const RasterView& view) {
    return {2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(view.width) - 1.0f,
            1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(view.height)};
  }

  void keep_shadow(const RasterImage& image, const RasterView& view, glm::vec3 origin, glm::vec3 direction, bool parallel) {
    shadow_.world_to_clip = view.projection * view.view;
    shadow_.size = image.width;
    shadow_.origin = origin;
    shadow_.depth.assign(image.id.size(), 1e30f);
    for (std::size_t i = 0; i < image.id.size(); ++i) {
      if (image.id[i] < 0) continue;
      const glm::vec3 to_hit = image.position[i] - origin;
      shadow_.depth[i] = parallel ? glm::dot(to_hit, direction) : glm::length(to_hit);
    }
  }

  int map_size(float extent) const {
    return std::clamp(static_cast<int>(std::ceil(extent / texel_)), 16, kLargestMap);
  }

  void directional(const Light& light) {
    const glm::vec3 direction = glm::normalize(light.direction);
    const bool bounded = surfaces_.ambient || !all_open();
    const float radius = radius_ + (bounded ? texel_ : 0.0f);  // texels whose centres lie just outside count as well
    const int size = map_size(2.0f * radius);
    const RasterView view = shifted(parallel_view(direction, centre_, radius, size));
    const RasterImage image = rasterise(surfaces_.meshes, view);
    const double area = std::pow(2.0 * radius / size, 2);
    const glm::dvec3 irradiance = channels(light.irradiance);
    if (!bounded) {
      result_.emitted += irradiance * glm::pi<double>() * static_cast<double>(radius) * static_cast<double>(radius);
      for (std::size_t i = 0; i < image.id.size(); ++i) launch(image, i, direction, irradiance * area);
    } else {
      double shares = 0;
      if (surfaces_.ambient) {
        for (const FacePart& part : parts_on_faces(view, direction, frame_, medium_.faces())) {
          start_at(part.centre, -direction, 0, direction, part.share * area * irradiance, part.texel);
          shares += part.share;
        }
      } else {
        for (const BodyPart& part : parts_on_bodies(image, view, direction, frame_, medium_.faces())) {
          start_at(part.centre, image.normal[part.surface], image.id[part.surface], direction, part.share * area * irradiance,
                   static_cast<std::ptrdiff_t>(part.texel));
          shares += part.share;
        }
      }
      // Bodies may catch more than comes in through the open faces: what the domain's copies would shade is not known.
      result_.emitted += irradiance * std::max(lit_area(direction, frame_, medium_.faces()), shares * area);
    }
    keep_shadow(image, view, centre_ - radius * direction, direction, true);
  }

  bool all_open() const {
    return std::ranges::all_of(medium_.faces(), [](FaceBoundary face) { return face == FaceBoundary::open; });
  }

  /// Solid angle that a point or spot light fills [sr].
  static double solid_angle(const Light& light) {
    if (light.kind == LightKind::point) return 4.0 * glm::pi<double>();
    return 2.0 * glm::pi<double>() * (1.0 - std::cos(glm::radians(0.5 * light.cone_angle)));
  }

  bool in_cone(const Light& light, glm::vec3 direction) const {
    return light.kind == LightKind::point ||
           glm::dot(direction, glm::normalize(light.direction)) >= std::cos(glm::radians(0.5f * light.cone_angle));
  }

  /// Rasterises a square perspective map; each texel carries intensity times its solid angle, texel^2 cos^3(theta) in the
  /// image plane at unit distance.
  void perspective(const Light& light, glm::vec3 axis, float full_angle, int size, bool keep) {
    const RasterView view = shifted(cone_view(light.position, axis, full_angle, size, surfaces_.bounds));
    const RasterImage image = rasterise(surfaces_.meshes, view);
    const glm::mat4 eye_to_world = glm::inverse(view.view);
    const double texel = 2.0 * std::tan(glm::radians(0.5 * full_angle)) / size;
    const glm::dvec3 intensity = glm::dvec3(channels(light.power)) / solid_angle(light);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const std::size_t i = static_cast<std::size_t>(y) * size + x;
        if (image.id[i] < 0) continue;
        const glm::vec3 direction = glm::normalize(image.position[i] - light.position);
        if (!in_cone(light, direction)) continue;
        const double cosine = -(glm::transpose(glm::mat3(eye_to_world)) * direction).z;
        launch(image, i, direction, intensity * (texel * texel * cosine * cosine * cosine), keep);
      }
    }
    if (keep) keep_shadow(image, view, light.position, axis, false);
  }

  void from_outside(const Light& light) {
    result_.emitted += glm::dvec3(channels(light.power));
    const glm::vec3 to_centre = centre_ - light.position;
    const float distance = glm::length(to_centre);
    const bool spot = light.kind == LightKind::spot;
    float sphere_angle = 360.0f;
    if (distance > 1.05f * radius_) sphere_angle = glm::degrees(2.0f * std::asin(radius_ / distance));
    const float texel_distance = std::max(distance, 0.25f * radius_);
    auto size_for = [&](float angle) { return map_size(2.0f * std::tan(glm::radians(0.5f * angle)) * texel_distance); };
    if (spot && light.cone_angle <= sphere_angle) {
      perspective(light, glm::normalize(light.direction), light.cone_angle, size_for(light.cone_angle), true);
    } else if (sphere_angle <= 140.0f) {
      perspective(light, to_centre / distance, sphere_angle, size_for(sphere_angle), true);
    } else {
      // Close to or among the bodies: the six faces of a cube about the light. Shadows on the ground are then left out.
      for (int face = 0; face < 6; ++face) {
        glm::vec3 axis(0);
        axis[face / 2] = face % 2 ? 1.0f : -1.0f;
        perspective(light, axis, 90.0f, size_for(90.0f), false);
      }
    }
  }

  /// Directions of a Fibonacci lattice on the sphere: even, regular, no clumps.
  void from_inside(const Light& light, int region) {
    result_.emitted += glm::dvec3(channels(light.power));
    const float reach = glm::length(frame_.size()) * 0.25f;
    const double wanted = 4.0 * kPi * reach * reach / (texel_ * texel_);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, 1e4, 4e6));
    const double golden = glm::pi<double>() * (3.0 - std::sqrt(5.0));
    std::vector<glm::vec3> directions;
    for (std::size_t i = 0; i < count; ++i) {
      const double z = 1.0 - 2.0 * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      const double rho = std::sqrt(1.0 - z * z), angle = golden * static_cast<double>(i) + 6.2831853 * radical_inverse(seed_, 2);
      const glm::vec3 direction(rho * std::cos(angle), rho * std::sin(angle), z);
      if (in_cone(light, direction)) directions.push_back(direction);
    }
    const glm::dvec3 share = glm::dvec3(channels(light.power)) / static_cast<double>(std::max<std::size_t>(directions.size(), 1));
    std::vector<float> eta(1);
    medium_.read_eta(region, glm::ivec3(glm::floor((light.position - frame_.origin) / frame_.voxel_size)), glm::ivec3(1), eta);
    for (const glm::vec3& direction : directions) push(light.position, eta[0] * direction, -direction, region, false, share);
  }

  const MediumVolume& medium_;
  const EntrySurfaces& surfaces_;
  const DeviceMedium& device_;
  const MarchSettings& march_;
  const GridFrame& frame_;
  std::uint64_t seed_;
  glm::vec3 centre_{0};
  float radius_ = 1, texel_ = 1;
  std::size_t texels_before_ = 0;   // of earlier lights' shadow maps
  LightRays result_;
  ShadowMap shadow_;
  glm::dvec3 carried_{0};
};

}  // namespace

LightRays start_rays(const LightList& lights, const MediumVolume& medium, const EntrySurfaces& surfaces,
                     const DeviceMedium& device, const MarchSettings& march, std::uint64_t seed) {
  RayStarter starter(medium, surfaces, device, march, seed);
  for (const Light& light : lights) starter.add(light);
  return starter.take();
}

}  // namespace turbid
