// SPDX-License-Identifier: Apache-2.0
// A scene solved by many settings, each against one photon reference: speed against error, measured.
#pragma once
#include <functional>

#include "host/study/pareto.h"
#include "host/study/photon_reference.h"

namespace turbid {

struct ParetoSettings {
  ReferenceSettings reference;
  bool picture = false;
};

struct ParetoStudy {
  std::vector<SettingRun> runs;  ///< efficient ones marked
  double noise = 0;              ///< of the reference: errors below it are not resolved
  double photon_error = 0;       ///< scatter of one photon run, relative L2,
  double photon_seconds = 0;     ///< its time: others follow by 1 / sqrt(time),
  double photons = 0;            ///< and how many it followed
};

/// Voxels of the scene's size, twice and four times as large (where the domain can be cut so); few and many rays and
/// steps; loose and tight solves; steady, lattice and photon.
ParetoStudy pareto_study(cl::Session&, const Scene&, const ParetoSettings&,
                         const std::function<void(const std::string&)>& tell);

/// One scene against photons, by one solver: a line of the README's table.
struct AccuracyRow {
  std::string scene, solver;
  double fluence = 0, noise = 0;                    ///< relative L2, and the reference's scatter
  double relmse = 0;                                ///< of the picture; NaN without a camera
  double reflected = 0, escaped = 0, absorbed = 0;  ///< difference, share of the light that met the medium [-]
  double seconds = 0;                               ///< voxelising, solving and view
  double time_ratio = 0;                            ///< photon's time to the same fluence error / seconds
};
std::vector<AccuracyRow> accuracy_rows(cl::Session&, Scene, const ReferenceSettings&,
                                       const std::function<void(const std::string&)>& tell);

}  // namespace turbid
