// SPDX-License-Identifier: Apache-2.0
// The kernels' times come from the device's events, the references' from the wall clock; they take turns.
#include "host/bench/measure_rays.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "host/bench/figures.h"
#include "host/bench/reference_march.h"
#include "host/profile/spread.h"
#include "host/study/small_media.h"
#include "host/transport/march.h"
#include "host/view/source_tiles.h"
#include "host/view/view_samples.h"

namespace turbid {
namespace {

constexpr float kStep = 0.5f;  // [voxels]
// Single precision over some hundred steps: 3e-8 of the powers and 1e-6 of the radiances measured.
constexpr double kPowersAlike = 1e-6, kRadiancesAlike = 1e-5;

/// The reference's time over ours; nothing to compare where the two answers differ.
double ratio_of(const std::vector<double>& theirs, const std::vector<double>& ours, double apart, double alike) {
  return apart <= alike ? spread_of(theirs).median / spread_of(ours).median : std::numeric_limits<double>::quiet_NaN();
}

/// Seconds that a kernel ran on the device while `work` was done.
template <class Work>
double kernel_seconds(cl::Session& session, const char* kernel, const Work& work) {
  session.recorder().start();
  work();
  session.recorder().stop();
  double seconds = 0;
  for (const cl::Command& command : session.recorder().commands()) {
    if (command.name == kernel) seconds += command.seconds();
  }
  return seconds;
}

/// A Luneburg field over the whole domain, dim enough for rays to cross it.
MediumDescription luneburg_domain(int voxels, glm::vec3 sigma_s, glm::vec3 sigma_a) {
  const float n = static_cast<float>(voxels);
  MediumDescription description = study::empty_domain(glm::ivec3(voxels), 1.0f);
  Material material = study::make_material({.sigma_s = sigma_s, .sigma_a = sigma_a});
  material.eta = luneburg_index(glm::vec3(0.5f * n), 1.2f * n, 1.2f);
  study::set_ambient(description, material);
  return description;
}

struct Scene {
  MediumDescription description;
  MediumVolume volume = voxelise(description);
  LightList lights = {study::sunlight(glm::vec3(1.0f, 0.0f, 0.0f), glm::vec3(1.0f, 0.9f, 0.8f))};
  SceneFeatures features = scene_features(volume, lights);
};

/// Tiles of the device put together to one grid of nodes.
std::vector<float> dense(const DeviceMedium& device, int set, const std::vector<float>& tiles) {
  const int n = device.frame.voxels.x;
  const glm::ivec3 blocks = device.frame.blocks();
  std::vector<float> grid(4 * static_cast<std::size_t>(n) * n * n);
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        const int block = x / 8 + blocks.x * (y / 8 + blocks.y * (z / 8));
        const std::size_t tile = device.tile_map[static_cast<std::size_t>(set) * device.block_count() + block];
        const std::size_t node = tile * TURBID_TILE_NODES + x % 8 + TURBID_TILE_EDGE * (y % 8 + TURBID_TILE_EDGE * (z % 8));
        std::copy_n(tiles.data() + 4 * node, 4, grid.data() + 4 * (x + static_cast<std::size_t>(n) * (y + n * z)));
      }
    }
  }
  return grid;
}

