// SPDX-License-Identifier: Apache-2.0
// The table of what can be refined in a scene. See refine_scene.h.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/base/errors.h"
#include "host/study/refine_scene.h"

namespace turbid {

const std::vector<SceneParameter>& scene_parameters() {
  static const std::vector<SceneParameter> all{
      {"voxel_size",
       "voxels along the longest side",
       "scene unit",
       true,
       2,
       1.0,
       "edges, ends of light cones and point lights are met to first order only",
       {}},
      {"step", "voxels", "voxels", false, 2, 1.5, "the fit's scatter", {1.0, 0.5, 0.25}},
      {"rays",
       "rays per voxel face",
       "1/sqrt(rays per face)",
       true,
       2,
       1.0,
       "the grid of rays falls on the grid of voxels irregularly",
       {1, 4, 16}},
      {"tolerance", "1", "1", false, 0, 0, "conjugate gradients end after whole steps", {1e-1, 1e-2, 1e-3, 1e-4}},
      {"photons", "photons", "1/sqrt(photons)", true, 1, 0.7, "two levels' scatter", {1e5, 4e5, 1.6e6}},
      {"block", "voxels", "voxels", true, 0, 0, "the steady state does not depend on it", {4, 8}},
      {"inner", "steps", "steps", true, 0, 0, "the steady state does not depend on it", {2, 4, 8, 16}},
      {"solver", "0 steady, 1 lattice", "1", true, 0, 0, "both have one steady state", {0, 1}},
  };
  return all;
}

const SceneParameter& find_scene_parameter(const std::string& name) {
  std::string names;
  for (const SceneParameter& parameter : scene_parameters()) {
    if (parameter.name == name) return parameter;
    names += (names.empty() ? "" : ", ") + parameter.name;
  }
  throw InputError("--over " + name + ": no such parameter; there are " + names);
}

void check_levels(const SceneParameter& parameter, const std::vector<double>& levels) {
  const auto fail = [&](const std::string& expected) {
    std::string found;
    for (const double level : levels) {
      char text[32];
      std::snprintf(text, sizeof text, "%g", level);
      found += (found.empty() ? "" : ",") + std::string(text);
    }
    throw InputError("--levels " + found + ": expected " + expected);
  };
  if (levels.size() < 2) fail("two or more, from coarse to fine, with commas between");
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double level = levels[i];
    const bool whole = parameter.name == "voxel_size" || parameter.name == "inner" ||
                       parameter.name == "photons" || parameter.name == "block" || parameter.name == "solver";
    if (!std::isfinite(level) || (whole && level != std::floor(level)))
      fail("whole numbers of " + parameter.level_unit);
    if (parameter.name == "voxel_size" && level < 8) fail("8 voxels along the longest side or more");
    if (parameter.name == "block" && level != 4 && level != 8) fail("4,8");
    if (parameter.name == "solver" && level != 0 && level != 1) fail("0,1");
    if (parameter.name == "step" && !(level > 0 && level <= 2)) fail("steps in (0, 2] voxels");
    if (parameter.name == "rays" && !(level > 0 && level <= 64)) fail("rays per face in (0, 64]");
    if (parameter.name == "tolerance" && !(level >= 1e-6 && level <= 0.1)) fail("tolerances in [1e-6, 0.1]");
    if ((parameter.name == "inner" || parameter.name == "photons") && !(level >= 1 && level <= 1e12)) fail("1 or more");
    if (i > 0 && (parameter.rising ? level <= levels[i - 1] : level >= levels[i - 1]))
      fail(std::string("levels from coarse to fine: ") + (parameter.rising ? "rising" : "falling") + " " +
           parameter.name + " [" + parameter.level_unit + "]");
  }
}

}  // namespace turbid
