// SPDX-License-Identifier: Apache-2.0
// Hand-written C++ of what march.cl and view.cl do in one graded region with constant coefficients: the same rays, the same
// drift-kick-drift, sixteen rays in step per thread, vectors written out. What the kernels' speed is measured against.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace turbid::reference {

/// A cube of n^3 voxels; lengths in voxels. Nodes stand at voxel centres, x fastest.
struct RayMedium {
  int n = 0;
  std::vector<float> index;       ///< [node][4]: grad u, u with u = eta^2 / 2
  std::vector<float> source;      ///< [node][4]: gathered source; for gather_rays() only
  std::array<float, 4> sigma_s{}, sigma_a{};  ///< [1/voxel]
  float tau_per_arc = 1;          ///< 1 / largest eta
};

struct RayStart {
  float position[3];
  float velocity[3];  ///< |velocity| = eta
  float power[4];     ///< [W]; of gather_rays() the weight
};

struct MarchSums {
  std::array<double, 3> absorbed{};  ///< by extinction, scattered or not [W]
  std::array<double, 3> escaped{};
  std::int64_t steps = 0;
};

/// Marches all rays until they leave the cube. `step`: arc length [voxels].
MarchSums march_rays(const RayMedium&, const std::vector<RayStart>&, float step, int threads);

/// Follows camera rays through the cube; radiance[ray][4]. A ray ends when its largest weight falls below `min_weight`.
std::int64_t gather_rays(const RayMedium&, const std::vector<RayStart>&, float step, float min_weight, int threads,
                         std::vector<float>* radiance);

}  // namespace turbid::reference
