// SPDX-License-Identifier: Apache-2.0
// From the marching pass's deposits to what the solvers and the view need: power per voxel, and density for looking at.
#pragma once
#include <vector>

#include "host/transport/diffusion_medium.h"
#include "host/transport/face_sources.h"
#include "host/transport/march.h"

namespace turbid {

struct LightSource {
  std::vector<float> power;    ///< [channel][block][voxel] source of the diffusion [W], emission included
  std::vector<float> density;  ///< [channel][block][voxel] first-scattered power per volume [W/voxel^3]
  glm::dvec3 deposited{0};     ///< summed deposits, per channel [W]
  glm::dvec3 emitted{0};       ///< by emitting media [W]
  glm::dvec3 unresolved{0};    ///< deposits near which no active voxel is [W]: parts thinner than a voxel
  LeftAtOnce left;             ///< of the deposits, what leaves through surfaces without diffusing
};

/// Deposits on nodes outside a region's own voxels go to its nearest active voxels, in equal shares of inverse square
/// distance, less what leaves through the surface between at once. `flux`: see March::read_flux. Deterministic.
LightSource gather_source(const std::vector<std::int64_t>& deposit, const std::vector<std::int64_t>& flux,
                          double watts_per_unit, const DeviceMedium&, const DiffusionMedium&);

}  // namespace turbid