std::vector<float> floats_of(const std::vector<std::byte>& bytes) {
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

reference::RayMedium reference_medium(cl::Session& session, const DeviceMedium& device) {
  const RegionParams& region = device.region_params[0];
  reference::RayMedium medium;
  medium.n = device.frame.voxels.x;
  medium.index = dense(device, region.index_set, floats_of(session.read(session.march_queue(), device.index_tiles.bytes)));
  std::copy_n(region.sigma_s, 3, medium.sigma_s.begin());
  std::copy_n(region.sigma_a, 3, medium.sigma_a.begin());
  medium.tau_per_arc = region.tau_per_arc;
  return medium;
}

std::string rate(const char* what, double steps, double seconds) {
  char text[96];
  std::snprintf(text, sizeof text, "%s, %.0f million steps/s", what, 1e-6 * steps / seconds);
  return text;
}

std::string difference(const char* of, double value) {
  char text[96];
  std::snprintf(text, sizeof text, "%s differ by %.1e", of, value);
  return text;
}

/// The march of one scene beside the deposit-free C++ march of the same rays.
Goal march_goal(cl::Session& session, int voxels, int repeats, bool deposits) {
  const glm::vec3 sigma_s = deposits ? glm::vec3(0.003f, 0.002f, 0.001f) : glm::vec3(0.0f);
  const Scene scene{luneburg_domain(voxels, sigma_s, glm::vec3(0.001f, 0.002f, 0.003f))};
  const DeviceMedium device = upload_medium(session, scene.volume, scene.features);
  MarchSettings settings;
  settings.step_in_voxels = kStep;
  const LightRays light = start_rays(scene.lights, scene.volume, entry_surfaces(scene.description, scene.volume, false),
                                     device, settings, 0);
  std::vector<reference::RayStart> rays;
  for (const RayState& ray : light.rays) {
    reference::RayStart start{};
    std::copy_n(ray.position, 3, start.position);
    std::copy_n(ray.velocity, 3, start.velocity);
    std::copy_n(ray.power, 3, start.power);
    rays.push_back(start);
  }
  const reference::RayMedium medium = reference_medium(session, device);
  March march(session, device, settings, scene.volume.faces(), {});
  reference::MarchSums sums;
  std::vector<double> ours, theirs;
  for (int k = 0; k <= repeats; ++k) {
    const double kernel = kernel_seconds(session, "march", [&] {
      march.start(light);
      while (march.rays_left() > 0) {
        march.enqueue_batch();
        march.finish_batch();
      }
    });
    const double reference =
        seconds_of([&] { sums = reference::march_rays(medium, rays, kStep, session.device().compute_units); });
    if (k == 0) continue;  // warms up
    ours.push_back(kernel);
    theirs.push_back(reference);
  }
  const MarchTallies tallies = march.read_tallies();
  glm::dvec3 escaped(0);
  for (const glm::dvec3& face : tallies.escaped) escaped += face;
  double worst = 0;
  for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(escaped[c] - sums.escaped[c]) / sums.escaped[c]);
  Goal goal;
  goal.name = deposits ? "march with RGB deposit / deposit-free C++" : "march / own AVX-512 interleaved";
  goal.ratio = ratio_of(theirs, ours, worst, kPowersAlike);  // the same rays: time against time
  goal.aim = deposits ? 0.75 : 0.95;
  goal.ours = rate("march.cl", static_cast<double>(tallies.work.steps), spread_of(ours).median);
  goal.against = rate("C++, 16 rays in step", static_cast<double>(sums.steps), spread_of(theirs).median);
  goal.error = difference("escaped powers", worst);
  return goal;
}

/// eta^2 / 2 at a point, or at the nearest one of the domain.
float half_square_of_eta(const reference::RayMedium& medium, glm::vec3 point) {
  const int n = medium.n;
  const glm::vec3 y = glm::clamp(point - 0.5f, glm::vec3(0), glm::vec3(static_cast<float>(n - 1)));
  const glm::ivec3 cell = glm::min(glm::ivec3(y), n - 2);
  const glm::vec3 f = y - glm::vec3(cell);
  float u = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 d(corner & 1, corner >> 1 & 1, corner >> 2), at = cell + d;
    const glm::vec3 w = glm::mix(1.0f - f, f, glm::vec3(d));
    u += w.x * w.y * w.z * medium.index[4 * (at.x + static_cast<std::size_t>(n) * (at.y + n * at.z)) + 3];
  }
  return u;
}

/// Camera samples as the kernel begins them, in plain C++; camera [voxels].
std::vector<reference::RayStart> camera_rays(const Strip& strip, const reference::RayMedium& medium, glm::vec3 camera) {
  const float square_at_observer = 2.0f * half_square_of_eta(medium, camera);
  std::vector<reference::RayStart> rays;
  for (const ViewSample& sample : strip.samples) {
    const glm::vec3 position(sample.position[0], sample.position[1], sample.position[2]);
    const float eta = std::sqrt(2.0f * half_square_of_eta(medium, position));
    reference::RayStart ray{};
    for (int i = 0; i < 3; ++i) {
      ray.position[i] = sample.position[i];
      ray.velocity[i] = sample.direction[i] * eta;
      ray.power[i] = sample.region < 0 ? 0.0f : square_at_observer;
    }
    rays.push_back(ray);
  }
  return rays;
}

