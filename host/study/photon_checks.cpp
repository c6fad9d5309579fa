// SPDX-License-Identifier: Apache-2.0
// See photon_checks.h.
#include "host/study/photon_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/study/infinite_medium.h"
#include "host/study/photon_runs.h"

namespace turbid::study {
namespace {

constexpr glm::vec3 kCentre(3.5f, 3.5f, 0);  // of the face that slabs are lit through

Material milk(float sigma_s, float sigma_a, float eta = 1) {
  return make_material({.sigma_s = glm::vec3(sigma_s), .sigma_a = glm::vec3(sigma_a), .eta = eta});
}

}  // namespace

void check_slab_photons(CaseContext& context, CaseResult& result) {
  const PhotonAnswer answer = follow(context.session, slab(16, 0.625f, milk(1, 0)), photons(context.photons_or(80000)),
                                     {source(TURBID_SOURCE_LAMBERT, kCentre)});
  const Estimate& back = answer.tallies().escaped_faces[4];
  const Estimate& through = answer.tallies().escaped_faces[5];
  result.absolute("T, photons", 4.0 / 3 / (10 + 2 * 0.710446), through.value.x, 0,
                  "Milne's problem from either side, exact up to e^-10", "1", through.error.x);
  result.absolute("R + T, photons", 1, back.value.x + through.value.x, 1e-12, "nothing is absorbed; integer sums");
  result.note_imbalance(answer.solution.report.energy.imbalance());
}

void check_layer_photons(CaseContext& context, CaseResult& result) {
  const double expected[2] = {0.15488, 0.06888};
  for (const int reversed : {0, 1}) {
    MediumDescription scene = slab(32, 0.3125f, milk(1, 0, reversed ? 1.5f : 1.0f));
    add_body(scene, make_box({100, 100, 10}, at({0, 0, 10})), milk(1, 0, reversed ? 1.0f : 1.5f));
    const PhotonAnswer answer =
        follow(context.session, scene, photons(context.photons_or(80000)), {source(TURBID_SOURCE_LAMBERT, kCentre)});
    const Estimate& through = answer.tallies().escaped_faces[5];
    result.absolute(reversed ? "T, 1.5 | 1, photons" : "T, 1 | 1.5, photons", expected[reversed], through.value.x, 0,
                    "independent Monte Carlo program", "1", std::hypot(through.error.x, 0.00008));
    result.note_imbalance(answer.solution.report.energy.imbalance());
  }
}

void check_sphere_photons(CaseContext& context, CaseResult& result, bool glass) {
  MediumDescription scene = empty_domain(glm::ivec3(32), 2.2f / 32, FaceBoundary::open, true);
  add_body(scene, make_sphere(1, {}), milk(9.9f, 0.1f, glass ? 1.5f : 1.0f));
  const PhotonAnswer answer =
      follow(context.session, scene, photons(context.photons_or(100000)), LightList{point_light({0, 0, 0})});
  const Estimate& escaped = answer.tallies().escaped;
  result.absolute("escape, photons", glass ? 0.53433 : 0.59712, escaped.value.x, 1e-4,
                  "independent Monte Carlo program; the sampled radius may be off by a few 1e-3 of a voxel", "1",
                  std::hypot(escaped.error.x, 0.00005));
  result.note_imbalance(answer.solution.report.energy.imbalance());
}

namespace {

/// Transport's fluence at albedo .9, tabulated: evaluated anew for every point of every voxel it would take minutes.
class PointSource {
 public:
  PointSource() {
    for (int i = 0; i < kSteps; ++i) logs_.push_back(std::log(point_source_fluence(0.9, at(i))));
  }
  double fluence(double r) const {
    const double place = (r - kFirst) / kStep;
    const int i = std::clamp(static_cast<int>(place), 1, kSteps - 3);
    const double t = place - i, *y = logs_.data() + i;
    // Cubic through four points.
    return std::exp(y[0] + 0.5 * t *
                               (y[1] - y[-1] +
                                t * (2 * y[-1] - 5 * y[0] + 4 * y[1] - y[2] + t * (3 * (y[0] - y[1]) + y[2] - y[-1]))));
  }

