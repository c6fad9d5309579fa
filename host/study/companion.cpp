// SPDX-License-Identifier: Apache-2.0
// See companion.h.
#include "host/study/companion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "host/study/error_measures.h"

namespace turbid {
namespace {

/// Whether a larger domain would hold the same medium: nothing fills it outside the bodies, and they lie inside.
bool can_grow(const Scene& scene) {
  const GridFrame& frame = scene.medium.frame;
  const glm::vec3 slack(0.01f * frame.voxel_size);
  for (const Body& body : scene.medium.bodies)
    for (const glm::vec3& p : body.solid.mesh.positions)
      if (glm::any(glm::lessThan(p, frame.origin - slack)) || glm::any(glm::greaterThan(p, frame.upper() + slack)))
        return false;
  return scene.medium.ambient_material < 0;
}

/// On so many voxels that are `times` as large; nothing if that is another domain.
std::optional<Scene> on_larger_voxels(const Scene& scene, int times, glm::ivec3 voxels) {
  const GridFrame& fine = scene.medium.frame;
  GridFrame coarse = fine;
  coarse.voxel_size = fine.voxel_size * float(times);
  coarse.voxels = voxels;
  for (int axis = 0; axis < 3; ++axis) {
    const int growth = voxels[axis] * times - fine.voxels[axis];
    if (growth == 0) continue;
    const auto face = static_cast<std::size_t>(2 * axis);
    const bool lower_open = scene.medium.faces[face] == FaceBoundary::open,
               upper_open = scene.medium.faces[face + 1] == FaceBoundary::open;
    if (!can_grow(scene) || (!lower_open && !upper_open)) return std::nullopt;
    // Towards the open end, by whole coarse voxels if that end is the lower one, so that voxels stay aligned.
    if (!upper_open) coarse.origin[axis] -= float(growth) * fine.voxel_size;
  }
  Scene result = scene;
  result.medium.frame = coarse;
  return result;
}

/// Fine voxels per edge of a coarse one, and the coarse frame's origin in fine voxels.
struct Alignment {
  int times = 1;
  glm::ivec3 shift{0};
};

Alignment align(const GridFrame& coarse, const GridFrame& fine) {
  Alignment a;
  a.times = static_cast<int>(std::lround(coarse.voxel_size / fine.voxel_size));
  const glm::vec3 shift = (coarse.origin - fine.origin) / fine.voxel_size;
  a.shift = glm::ivec3(glm::round(shift));
  // 0.01 voxels: more than the rounding of float sizes over a domain, less than any intended shift.
  if (a.times < 1 || std::abs(coarse.voxel_size / fine.voxel_size - float(a.times)) > 1e-4f * float(a.times) ||
      glm::length(shift - glm::vec3(a.shift)) > 0.01f)
    throw std::invalid_argument("common_values: the voxels of the two grids do not coincide");
  return a;
}

glm::ivec3 voxel_in_block(int v) {
  return {v % kBlockEdge, v / kBlockEdge % kBlockEdge, v / (kBlockEdge * kBlockEdge)};
}

std::size_t index_of(const FluenceVolume& volume, glm::ivec3 voxel) {
  if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, volume.frame.voxels)))
    return std::size_t(-1);
  const int block = volume.blocks.find(voxel / kBlockEdge);
  if (block < 0) return std::size_t(-1);
  const glm::ivec3 v = voxel % kBlockEdge;
  return std::size_t(block) * volume.blocks.voxels_per_block() + (v.z * kBlockEdge + v.y) * kBlockEdge + v.x;
}

}  // namespace

std::optional<Scene> coarser_scene(const Scene& scene, int times) {
  const glm::ivec3 unit(kBlockEdge * times);
  return on_larger_voxels(scene, times, (scene.medium.frame.voxels + unit - 1) / unit * kBlockEdge);
}

std::optional<Scene> coarser_scene_of_same_size(const Scene& scene, int times) {
  std::optional<Scene> same = on_larger_voxels(scene, times, scene.medium.frame.voxels);
  return same ? same : coarser_scene(scene, times);
}

Scene finer_scene(const Scene& scene, int times) {
  Scene result = scene;
  result.medium.frame.voxels *= times;
  result.medium.frame.voxel_size /= float(times);
  return result;
}

