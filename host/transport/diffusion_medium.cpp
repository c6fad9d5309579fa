// SPDX-License-Identifier: Apache-2.0
// Voxelised medium in; active voxels, their coefficients, boundary faces and interfaces out.
#include "host/transport/diffusion_medium.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>

#include "host/base/parallel.h"
#include "host/transport/device_medium.h"
#include "host/transport/emission.h"
#include "host/transport/fresnel_moments.h"
#include "host/transport/hat_volume.h"
#include "host/transport/surface_cut.h"

namespace turbid {
namespace {

constexpr int kEdge = 8, kVoxels = 512;
constexpr int kStep[3] = {1, kEdge, kEdge* kEdge};

/// Which regions are joined by a blurred index, where no interface stands.
bool joined(const Region& a, const Region& b) {
  return a.smooth_surface && b.smooth_surface;
}

/// Fills the voxels of one block.
void fill_block(DiffusionMedium& out, const MediumVolume& medium, int block, const std::vector<float>& floors,
                int first_colour) {
  const glm::ivec3 lower = kEdge * out.blocks.coordinates(block);
  const float h = out.frame.voxel_size;
  std::vector<int> owner(kVoxels);
  medium.read_owner(lower, glm::ivec3(kEdge), owner);
  std::map<int, std::vector<Coefficients>> varying;
  std::map<int, std::vector<float>> eta;
  for (int v = 0; v < kVoxels; ++v) {
    const int r = owner[v];
    const std::size_t at = block * std::size_t{kVoxels} + v;
    out.eta_squared[at] = 1.0f;
    if (r < 0 || floors[r] < 0.0f) continue;
    const Region& region = medium.region(r);
    out.region[at] = static_cast<std::int16_t>(r);
    Coefficients k{region.sigma_s, region.sigma_a, region.emission, region.g};
    if (region.heterogeneous) {
      auto& values = varying[r];
      if (values.empty()) {
        values.resize(kVoxels);
        medium.read_coefficients(r, lower, glm::ivec3(kEdge), values);
      }
      k = values[v];
    }
    float index = region.eta;
    if (region.graded_index) {
      auto& values = eta[r];
      if (values.empty()) {
        values.resize(kVoxels);
        medium.read_eta(r, lower, glm::ivec3(kEdge), values);
      }
      index = values[v];
    }
    out.eta_squared[at] = index * index;
    if (!out.g_star.empty()) out.g_star[at] = scaled_g(k.g);
    for (int c = 0; c < out.channels; ++c) {
      const std::size_t i = out.index(c, block, v);
      const int colour = first_colour + c;
      // Similarity: what delta-Eddington leaves has g* = g / (1 + g); its transport coefficient is sigma_a + (1 - g)
      // sigma_s.
      out.s[i] = std::max(h * (k.sigma_a[colour] + (1.0f - k.g) * k.sigma_s[colour]), floors[r]);
      out.s_a[i] = h * k.sigma_a[colour];
      out.emission[i] = k.emission[colour] * h * h * h;
    }
  }
}

class MomentCache {
 public:
  double extrapolation(float inside, float outside) {
    const std::lock_guard lock(mutex_);
    auto [it, fresh] = extrapolation_.try_emplace({inside, outside}, 0.0);
    if (fresh) it->second = fresh_extrapolation(inside, outside);
    return it->second;
  }
  double resistance(float a, float b) {
    const std::lock_guard lock(mutex_);
    auto [it, fresh] = resistance_.try_emplace({a, b}, 0.0);
    if (fresh) it->second = interface_resistance(a, b);
    return it->second;
  }

