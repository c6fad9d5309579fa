// SPDX-License-Identifier: Apache-2.0
// See photon_reference.h.
#include "host/study/photon_reference.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "host/base/errors.h"

namespace turbid {
namespace {

/// A photon caught between surfaces is given up after this many steps and counted as in flight: the solver's own limit
/// costs seconds for a few of them.
constexpr int kReferenceSteps = 1 << 16;

/// What is added to the standard deviation of a sum over voxels or pixels because one photon crosses many of them:
/// sqrt of how many fluctuate together.
constexpr double kCorrelated = 2;

SceneRun half(cl::Session& session, Scene scene, const ReferenceSettings& settings, int which, Verbosity talk) {
  PhotonSettings& photon = scene.solver.photon;
  scene.solver.solver = "photon";
  scene.solver.seed = settings.seed + static_cast<std::uint64_t>(which);
  photon.photons = std::max<std::int64_t>(1, static_cast<std::int64_t>(settings.photons / 2));
  photon.error = 0;
  photon.max_steps = std::min(photon.max_steps, kReferenceSteps);
  photon.checkpoint.clear();
  if (!settings.cache.empty()) {
    std::error_code error;
    std::filesystem::create_directories(settings.cache, error);
    const glm::ivec3 n = scene.medium.frame.voxels;
    photon.checkpoint = (std::filesystem::path(settings.cache) /
                         (scene.name + "-" + scene.hash + "-" + std::to_string(n.x) + "x" + std::to_string(n.y) + "x" +
                          std::to_string(n.z) + "-" + std::to_string(photon.photons) + "-" +
                          std::to_string(scene.solver.seed) + ".photons"))
                            .string();
  }
  return run_scene(session, std::move(scene), settings.picture, talk);
}

}  // namespace

PhotonReference photon_reference(cl::Session& session, Scene scene, const ReferenceSettings& settings, Verbosity talk) {
  SceneRun a = half(session, scene, settings, 0, talk), b = half(session, std::move(scene), settings, 1, talk);
  SampledFluence fluence_a = sample_fluence(a.solution.volume, a.on_grid.medium);
  SampledFluence fluence_b = sample_fluence(b.solution.volume, b.on_grid.medium);
  const double seconds = seconds_of(a.times, "photons") + seconds_of(b.times, "photons");
  return {std::move(a), std::move(b), std::move(fluence_a), std::move(fluence_b), seconds};
}

std::vector<float> mean_values(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> mean(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) mean[i] = 0.5f * (a[i] + b[i]);
  return mean;
}

ReferenceErrors errors_against(const std::vector<float>& x, const std::vector<float>& a, const std::vector<float>& b) {
  return errors_against(x, a, b, mean_values(a, b));
}

ReferenceErrors errors_against(const std::vector<float>& x, const std::vector<float>& a, const std::vector<float>& b,
                               const std::vector<float>& exact) {
  if (x.size() != a.size() || x.size() != b.size() || x.size() != exact.size())
    throw std::invalid_argument("errors_against: lists differ");
  ReferenceErrors errors;
  errors.values = x.size();
  double absolute = 0, sum = 0, squared = 0, difference = 0, spread = 0, scatter = 0, largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double m = 0.5 * (double(a[i]) + double(b[i])), d = double(x[i]) - m;
    absolute += std::abs(d);
    sum += std::abs(m);
    largest = std::max(largest, std::abs(m));
    errors.linf = std::max(errors.linf, std::abs(d));
    squared += double(a[i]) * double(b[i]);
    const double product = (double(x[i]) - a[i]) * (double(x[i]) - b[i]);
    difference += product;
    spread += product * product;
    scatter += 0.25 * (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
  }
  if (!(sum > 0 && squared > 0)) return errors;
  const double floor = std::pow(0.1 * sum / static_cast<double>(x.size()), 2);
  double relative = 0, relative_spread = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double product =
        (double(x[i]) - a[i]) * (double(x[i]) - b[i]) / (double(exact[i]) * double(exact[i]) + floor);
    relative += product;
    relative_spread += product * product;
  }
  errors.rel_l1 = absolute / sum;
  errors.linf /= largest;
  errors.rel_l2 = std::sqrt(std::max(difference, 0.0) / squared);
  errors.relmse = std::max(relative, 0.0) / static_cast<double>(x.size());
  errors.rel_l2_spread = kCorrelated * std::sqrt(spread) / squared;
  errors.relmse_spread = kCorrelated * std::sqrt(relative_spread) / static_cast<double>(x.size());
  errors.noise = std::sqrt(scatter / squared);
  return errors;
}

ReferenceErrors fluence_errors(const SampledFluence& x, const PhotonReference& reference) {
  const auto values = common_values(x, {&reference.fluence_a, &reference.fluence_b});
  return errors_against(values[0], values[1], values[2]);
}

ReferenceErrors fluence_errors_as_seen(const SampledFluence& x, const PhotonReference& reference) {
  const auto values = interpolated_values(x, {&reference.fluence_a, &reference.fluence_b});
  return errors_against(values[0], values[1], values[2]);
}

std::vector<float> rgb_values(const ViewImage& image) {
  std::vector<float> values;
  values.reserve(3 * image.colour.size());
  for (const glm::vec4& pixel : image.colour) values.insert(values.end(), {pixel.x, pixel.y, pixel.z});
  return values;
}

ReferenceErrors image_errors(const ViewImage& x, const PhotonReference& reference) {
  return errors_against(rgb_values(x), rgb_values(*reference.a.image), rgb_values(*reference.b.image));
}

}  // namespace turbid
