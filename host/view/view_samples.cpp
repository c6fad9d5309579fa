// SPDX-License-Identifier: Apache-2.0
// See view_samples.h.
#include "host/view/view_samples.h"

#include <algorithm>
#include <cmath>

#include "host/base/parallel.h"

namespace turbid {

SampleMaker::SampleMaker(const ViewInput& in, const Camera& camera, const EntrySurfaces& surfaces, const VoxelSpace& space)
    : in_(in), camera_(camera), space_(space), grid_(static_cast<int>(std::lround(std::sqrt(camera.samples)))) {
  view_ = camera_view(camera.position, camera.target, camera.up, camera.fov, camera.width * grid_,
                      camera.height * grid_, surfaces.bounds);
  if (!surfaces.meshes.empty()) image_ = &(in.first_hits ? *in.first_hits : own_hits_).of(surfaces.meshes, view_);
  rays_.emplace(view_);
  ambient_ = surfaces.ambient;
  const glm::vec3 x = space.point(camera.position);
  std::vector<int> owner(1);
  in.medium.read_owner(glm::ivec3(glm::floor(x)), glm::ivec3(1), owner);
  camera_region_ = owner[0];
}

Strip SampleMaker::strip(int first, int last) const {
  Strip result;
  result.width = camera_.width;
  result.rows = last - first;
  result.per_pixel = grid_ * grid_;
  const std::size_t count = static_cast<std::size_t>(result.width) * result.rows * result.per_pixel;
  result.samples.resize(count);
  result.depth.resize(count);
  result.normal.resize(count);
  result.coverage.resize(count);
  parallel_ranges(result.rows, [&](int begin, int end) {
    for (int row = begin; row < end; ++row) {
      for (int x = 0; x < result.width; ++x) {
        const std::size_t at = result.index(x, row);
        for (int k = 0; k < result.per_pixel; ++k) {
          add(x * grid_ + k % grid_, (first + row) * grid_ + k / grid_, at + k, &result);
        }
      }
    }
  });
  return result;
}

void SampleMaker::add(int x, int y, std::size_t to, Strip* out) const {
  const std::size_t i = static_cast<std::size_t>(y) * view_.width + x;
  const glm::vec3 eye = camera_.position, direction = glm::normalize(rays_->far_point(x, y) - glm::dvec3(eye));
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
  } else if (image_ && image_->id[i] >= 0 && image_->front[i]) {
    const float to_hit = glm::length(image_->position[i] - eye);
    if (to_hit < to_ground) {
      depth = to_hit;
      normal = image_->normal[i];
      coverage = 1;
      start_at(image_->position[i], direction, image_->id[i], normal, &sample);
    }
  }
  out->samples[to] = sample;
  out->depth[to] = depth;
  out->normal[to] = normal;
  out->coverage[to] = coverage;
}

void SampleMaker::start_at(glm::vec3 hit, glm::vec3 direction, int region, glm::vec3 normal, ViewSample* sample) const {
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

float SampleMaker::ground_distance(glm::vec3 eye, glm::vec3 direction) const {
  if (!in_.surroundings.ground || std::abs(direction.y) < 1e-7f) return kFarAway;
  const float t = (in_.surroundings.ground->height - eye.y) / direction.y;
  return t > 0 ? std::min(t, kFarAway) : kFarAway;
}

}  // namespace turbid
