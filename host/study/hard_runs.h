// SPDX-License-Identifier: Apache-2.0
// Complete runs of extreme media and what each must keep: it ends, every watt is found again, the fluence is finite
// and, but for the tolerance of the solve, not negative. Private to host/study.
#pragma once
#include <string>
#include <vector>

#include "host/study/case.h"
#include "host/study/small_media.h"

namespace turbid::study {

struct HardScene {
  MediumDescription medium;
  LightList lights;
};

/// Settings of solver "steady", "lattice" or "photon"; the lattice to 1e-3, which ends everywhere within seconds.
SolverSettings hard_settings(const std::string& solver, std::int64_t photons = 20000);

/// One run with its promises checked; `name` says in the checks which run it was.
struct HardRun {
  Run run;
  std::vector<std::string> warnings;  ///< of the survey of the medium and of the run itself
};
HardRun run_hard(CaseContext&, CaseResult&, const std::string& name, const HardScene&, const SolverSettings&);
/// By "steady" and, as a check of its promises alone, by "lattice": returns the former.
HardRun run_both(CaseContext&, CaseResult&, const std::string& name, const HardScene&);

/// Checks that one of a run's warnings holds `part`, and prints it.
void must_warn(CaseResult&, const std::string& name, const std::vector<std::string>& warnings, const std::string& part);

/// Power that met the medium, colour 0 [W]; the shares below are of it.
double entered(const Run&);
double escaped_share(const Run&);
double face_share(const Run&, int face);
/// Standard error of a photon run's share through a face.
double face_error(const Run&, int face);

/// A domain of 8 x 8 x n voxels of edge `voxel_size`, periodic along x and y, open along z, filled with one material,
/// under light along `direction` (default: +z).
HardScene lit_slab(int n, float voxel_size, const Material&, glm::vec3 direction = {0, 0, 1});
/// "1e-04" as "0.0001": names of runs.
std::string short_number(double value);

}  // namespace turbid::study
