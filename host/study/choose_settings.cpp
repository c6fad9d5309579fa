// SPDX-License-Identifier: Apache-2.0
// See choose_settings.h.
#include "host/study/choose_settings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace turbid {
namespace {

constexpr double kGridOrder = 1.5;
constexpr int kLeastVoxels = 32;
constexpr float kLeastRays = 4, kMostRays = 64, kLongestStep = 0.5f, kShortestStep = 0.05f;  // fewer show as noise

/// What the parameter must shrink by so that a part shrinks to `share`; 1e9 where the part is zero.
double room(double share, double part) {
  return part > 0 ? share / part : 1e9;
}

ErrorParts predict(const ErrorParts& e, const Resolution& of, const Resolution& with) {
  ErrorParts p = e;
  p.grid *= std::pow(double(of.voxels) / with.voxels, kGridOrder);
  p.steps *= std::pow(double(with.step) / of.step, 2);
  p.rays *= double(of.rays) / with.rays;
  p.solve *= double(with.tolerance) / of.tolerance;
  return p;
}

}  // namespace

ChosenSettings choose_settings(const ErrorParts& estimate, double scatter_of_one, const Resolution& of, double aim) {
  ChosenSettings chosen;
  const double left = aim - estimate.model;
  // Less than a quarter of the aim left would ask for a grid that costs more than photons do.
  chosen.photon = left < 0.25 * aim;
  const double budget = chosen.photon ? aim : left;
  const double voxels = of.voxels * std::pow(room(0.5 * budget, estimate.grid), -1 / kGridOrder);
  chosen.with.voxels = std::clamp(static_cast<int>(std::ceil(voxels / 8)) * 8, kLeastVoxels, kMostVoxels);
  chosen.with.step =
      std::clamp(of.step * float(std::sqrt(room(0.1 * budget, estimate.steps))), kShortestStep, kLongestStep);
  chosen.with.rays = std::clamp(of.rays / float(room(0.1 * budget, estimate.rays)), kLeastRays, kMostRays);
  chosen.with.tolerance = std::clamp(float(0.1 * budget), 1e-6f, 0.01f);
  chosen.predicted = predict(estimate, of, chosen.with);
  const double scatter = scatter_of_one * chosen.with.voxels / of.voxels;
  chosen.photons = std::clamp(std::pow(scatter / (0.5 * aim), 2), kLeastPhotons, kMostPhotons);
  char text[256];
  if (chosen.photon)
    std::snprintf(text, sizeof text,
                  "diffusion is estimated to be wrong by %.2g here, which leaves too little of %.2g: photons instead",
                  estimate.model, aim);
  else
    std::snprintf(text, sizeof text,
                  "at %d voxels the grid's part is %.2g of %.2g, and diffusion's own %.2g; predicted in all %.2g",
                  of.voxels, estimate.grid, estimate.total(), estimate.model, chosen.predicted.total());
  chosen.reason = text;
  return chosen;
}

}  // namespace turbid
