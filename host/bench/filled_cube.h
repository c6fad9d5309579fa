// SPDX-License-Identifier: Apache-2.0
// The cube whose every voxel is filled (scenes/bubbly_cube.toml), with which the paper's experiments are repeated.
#pragma once
#include <string>
#include <vector>

#include "host/bench/experiment.h"
#include "host/scene/scene.h"

namespace turbid {

inline constexpr double kMostSeconds = 40;  ///< of one experiment's repeated rounds

inline std::string filled_cube(const BenchSettings& settings) {
  return settings.scene("bubbly_cube.toml");
}

inline int cube_resolution(const BenchSettings& settings) {
  return settings.quick ? 32 : 128;
}

/// At the size of the experiments, by solver "lattice"; `more` settings come last.
inline SceneOverrides cube_overrides(const BenchSettings& settings, const std::vector<std::string>& more = {}) {
  SceneOverrides overrides;
  overrides.resolution = cube_resolution(settings);
  overrides.solver = "lattice";
  if (settings.quick) overrides.settings = {"camera.width=128", "camera.height=128"};
  overrides.settings.insert(overrides.settings.end(), more.begin(), more.end());
  return overrides;
}

}  // namespace turbid
