// SPDX-License-Identifier: Apache-2.0
// Owns the ray buffers and the fixed-point sums of the marching pass.
#include "host/transport/march.h"

#include "host/transport/ground_light.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

constexpr int kRaysPerLaunch = 1 << 14;  // Ctrl-C is answered between launches
// Where the loop shape is a CPU's: rays that a work-item interleaves, and rays that it takes at a time.
constexpr int kInterleave = 32, kRaysPerClaim = 64;
constexpr std::size_t kOwnSumsShare = 8;  // of the device's memory, at the most, goes to work-items' own sums
constexpr int kGroundTexels = 768;     // at the most, per side
constexpr float kGroundReach = 3.0f;  // the collecting map spans this many domain sizes

glm::dvec3 colour_at(const std::vector<std::int64_t>& sums, std::size_t index, double scale) {
  return {scale * static_cast<double>(sums[index]), scale * static_cast<double>(sums[index + 1]),
          scale * static_cast<double>(sums[index + 2])};
}

}  // namespace

March::March(cl::Session& session, const DeviceMedium& medium, const MarchSettings& settings,
             const std::array<FaceBoundary, 6>& faces, const Surroundings& surroundings)
    : session_(session), medium_(medium), settings_(settings) {
  const cl::DeviceInfo& device = session.device();
  const std::size_t channels = medium.features.channels;
  const std::size_t nodes = medium.source_tiles.size() * TURBID_TILE_NODES, width = channels == 3 ? 4 : 1;
  workers_ = static_cast<std::size_t>(settings.workers > 0 ? settings.workers : device.compute_units);
  if (device.cpu && workers_ * nodes * width * sizeof(std::int64_t) <= device.global_memory / kOwnSumsShare) {
    volumes_ = static_cast<int>(workers_);
  }
  std::vector<cl::Define> defines = medium.defines();
  defines.push_back({"TURBID_INTERLEAVE", device.cpu ? kInterleave : 1});
  defines.push_back({"TURBID_RAYS_PER_CLAIM", device.cpu ? kRaysPerClaim : 1});
  defines.push_back({"TURBID_OWN_SUMS", volumes_ > 0});
  const bool moments = medium.features.anisotropic && medium.features.scattering;
  defines.push_back({"TURBID_FIRST_MOMENT", moments});
  program_ = session.build("march.cl", defines);
  kernel_ = decltype(kernel_)(program_, "march");
  sum_deposits_ = decltype(sum_deposits_)(program_, "sum_deposits");
  params_.step = settings.step_in_voxels;
  params_.batch_steps = settings.batch_steps;
  params_.max_steps = settings.max_steps;
  params_.max_bounces = settings.max_bounces;
  for (int face = 0; face < 6; ++face) params_.faces[face] = static_cast<int>(faces[face]);
  params_.straight = !medium.features.interfaces && !medium.features.graded_index;
  if (surroundings.ground) {
    const GridFrame& frame = medium.frame;
    const float extent = kGroundReach * std::max({frame.size().x, frame.size().y, frame.size().z}) / frame.voxel_size;
    const glm::vec2 centre = 0.5f * glm::vec2(frame.voxels.x, frame.voxels.z);
    params_.ground = 1;
    params_.ground_height = (surroundings.ground->height - frame.origin.y) / frame.voxel_size;
    // Texels of two ray spacings where light goes straight on; see smooth_ground_light for where it spreads.
    params_.ground_texel = std::max(2.0f / std::sqrt(settings.rays_per_face), extent / kGroundTexels);
    params_.ground_size = static_cast<int>(std::ceil(extent / params_.ground_texel));
    params_.ground_origin[0] = centre.x - 0.5f * extent;
    params_.ground_origin[1] = centre.y - 0.5f * extent;
  }
  params_.own_nodes = volumes_ > 0 ? static_cast<int>(nodes) : 0;
  deposit_ = session.allocate<std::int64_t>(nodes * channels);
  params_.flux_stride = static_cast<int>(deposit_.count());
  flux_ = session.allocate<std::int64_t>(moments ? 3 * deposit_.count() : 0);
  own_sums_ = session.allocate<std::int64_t>(volumes_ * nodes * width);
  tallies_ = session.allocate<std::int64_t>(3 * TURBID_TALLY_COUNT);
  // Where nothing refracts, what passes is kept per shadow-map texel instead.
  const std::size_t texels = params_.straight ? 0 : static_cast<std::size_t>(params_.ground_size) * params_.ground_size;
  ground_ = session.allocate<std::int64_t>(texels * channels);
  ground_rays_ = session.allocate<int>(texels);
  next_count_ = session.allocate<int>(1);
  claims_ = session.allocate<int>(1);
}

