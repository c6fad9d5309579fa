// SPDX-License-Identifier: Apache-2.0
// Fills diffusion media voxel by voxel, without voxelising; only the sphere goes the way of a scene.
#include "host/bench/hard_media.h"

#include <algorithm>
#include <cmath>

#include "volumes/procedural.h"
#include "volumes/solid.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512;

GridFrame cube(int n) { return {.voxels = glm::ivec3(n), .origin = glm::vec3(0), .voxel_size = 1.0f}; }

glm::ivec3 voxel_at(const DiffusionMedium& medium, std::size_t i) {
  const int v = static_cast<int>(i % kVoxels);
  return kEdge * medium.blocks.coordinates(static_cast<int>(i / kVoxels)) +
         glm::ivec3(v % kEdge, v / kEdge % kEdge, v / (kEdge * kEdge));
}

/// Evenly spread numbers in [0, 1), the same on every machine (a hash of three coordinates).
double scatter(glm::ivec3 p) {
  std::uint32_t h = static_cast<std::uint32_t>(p.x) * 0x8da6b343u ^ static_cast<std::uint32_t>(p.y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(p.z) * 0xcb1ab31fu;
  h = (h ^ (h >> 16)) * 0x7feb352du;
  h = (h ^ (h >> 15)) * 0x846ca68bu;
  return (h ^ (h >> 16)) / 4294967296.0;
}

double thickness(HardMedium kind, glm::ivec3 p, int n, double s) {
  const double empty = std::max(1e-4 * s, 1.0 / n);
  const glm::ivec3 cell = p / std::max(1, n / 8);
  switch (kind) {
    case HardMedium::checker: return (cell.x + cell.y + cell.z) % 2 ? 100 * s : s;
    case HardMedium::layers: return cell.x % 2 ? 100 * s : s;
    case HardMedium::random: return s * std::pow(100.0, scatter(p) - 0.5);
    case HardMedium::duct: return std::abs(2 * p.y + 1 - n) < n / 4 && std::abs(2 * p.z + 1 - n) < n / 4 ? empty : s;
    case HardMedium::voids: return scatter(p / std::max(1, n / 16)) < 0.1 ? empty : s;
    default: return s;
  }
}

DiffusionMedium sphere(int n, double s, double albedo, int channels) {
  MediumDescription scene;
  scene.frame = cube(n);
  Material material;
  material.name = "sphere";
  material.eta = constant_field(glm::vec3(1.5f));
  material.sigma_s = constant_field(glm::vec3(static_cast<float>(s * albedo)));
  material.sigma_a = constant_field(glm::vec3(static_cast<float>(s * (1 - albedo))));
  material.g = constant_field(glm::vec3(0));
  material.emission = constant_field(glm::vec3(0));
  scene.materials.push_back(material);
  scene.bodies.push_back(
      {"sphere", make_sphere(0.45f * n, Placement{.translation = glm::vec3(0.5f * n)}), 0, SurfaceKind::sharp});
  return make_diffusion_medium(voxelise(scene), channels);
}

}  // namespace

std::string name_of(HardMedium kind) {
  static const char* const kNames[] = {"homogeneous", "checker 100x", "random 100x", "layers 100x",
                                       "void duct",   "scattered voids", "sphere eta 1.5"};
  return kNames[static_cast<int>(kind)];
}

DiffusionMedium hard_medium(HardMedium kind, int n, double s, double albedo, int channels) {
  if (kind == HardMedium::sphere) return sphere(n, s, albedo, channels);
  const GridFrame frame = cube(n);
  DiffusionMedium out(frame, BlockGrid(frame.blocks(), kEdge, [](glm::ivec3) { return true; }), channels);
  const std::size_t stride = out.stride();
  out.region.assign(stride, 0);
  out.hat_volume.assign(stride, 1.0f);
  out.eta_squared.assign(stride, 1.0f);
  out.s.resize(stride * channels);
  out.s_a.resize(stride * channels);
  out.emission.assign(stride * channels, 0.0f);
  out.active_voxels = stride;
  for (std::size_t i = 0; i < stride; ++i) {
    const glm::ivec3 p = voxel_at(out, i);
    const double here = thickness(kind, p, n, s);
    for (int c = 0; c < channels; ++c) {
      out.s[c * stride + i] = static_cast<float>(here);
      out.s_a[c * stride + i] = static_cast<float>((1 - albedo) * here);
    }
    for (int face = 0; face < 6; ++face) {
      if (p[face / 2] != (face % 2 ? n - 1 : 0)) continue;
      constexpr float kMatched = 2.0f / 3.0f;  // A = 1, surface half a voxel from the centre
      out.boundary.push_back({static_cast<std::int32_t>(i / kVoxels), static_cast<std::int16_t>(i % kVoxels),
                              static_cast<std::int8_t>(face), false, 0.5f, {kMatched, kMatched, kMatched}});
    }
  }
  return out;
}

std::vector<float> beam_source(const DiffusionMedium& medium) {
  const std::size_t stride = medium.stride();
  std::vector<float> q(stride * medium.channels, 0.0f);
  for (int c = 0; c < medium.channels; ++c) {
    for (std::size_t i = 0; i < stride; ++i) {
      if (medium.region[i] < 0) continue;
      const float s = medium.s[c * stride + i];
      q[c * stride + i] = s * std::exp(-std::min(s, 1.0f) * static_cast<float>(voxel_at(medium, i).x));
    }
  }
  return q;
}

std::vector<float> point_source(const DiffusionMedium& medium) {
  const std::size_t stride = medium.stride();
  const glm::ivec3 n = medium.frame.voxels, p = glm::ivec3(3, 4, 5) * n / 8;
  const int block = medium.blocks.find(p / kEdge);
  std::vector<float> q(stride * medium.channels, 0.0f);
  if (block < 0) return q;
  const glm::ivec3 v = p % kEdge;
  for (int c = 0; c < medium.channels; ++c) {
    q[c * stride + block * std::size_t{kVoxels} + v.x + kEdge * (v.y + kEdge * v.z)] = 1.0f;
  }
  return q;
}

}  // namespace turbid