 private:
  static double fresh_extrapolation(float inside, float outside) {
    return fresnel_moments(inside, outside).extrapolation();
  }
  std::mutex mutex_;
  std::map<std::pair<float, float>, double> extrapolation_, resistance_;
};

struct BlockFaces {
  std::vector<BoundaryFace> boundary;
  std::vector<JumpFace> jumps;
};

/// Owner of the voxel that a periodic domain has at coordinates one beyond a face.
int owner_across_seam(const MediumVolume& medium, glm::ivec3 voxel) {
  const glm::ivec3 n = medium.frame().voxels;
  std::array<int, 1> owner{};
  medium.read_owner((voxel + n) % n, glm::ivec3(1), owner);
  return owner[0];
}

/// Index of a region at one voxel. Rounded so that a graded index asks for few different Fresnel integrals.
float rounded_eta(float eta) {
  return std::round(eta * 512.0f) / 512.0f;
}

BlockFaces faces_of_block(const DiffusionMedium& out, const MediumVolume& medium, int block, MomentCache& moments) {
  BlockFaces result;
  const glm::ivec3 lower = kEdge * out.blocks.coordinates(block);
  BlockDistances distances(medium, lower);
  std::vector<int> owner(10 * 10 * 10);
  medium.read_owner(lower - 1, glm::ivec3(10), owner);
  for (int v = 0; v < kVoxels; ++v) {
    const int r = out.region[block * std::size_t{kVoxels} + v];
    if (r < 0) continue;
    const Region& region = medium.region(r);
    const glm::ivec3 voxel(v % kEdge, (v / kEdge) % kEdge, v / (kEdge * kEdge));
    const float eta_here = rounded_eta(std::sqrt(out.eta_squared[block * std::size_t{kVoxels} + v]));
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, sign = face % 2 ? 1 : -1;
      glm::ivec3 local = voxel;
      local[axis] += sign;
      int other_owner = owner[(local.x + 1) + 10 * ((local.y + 1) + 10 * (local.z + 1))];
      const bool at_domain_face = other_owner < 0;
      if (at_domain_face && medium.faces()[face] == FaceBoundary::periodic) {
        other_owner = owner_across_seam(medium, lower + local);
      }
      const VoxelRef other = neighbour_over(out.blocks, block, v, face);
      const int r2 = other.block >= 0 ? out.region[other.block * std::size_t{kVoxels} + other.voxel] : -1;
      Cut cut;
      if (r2 >= 0) {
        if (sign < 0 || r2 == r || joined(region, medium.region(r2))) continue;
        const float eta_there =
            rounded_eta(std::sqrt(out.eta_squared[other.block * std::size_t{kVoxels} + other.voxel]));
        if (eta_here == eta_there) continue;
        if (!at_domain_face) cut = cut_by(distances, std::max(r, r2), voxel, axis, sign);
        result.jumps.push_back({block, static_cast<std::int16_t>(v), static_cast<std::int8_t>(axis),
                                static_cast<float>(moments.resistance(eta_here, eta_there) / cut.normal)});
        continue;
      }
      double a = 1.0;
      bool boundary_is_opaque = false;
      if (other_owner < 0) {
        if (medium.faces()[face] != FaceBoundary::open) continue;  // mirror: nothing crosses
      } else {
        if (!at_domain_face) cut = cut_by(distances, std::max(r, other_owner), voxel, axis, sign);
        const Region& beyond = medium.region(other_owner);
        boundary_is_opaque = beyond.opaque;
        if (!beyond.opaque) {
          // A blurred surface refracts as much as a sharp one in the end: from the body's own index to the ambient's.
          const float inside = joined(region, beyond) ? rounded_eta(region.eta) : eta_here;
          a = moments.extrapolation(inside, rounded_eta(beyond.eta));
        }
      }
      BoundaryFace boundary{
          block, static_cast<std::int16_t>(v), static_cast<std::int8_t>(face), boundary_is_opaque, cut.distance, {}};
      for (int c = 0; c < out.channels; ++c) {
        const double value = (2.0 * a / 3.0) / cut.normal + out.s[out.index(c, block, v)] * (cut.distance - 0.5);
        boundary.c[c] = static_cast<float>(std::max(value, 0.02));
      }
      result.boundary.push_back(boundary);
    }
  }
  return result;
}

}  // namespace