void March::reserve(std::size_t rays) {
  // A ray leaves at most two per batch: itself and one branch.
  if (next_.count() < 2 * rays) next_ = session_.allocate<RayState>(2 * rays);
}

void March::start(const LightRays& light) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, light.emitted[c]);
  // No sum can exceed what is emitted: 2^60 units leave two bits of headroom in 64-bit integers.
  fixed_per_watt_ = std::exp2(std::min(std::floor(60.0 - std::log2(std::max(largest, 1e-30))), 120.0));  // fits a float
  params_.fixed_per_watt = static_cast<float>(fixed_per_watt_);
  ray_count_ = light.rays.size();
  batches_ = 0;
  if (rays_.count() < ray_count_) rays_ = session_.allocate<RayState>(ray_count_);
  session_.write(session_.march_queue(), rays_, std::span<const RayState>(light.rays));
  session_.fill_zero(session_.march_queue(), deposit_);
  session_.fill_zero(session_.march_queue(), flux_);
  session_.fill_zero(session_.march_queue(), own_sums_);
  session_.fill_zero(session_.march_queue(), tallies_);
  session_.fill_zero(session_.march_queue(), ground_);
  session_.fill_zero(session_.march_queue(), ground_rays_);
  const std::size_t texels = params_.straight ? light.texel_power.size() * medium_.features.channels : 0;
  if (transmitted_.count() != texels || texels == 0) transmitted_ = session_.allocate<std::int64_t>(texels);
  session_.fill_zero(session_.march_queue(), transmitted_);
}

void March::enqueue_batch() {
  reserve(ray_count_);
  session_.fill_zero(session_.march_queue(), next_count_);
  params_.end_ray = 0;
  enqueue_piece();
}

void March::enqueue_piece() {
  cl::Queue& queue = session_.march_queue();
  params_.first_ray = params_.end_ray;
  params_.end_ray = static_cast<int>(std::min<std::size_t>(params_.first_ray + kRaysPerLaunch, ray_count_));
  session_.fill_zero(queue, claims_);
  const cl::DeviceInfo& device = session_.device();
  // A CPU's work-items take rays until none is left, as a rule one per core; a GPU's take one ray each.
  const std::size_t rays = params_.end_ray - params_.first_ray;
  const std::size_t items = device.cpu ? workers_ : rays;
  kernel_.enqueue(queue, {items}, {device.cpu ? std::size_t{1} : std::size_t{64}}, medium_.regions_buffer,
                  medium_.tile_map_buffer, medium_.block_region_buffer, medium_.distance_tiles, medium_.index_tiles.bytes,
                  medium_.coefficient_tiles.bytes, medium_.region_tiles, params_, rays_, next_, next_count_, claims_,
                  volumes_ > 0 ? own_sums_ : deposit_, flux_, tallies_, ground_, ground_rays_, transmitted_);
  cl::check(clFlush(queue.get()), "starting the march");
}

bool March::finish_batch(const std::function<void()>& between) {
  while (static_cast<std::size_t>(params_.end_ray) < ray_count_) {
    session_.march_queue().finish();
    if (between) between();
    enqueue_piece();
  }
  ray_count_ = static_cast<std::size_t>(session_.read(session_.march_queue(), next_count_)[0]);
  std::swap(rays_, next_);
  ++batches_;
  return ray_count_ > 0;
}

