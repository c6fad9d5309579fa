// SPDX-License-Identifier: Apache-2.0
// Owns the sources and the fixed-point sums of the photon kernel.
#include "host/transport/photon.h"

#include <algorithm>
#include <cmath>

#include "host/transport/ground_light.h"

namespace turbid {
namespace {

constexpr int kGroundTexels = 768;          // at the most, per side
constexpr float kGroundReach = 3.0f;        // the collecting map spans this many domain sizes
constexpr std::uint64_t kItems = 1u << 16;  // work-items at the most; each follows photons one after the other
constexpr double kCumulativeUnits = 9223372036854775808.0;  // 2^63: the whole power of a colour

void words(std::uint64_t value, unsigned (&out)[2]) {
  out[0] = static_cast<unsigned>(value);
  out[1] = static_cast<unsigned>(value >> 32);
}

/// Running sums of the sources' powers as fractions of 2^63; all 0 where a colour has no power.
std::vector<std::uint64_t> cumulative_powers(const PhotonSources& sources, int channels) {
  std::vector<std::uint64_t> out;
  const glm::dvec3 total = sources.carried();
  for (int c = 0; c < channels; ++c) {
    double sum = 0;
    for (const double watts : sources.power[c]) {
      sum += watts;
      const double share = total[c] > 0 ? std::min(sum / total[c], 1.0) : 0.0;
      out.push_back(static_cast<std::uint64_t>(share * kCumulativeUnits));
    }
  }
  return out;
}

}  // namespace

Photons::Photons(cl::Session& session, const DeviceMedium& device, const PhotonMedium& medium, const SolverSettings& settings,
                 const std::array<FaceBoundary, 6>& faces, const Surroundings& surroundings)
    : session_(session), device_(device), medium_(medium) {
  std::vector<cl::Define> defines = device.defines();
  for (cl::Define& define : defines) {
    if (define.name == "TURBID_CHANNELS") define.value = 1;  // one colour at a time
  }
  defines.push_back({"TURBID_ANISOTROPIC", device.features.anisotropic});
  program_ = session.build("photon.cl", defines);
  kernel_ = decltype(kernel_)(program_, "photon");
  words(settings.seed, params_.seed);
  params_.coefficient_tiles = medium.coefficient_tiles;
  params_.majorant_sets = medium.majorant_sets;
  params_.voxel_sums = static_cast<int>(medium.stride());
  params_.max_steps = settings.photon.max_steps;
  params_.step = settings.march.step_in_voxels;
  for (int face = 0; face < 6; ++face) params_.faces[face] = static_cast<int>(faces[face]);
  if (surroundings.ground) {
    const GridFrame& frame = device.frame;
    const float extent = kGroundReach * std::max({frame.size().x, frame.size().y, frame.size().z}) / frame.voxel_size;
    const glm::vec2 centre = 0.5f * glm::vec2(frame.voxels.x, frame.voxels.z);
    params_.ground_height = (surroundings.ground->height - frame.origin.y) / frame.voxel_size;
    params_.ground_texel = std::max(1.0f, extent / kGroundTexels);
    params_.ground_size = static_cast<int>(std::ceil(extent / params_.ground_texel));
    params_.ground_origin[0] = centre.x - 0.5f * extent;
    params_.ground_origin[1] = centre.y - 0.5f * extent;
  }
  voxels_ = session.allocate<std::int64_t>(2 * medium.stride());
  tallies_ = session.allocate<std::int64_t>(TURBID_PHOTON_TALLIES + device.region_params.size());
  const std::size_t texels = static_cast<std::size_t>(params_.ground_size) * params_.ground_size;
  ground_ = session.allocate<std::int64_t>(texels * device.features.channels);
  ground_rays_ = session.allocate<std::int32_t>(texels);
}

void Photons::start(const PhotonSources& sources, double units) {
  params_.source_count = static_cast<int>(sources.sources.size());
  params_.unit = static_cast<float>(units);
  const std::vector<std::uint64_t> cumulative = cumulative_powers(sources, device_.features.channels);
  sources_ = session_.upload(sources.sources);
  cumulative_ = session_.upload(cumulative);
  sources_fingerprint_ = turbid::fingerprint(turbid::fingerprint(0, sources.sources), cumulative);
  clear_batch();
  session_.fill_zero(session_.march_queue(), ground_);
  session_.fill_zero(session_.march_queue(), ground_rays_);
}

void Photons::follow(const PhotonStretch& stretch) {
  PhotonParams params = params_;
  words(stretch.first, params.first_photon);
  words((std::uint64_t{1} << 63) / stretch.batch, params.stratum);
  params.first_in_batch = static_cast<unsigned>(stretch.first_in_batch);
  params.photon_count = static_cast<int>(stretch.count);
  params.channel = stretch.channel;
  cl::Queue& queue = session_.march_queue();
  kernel_.enqueue(queue, {static_cast<std::size_t>(std::min(stretch.count, kItems))}, {64}, device_.regions_buffer,
                  device_.tile_map_buffer, device_.block_region_buffer, device_.distance_tiles, device_.index_tiles.bytes,
                  medium_.coefficients, params, medium_.regions_buffer, sources_, cumulative_, medium_.majorants,
                  medium_.block_index, medium_.owner, voxels_, tallies_, ground_, ground_rays_);
  queue.finish();
}

void Photons::clear_batch() {
  session_.fill_zero(session_.march_queue(), voxels_);
  session_.fill_zero(session_.march_queue(), tallies_);
}

void Photons::read(PhotonSums& sums) {
  cl::Queue& queue = session_.march_queue();
  sums.voxels = session_.read(queue, voxels_);
  sums.tallies = session_.read(queue, tallies_);
  sums.ground = session_.read(queue, ground_);
  sums.ground_rays = session_.read(queue, ground_rays_);
}

void Photons::write(const PhotonSums& sums) {
  cl::Queue& queue = session_.march_queue();
  session_.write(queue, voxels_, std::span<const std::int64_t>(sums.voxels));
  session_.write(queue, tallies_, std::span<const std::int64_t>(sums.tallies));
  session_.write(queue, ground_, std::span<const std::int64_t>(sums.ground));
  session_.write(queue, ground_rays_, std::span<const std::int32_t>(sums.ground_rays));
}

std::uint64_t Photons::fingerprint() const {
  std::uint64_t result = turbid::fingerprint(medium_.fingerprint, &params_, sizeof params_);
  return turbid::fingerprint(result, &sources_fingerprint_, sizeof sources_fingerprint_);
}

GroundLight Photons::ground_light(const PhotonSums& sums, const glm::dvec3& watts) const {
  GroundLight ground;
  if (params_.ground_size == 0) return ground;
  const GridFrame& frame = device_.frame;
  ground.size = params_.ground_size;
  ground.texel = params_.ground_texel * frame.voxel_size;
  ground.origin = glm::vec2(frame.origin.x, frame.origin.z) +
                  frame.voxel_size * glm::vec2(params_.ground_origin[0], params_.ground_origin[1]);
  const double area = static_cast<double>(ground.texel) * ground.texel;
  const std::size_t texels = sums.ground_rays.size();
  ground.irradiance.resize(texels);
  const int channels = device_.features.channels;
  for (std::size_t i = 0; i < texels; ++i) {
    for (int c = 0; c < 3; ++c) {
      const int from = channels == 3 ? c : 0;
      const double value = watts[from] * static_cast<double>(sums.ground[from * texels + i]) / area;
      ground.irradiance[i][c] = static_cast<float>(channels == 3 ? value : value * device_.features.tint[c]);
    }
  }
  smooth_ground_light(&ground, sums.ground_rays);
  return ground;
}

}  // namespace turbid