VoxelRef neighbour_over(const BlockGrid& blocks, int block, int voxel, int face) {
  const int axis = face / 2, step = kStep[axis];
  const int coordinate = (voxel / step) % kEdge;
  if (face % 2) {
    if (coordinate < kEdge - 1) return {block, voxel + step};
  } else if (coordinate > 0) {
    return {block, voxel - step};
  }
  const int other = blocks.neighbours()[block][face];
  if (other >= blocks.count()) return {-1, 0};
  return {other, face % 2 ? voxel - (kEdge - 1) * step : voxel + (kEdge - 1) * step};
}

DiffusionMedium make_diffusion_medium(const MediumVolume& medium, int channels, int first_colour) {
  const std::vector<float> floors = floors_of_s(medium);
  DiffusionMedium out(medium.frame(), active_blocks(medium, floors), channels);
  const std::size_t stride = out.stride();
  out.region.assign(stride, -1);
  out.eta_squared.assign(stride, 1.0f);
  for (int r = 0; r < medium.region_count(); ++r)
    if (medium.region(r).g != 0.0f || medium.region(r).heterogeneous) out.g_star.assign(stride, 0.0f);
  out.s.assign(stride * channels, 0.0f);
  out.s_a.assign(stride * channels, 0.0f);
  out.emission.assign(stride * channels, 0.0f);
  parallel_ranges(out.blocks.count(), [&](int begin, int end) {
    for (int block = begin; block < end; ++block) fill_block(out, medium, block, floors, first_colour);
  });
  if (std::all_of(out.g_star.begin(), out.g_star.end(), [](float g) { return g == 0.0f; })) out.g_star.clear();
  std::vector<BlockFaces> faces(out.blocks.count());
  MomentCache moments;
  parallel_ranges(out.blocks.count(), [&](int begin, int end) {
    for (int block = begin; block < end; ++block) faces[block] = faces_of_block(out, medium, block, moments);
  });
  for (const BlockFaces& block : faces) {
    out.boundary.insert(out.boundary.end(), block.boundary.begin(), block.boundary.end());
    out.jumps.insert(out.jumps.end(), block.jumps.begin(), block.jumps.end());
  }
  for (std::size_t i = 0; i < stride; ++i) {
    if (out.region[i] < 0) continue;
    ++out.active_voxels;
    out.index_varies |= out.eta_squared[i] != 1.0f;
  }
  out.hat_volume = hat_volumes(medium, out);
  weigh_emission(out, medium, first_colour);
  return out;
}

std::vector<float> face_conductances(const DiffusionMedium& medium) {
  const std::size_t stride = medium.stride();
  std::vector<float> resistance(3 * stride, 0.0f);
  for (const JumpFace& jump : medium.jumps) {
    resistance[jump.axis * stride + jump.block * std::size_t{kVoxels} + jump.voxel] = jump.resistance;
  }
  std::vector<float> result(3 * stride * medium.channels, 0.0f);
  parallel_ranges(medium.blocks.count(), [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      for (int v = 0; v < kVoxels; ++v) {
        const std::size_t here = block * std::size_t{kVoxels} + v;
        if (medium.region[here] < 0) continue;
        for (int axis = 0; axis < 3; ++axis) {
          const VoxelRef other = neighbour_over(medium.blocks, block, v, 2 * axis + 1);
          if (other.block < 0) continue;
          const std::size_t there = other.block * std::size_t{kVoxels} + other.voxel;
          if (medium.region[there] < 0) continue;
          for (int c = 0; c < medium.channels; ++c) {
            const double half_cells = 1.5 * (medium.s[c * stride + here] / medium.eta_squared[here] +
                                             medium.s[c * stride + there] / medium.eta_squared[there]);
            result[(3 * c + axis) * stride + here] =
                static_cast<float>(1.0 / (half_cells + resistance[axis * stride + here]));
          }
        }
      }
    }
  });
  return result;
}

}  // namespace turbid