const std::vector<std::int64_t>& March::read_deposit() {
  cl::Queue& queue = session_.march_queue();
  if (volumes_ > 0) {
    const int nodes = params_.own_nodes;
    sum_deposits_.enqueue(queue, {static_cast<std::size_t>(nodes)}, {64}, own_sums_, deposit_, volumes_, nodes);
  }
  read_.resize(deposit_.count());
  session_.read(queue, deposit_, std::span<std::int64_t>(read_));
  return read_;
}

std::vector<std::int64_t> March::read_flux() { return session_.read(session_.march_queue(), flux_); }

MarchTallies March::read_tallies() {
  const std::vector<std::int64_t> sums = session_.read(session_.march_queue(), tallies_);
  const double scale = watts_per_unit();
  MarchTallies result;
  result.absorbed = colour_at(sums, 3 * TURBID_TALLY_ABSORBED, scale);
  result.deposited = colour_at(sums, 3 * TURBID_TALLY_DEPOSITED, scale);
  result.reflected = colour_at(sums, 3 * TURBID_TALLY_REFLECTED, scale);
  result.opaque = colour_at(sums, 3 * TURBID_TALLY_OPAQUE, scale);
  result.in_flight = colour_at(sums, 3 * TURBID_TALLY_IN_FLIGHT, scale);
  for (int face = 0; face < 6; ++face) {
    result.escaped[face] = colour_at(sums, 3 * (TURBID_TALLY_ESCAPED + face), scale);
  }
  const std::int64_t* work = sums.data() + 3 * TURBID_TALLY_WORK;
  result.work = {.steps = work[0], .deposits = work[1], .interfaces = work[2]};
  return result;
}

void March::read_transmittance(const LightRays& light, std::vector<ShadowMap>* shadows) {
  if (!params_.straight) return;
  const std::vector<std::int64_t> sums = session_.read(session_.march_queue(), transmitted_);
  const int channels = medium_.features.channels;
  std::size_t texel = 0;
  for (ShadowMap& shadow : *shadows) {
    shadow.transmittance.assign(shadow.depth.size(), glm::vec3(0));
    for (glm::vec3& share : shadow.transmittance) {
      const glm::dvec3& started = light.texel_power[texel];
      for (int c = 0; c < 3; ++c) {
        const int source = channels == 3 ? c : 0;
        if (started[source] <= 0) continue;
        share[c] = static_cast<float>(watts_per_unit() * static_cast<double>(sums[texel * channels + source]) / started[source]);
      }
      ++texel;
    }
  }
}

GroundLight March::read_ground() {
  GroundLight ground;
  if (!params_.ground || params_.straight) return ground;
  const GridFrame& frame = medium_.frame;
  const std::vector<std::int64_t> sums = session_.read(session_.march_queue(), ground_);
  ground.size = params_.ground_size;
  ground.texel = params_.ground_texel * frame.voxel_size;
  ground.origin = glm::vec2(frame.origin.x, frame.origin.z) +
                  frame.voxel_size * glm::vec2(params_.ground_origin[0], params_.ground_origin[1]);
  const double scale = watts_per_unit() / (static_cast<double>(ground.texel) * ground.texel);
  const int channels = medium_.features.channels;
  ground.irradiance.resize(static_cast<std::size_t>(ground.size) * ground.size);
  for (std::size_t i = 0; i < ground.irradiance.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const int source = channels == 3 ? c : 0;
      const double value = scale * static_cast<double>(sums[i * channels + source]);
      ground.irradiance[i][c] = static_cast<float>(channels == 3 ? value : value * medium_.features.tint[c]);
    }
  }
  smooth_ground_light(&ground, session_.read(session_.march_queue(), ground_rays_));
  return ground;
}

}  // namespace turbid
