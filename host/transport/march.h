// SPDX-License-Identifier: Apache-2.0
// Runs the marching pass: batches of rays until none is left, deposits and tallies in fixed point.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "host/transport/device_medium.h"
#include "host/transport/light_rays.h"

namespace turbid {

/// What the marching pass leaves, in watts per channel.
struct MarchTallies {
  glm::dvec3 absorbed{0}, deposited{0}, reflected{0}, opaque{0}, in_flight{0};
  std::array<glm::dvec3, 6> escaped{};
  MarchWork work;
};

class March {
 public:
  March(cl::Session&, const DeviceMedium&, const MarchSettings&, const std::array<FaceBoundary, 6>& faces,
        const Surroundings&);

  /// Forgets earlier light and loads the rays.
  void start(const LightRays&);
  /// Starts one batch of steps on the march queue and returns at once; only while rays are left.
  void enqueue_batch();
  /// Runs the rest of the batch, piece by piece, and learns how many rays go on; false when none is left.
  /// `between` is called between pieces, a fraction of a second apart, and may throw to stop.
  bool finish_batch(const std::function<void()>& between = {});
  std::size_t rays_left() const { return ray_count_; }
  int batches() const { return batches_; }

  /// Deposits in watts on the nodes of the source tiles: [tile][node][channel].
  const std::vector<std::int64_t>& read_deposit();
  /// Where phase functions are anisotropic: the deposits times the direction of the light, [axis][tile][node][channel];
  /// empty elsewhere.
  std::vector<std::int64_t> read_flux();
  double watts_per_unit() const { return 1.0 / fixed_per_watt_; }
  MarchTallies read_tallies();
  GroundLight read_ground();
  /// Where nothing refracts: fills the shadow maps' transmittance. `light` is what was started.
  void read_transmittance(const LightRays& light, std::vector<ShadowMap>* shadows);

 private:
  void reserve(std::size_t rays);
  void enqueue_piece();

  cl::Session& session_;
  const DeviceMedium& medium_;
  MarchSettings settings_;
  MarchParams params_{};
  cl::Program program_;
  cl::Kernel<cl::Buffer<RegionParams>, cl::Buffer<int>, cl::Buffer<int>, cl::Buffer<float>, cl::Buffer<std::byte>,
             cl::Buffer<std::byte>, cl::Buffer<int>, MarchParams, cl::Buffer<RayState>, cl::Buffer<RayState>, cl::Buffer<int>,
             cl::Buffer<int>, cl::Buffer<std::int64_t>, cl::Buffer<std::int64_t>, cl::Buffer<std::int64_t>,
             cl::Buffer<std::int64_t>, cl::Buffer<int>, cl::Buffer<std::int64_t>>
      kernel_;
  cl::Kernel<cl::Buffer<std::int64_t>, cl::Buffer<std::int64_t>, int, int> sum_deposits_;
  cl::Buffer<RayState> rays_, next_;
  cl::Buffer<int> next_count_, claims_, ground_rays_;
  std::size_t workers_ = 0;  ///< work-items of a launch on a CPU
  int volumes_ = 0;  ///< work-items that have sums of their own, each a volume of all nodes; 0: they share one
  cl::Buffer<std::int64_t> own_sums_;  ///< [volume][node][4, or 1 where the scene is grey]
  cl::Buffer<std::int64_t> deposit_, flux_, tallies_, ground_, transmitted_;
  std::size_t ray_count_ = 0;
  std::vector<std::int64_t> read_;  ///< what read_deposit gave last
  int batches_ = 0;
  double fixed_per_watt_ = 1;
};

}  // namespace turbid