Goal view_goal(cl::Session& session, int voxels, int repeats) {
  const Scene scene{luneburg_domain(voxels, glm::vec3(0.003f, 0.002f, 0.001f), glm::vec3(0.001f, 0.002f, 0.003f))};
  const auto device = std::make_shared<const DeviceMedium>(upload_medium(session, scene.volume, scene.features));
  // What is gathered need not solve anything: a smooth fluence does, and takes no time to get.
  FluenceVolume fluence{device->frame, BlockGrid(device->frame.blocks(), 8, [](glm::ivec3) { return true; }), {}, {}};
  fluence.fluence.resize(3 * fluence.colour_stride());
  fluence.deposit.assign(3 * fluence.colour_stride(), 0.0f);
  for (std::size_t i = 0; i < fluence.fluence.size(); ++i) {
    const glm::ivec3 voxel = 8 * fluence.blocks.coordinates(static_cast<int>(i % fluence.colour_stride() / 512)) +
                             glm::ivec3(i % 8, i / 8 % 8, i / 64 % 8);
    fluence.fluence[i] = 2.0f + std::sin(0.1f * static_cast<float>(voxel.x)) * std::cos(0.07f * static_cast<float>(voxel.y + voxel.z));
  }
  const LightSolution solution{.device = device, .volume = std::move(fluence), .ground = {}, .shadows = {ShadowMap{}}, .report = {}};
  const Surroundings black;
  ViewSettings settings;
  settings.step_in_voxels = kStep;
  const ViewInput in{scene.description, scene.volume, scene.features, solution, scene.lights, black, settings};
  const float n = static_cast<float>(voxels);
  Camera camera;
  camera.target = glm::vec3(0.5f * n);
  camera.position = camera.target + glm::vec3(0.4f, 0.3f, 2.0f) * n;
  camera.fov = 26.0f;
  camera.width = camera.height = 256;
  camera.samples = 1;

  reference::RayMedium medium = reference_medium(session, *device);
  medium.source = dense(*device, device->region_params[0].source_set, make_source_tiles(solution.volume, scene.volume, *device));
  const EntrySurfaces surfaces = entry_surfaces(scene.description, scene.volume, true);
  const Strip strip = SampleMaker(in, camera, surfaces, {device->frame}).strip(0, camera.height);
  const std::vector<reference::RayStart> rays = camera_rays(strip, medium, camera.position);

  ViewPass pass(session, in);
  ViewImage image;
  std::vector<float> radiance;
  std::int64_t steps = 0;
  std::vector<double> ours, theirs;
  for (int k = 0; k <= repeats; ++k) {
    const double kernel = kernel_seconds(session, "view", [&] { image = pass.look(camera); });
    const double reference = seconds_of([&] {
      steps = reference::gather_rays(medium, rays, kStep, settings.min_weight, session.device().compute_units, &radiance);
    });
    if (k == 0) continue;  // warms up
    ours.push_back(kernel);
    theirs.push_back(reference);
  }
  double squares = 0, all = 0;
  for (int i = 0; i < image.width * image.height; ++i) {
    const float* theirs_at = radiance.data() + 4 * strip.index(i % image.width, i / image.width);
    for (int c = 0; c < 3; ++c) {
      squares += std::pow(static_cast<double>(image.scattered[i][c]) - theirs_at[c], 2);
      all += std::pow(static_cast<double>(theirs_at[c]), 2);
    }
  }
  const double apart = std::sqrt(squares / all);
  Goal goal;
  goal.name = "view / own AVX-512";
  // The same rays: time against time.
  goal.ratio = ratio_of(theirs, ours, apart, kRadiancesAlike);
  goal.aim = 0.9;
  goal.ours = rate("view.cl", static_cast<double>(image.steps), spread_of(ours).median);
  goal.against = rate("C++, 16 rays in step", static_cast<double>(steps), spread_of(theirs).median);
  goal.error = difference("radiances (rel-L2)", apart);
  return goal;
}

}  // namespace

std::vector<Goal> measure_rays(cl::Session& session, int voxels, int repeats) {
  return {march_goal(session, voxels, repeats, false), march_goal(session, voxels, repeats, true),
          view_goal(session, voxels, repeats)};
}

}  // namespace turbid
