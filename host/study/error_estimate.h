// SPDX-License-Identifier: Apache-2.0
// How wrong a run is, estimated by the run itself, with its parts named.
//
// Of the fluence: sqrt(sum (phi - exact)^2 / sum exact^2) over all voxels that scatter or emit and all colours, phi the
// total fluence as in `turbid solve`'s file: what `turbid compare A.vdb EXACT.vdb --grid fluence --measure rel-l2`
// says. Voxels that scatter less than 1 % of the strongest are left out, see local_media. Of the picture: the root of
// its relMSE, what `turbid compare A.exr EXACT.exr` prints, squared: how far off a pixel is. Exact is radiative
// transfer in the scene's medium. The parts add up: they are bounds that may pull the same way.
#pragma once
#include <optional>
#include <string>

#include "host/study/scene_run.h"

namespace turbid {

struct ErrorParts {
  double grid = 0;   ///< voxels of finite size: the deposit, the diffusion, surfaces
  double steps = 0;  ///< of the marching rays and, in pictures, of the gathering ones
  double rays = 0;   ///< a finite number of light rays; of the photon solver: its standard error
  double solve = 0;  ///< the iteration stopped
  double model = 0;  ///< diffusion in place of radiative transfer; none with the photon solver
  double total() const { return grid + steps + rays + solve + model; }
};

struct ErrorEstimate {
  ErrorParts fluence;
  std::optional<ErrorParts> image;  ///< if there is a picture
  std::string basis;                ///< one clause: where the grid's part comes from
  double scatter_of_one = 0;  ///< a photon run's picture on these voxels would scatter by this / sqrt(photons); 0:
                              ///< not measured
  double seconds = 0;         ///< what the estimate took [s]
};

/// By the effort that the scene's [solver] error_estimate asks for; nothing if that is "off". `view`: of the solution,
/// if the error of the picture is wanted too; else null. Stage "estimate".
std::optional<ErrorEstimate> estimate_error(cl::Session&, const SceneOnGrid&, const LightSolution&, ViewPass* view,
                                            Progress&);

}  // namespace turbid