 private:
  static constexpr double kFirst = 1, kStep = 0.02;
  static constexpr int kSteps = 400;
  static double at(int i) { return kFirst + kStep * i; }
  std::vector<double> logs_;
};

/// Mean over a voxel of edge h whose centre lies at x, by three Gauss points per axis.
double voxel_mean(const PointSource& source, glm::dvec3 x, double h) {
  const double places[3] = {-std::sqrt(0.15), 0, std::sqrt(0.15)}, weights[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double sum = 0;
  for (int i = 0; i < 27; ++i) {
    const int a = i % 3, b = i / 3 % 3, c = i / 9;
    sum += weights[a] * weights[b] * weights[c] *
           source.fluence(glm::length(x + h * glm::dvec3(places[a], places[b], places[c])));
  }
  return sum;
}

}  // namespace

void check_point_photons(CaseContext& context, CaseResult& result) {
  // Voxels of half a mean free path whose centres lie in a shell, against the exact mean over the same voxels. The
  // domain ends after 16 mean free paths, 9 beyond the last shell: what would come back from there is e^-9 of its
  // fluence. Independent seeds give the standard errors of the shells' means.
  constexpr int kSeeds = 12, kVoxels = 64;
  constexpr double h = 0.5;
  const PointSource exact;
  double mean[3][kSeeds] = {}, expected[3] = {}, count[3] = {};
  for (int seed = 0; seed < kSeeds; ++seed) {
    MediumDescription scene = empty_domain(glm::ivec3(kVoxels), static_cast<float>(h), FaceBoundary::open, true);
    set_ambient(scene, milk(0.9f, 0.1f));
    const PhotonAnswer answer = follow(
        context.session, scene, photons(context.photons_or(180000) / kSeeds, 100 + static_cast<unsigned>(seed), 2),
        LightList{point_light({0, 0, 0})});
    result.note_imbalance(answer.solution.report.energy.imbalance());
    for (std::size_t i = 0; i < answer.region.size(); ++i) {
      const glm::dvec3 x = h * (glm::dvec3(answer.voxel(i) - kVoxels / 2) + 0.5);
      const int shell = static_cast<int>(glm::length(x));
      if (shell != 2 && shell != 4 && shell != 6) continue;
      const int k = shell / 2 - 1;
      mean[k][seed] += answer.fluence(i);
      if (seed > 0) continue;
      expected[k] += voxel_mean(exact, x, h);
      count[k] += 1;
    }
  }
  for (int k = 0; k < 3; ++k) {
    double sum = 0, square = 0;
    for (double value : mean[k]) {
      value /= count[k];
      sum += value / kSeeds;
      square += value * value / kSeeds;
    }
    result.relative("fluence at " + std::to_string(2 * k + 2) + " to " + std::to_string(2 * k + 3) + " mfp, photons",
                    expected[k] / count[k], sum, 0, "exact transport, mean over the same voxels", "1/mfp^2",
                    std::sqrt((square - sum * sum) / (kSeeds - 1)));
  }
}

void check_unscattered_photons(CaseContext& context, CaseResult& result) {
  for (const float g : {0.0f, 0.8f}) {
    MediumDescription scene =
        slab(16, 0.125f, make_material({.sigma_s = glm::vec3(0.8f), .sigma_a = glm::vec3(0.2f), .g = g}));
    const PhotonAnswer answer =
        follow(context.session, scene, photons(context.photons_or(60000)), {source(TURBID_SOURCE_RAY, kCentre)});
    const Estimate& through = answer.tallies().unscattered_faces[5];
    result.absolute(g > 0 ? "unscattered T, g = .8" : "unscattered T", std::exp(-2.0), through.value.x, 0,
                    "Beer and Lambert over two mean free paths", "1", through.error.x);
    result.note_imbalance(answer.solution.report.energy.imbalance());
  }
}

void check_fresnel_photons(CaseContext& context, CaseResult& result) {
  // A plate of glass in light from outside: the first reflection is exact, the sum over all inner ones is sampled.
  for (const int degrees : {0, 50, 75}) {
    MediumDescription scene = slab(16, 1, milk(0, 0));
    add_body(scene, make_box({100, 100, 6}, at({4, 4, 8})), milk(0, 0, 1.5f));
    const double angle = degrees * std::numbers::pi / 180, c = std::cos(angle),
                 t = std::sqrt(1 - std::pow(std::sin(angle) / 1.5, 2));
    const double s = (c - 1.5 * t) / (c + 1.5 * t), p = (t - 1.5 * c) / (t + 1.5 * c), r = 0.5 * (s * s + p * p);
    PhotonSource entering = source(TURBID_SOURCE_ENTERING, {4, 4, 5}, {std::sin(angle), 0, std::cos(angle)}, 1);
    entering.normal[0] = 0;
    entering.normal[2] = -1;
    entering.grace = 1.5f;
    const PhotonAnswer answer = follow(context.session, scene, photons(context.photons_or(40000)), {entering});
    const PhotonTallies& found = answer.tallies();
    const std::string where = " of a plate at " + std::to_string(degrees) + " degrees";
    result.absolute("first reflection" + where, r, found.reflected.value.x, 1e-5, "single precision");
    result.absolute("T" + where, (1 - r) / (1 + r), found.escaped_faces[5].value.x, 0, "(1 - R)^2 / (1 - R^2)", "1",
                    found.escaped_faces[5].error.x);
    result.absolute("R + T" + where, 1,
                    found.reflected.value.x + found.escaped_faces[4].value.x + found.escaped_faces[5].value.x, 1e-12,
                    "nothing absorbs; integer sums");
    result.note_imbalance(answer.solution.report.energy.imbalance());
  }
}

}  // namespace turbid::study