SampledFluence sample_fluence(const FluenceVolume& volume, const MediumVolume& medium) {
  std::vector<LocalMedium> media = local_media(volume, medium);
  FluenceVolume total = total_fluence(volume, media);
  return {std::move(total), std::move(media)};
}

std::vector<std::vector<float>> common_values(const SampledFluence& coarse,
                                              const std::vector<const SampledFluence*>& fine, double least_share) {
  std::vector<std::vector<float>> values(1 + fine.size());
  if (fine.empty()) return values;
  std::vector<Alignment> to_fine;
  std::vector<std::vector<std::size_t>> at(fine.size());  // of the active finer voxels of one coarse voxel, per grid
  for (const SampledFluence* each : fine) to_fine.push_back(align(coarse.total.frame, each->total.frame));
  const std::size_t coarse_stride = coarse.total.colour_stride();
  for (int block = 0; block < coarse.total.blocks.count(); ++block)
    for (int v = 0; v < coarse.total.blocks.voxels_per_block(); ++v) {
      const std::size_t i = std::size_t(block) * coarse.total.blocks.voxels_per_block() + v;
      if (!coarse.media[i].participates) continue;
      const glm::ivec3 voxel = coarse.total.blocks.coordinates(block) * kBlockEdge + voxel_in_block(v);
      bool whole = true;
      for (std::size_t f = 0; f < fine.size() && whole; ++f) {
        const int times = to_fine[f].times, children = times * times * times;
        at[f].clear();
        for (int child = 0; child < children; ++child) {
          const glm::ivec3 within(child % times, child / times % times, child / (times * times));
          const std::size_t j = index_of(fine[f]->total, voxel * times + within + to_fine[f].shift);
          if (j != std::size_t(-1) && fine[f]->media[j].participates) at[f].push_back(j);
        }
        whole = !at[f].empty() && static_cast<double>(at[f].size()) >= least_share * children;
      }
      if (!whole) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        values[0].push_back(coarse.total.fluence[c * coarse_stride + i]);
        for (std::size_t f = 0; f < fine.size(); ++f) {
          double sum = 0;
          for (const std::size_t j : at[f]) sum += fine[f]->total.fluence[c * fine[f]->total.colour_stride() + j];
          values[1 + f].push_back(static_cast<float>(sum / static_cast<double>(at[f].size())));
        }
      }
    }
  return values;
}

std::vector<std::vector<float>> interpolated_values(const SampledFluence& coarse,
                                                    const std::vector<const SampledFluence*>& fine) {
  std::vector<std::vector<float>> values(1 + fine.size());
  if (fine.empty()) return values;
  const FluenceVolume& grid = fine.front()->total;
  const Alignment a = align(coarse.total.frame, grid.frame);
  const std::size_t coarse_stride = coarse.total.colour_stride(), stride = grid.colour_stride();
  const int per_block = grid.blocks.voxels_per_block();
  for (int block = 0; block < grid.blocks.count(); ++block)
    for (int v = 0; v < per_block; ++v) {
      const std::size_t i = std::size_t(block) * per_block + v;
      if (std::any_of(fine.begin(), fine.end(), [&](const auto* each) { return !each->media[i].participates; }))
        continue;
      const glm::ivec3 voxel = grid.blocks.coordinates(block) * kBlockEdge + voxel_in_block(v);
      const glm::vec3 p = (glm::vec3(voxel - a.shift) + 0.5f) / float(a.times) - 0.5f;
      const glm::ivec3 low(glm::floor(p));
      double sum[3] = {}, weights = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 at = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::vec3 w = 1.0f - glm::abs(p - glm::vec3(at));
        const std::size_t j = index_of(coarse.total, at);
        if (j == std::size_t(-1) || !coarse.media[j].participates || !(w.x * w.y * w.z > 0)) continue;
        weights += double(w.x) * w.y * w.z;
        for (std::size_t c = 0; c < 3; ++c)
          sum[c] += double(w.x) * w.y * w.z * coarse.total.fluence[c * coarse_stride + j];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        values[0].push_back(weights > 0 ? static_cast<float>(sum[c] / weights) : 0.0f);
        for (std::size_t f = 0; f < fine.size(); ++f) values[1 + f].push_back(fine[f]->total.fluence[c * stride + i]);
      }
    }
  return values;
}

}  // namespace turbid
