// SPDX-License-Identifier: Apache-2.0
// The same scene on coarser or finer voxels whose faces coincide, and how far two such fluences lie apart.
#pragma once
#include <functional>
#include <optional>

#include "host/scene/scene.h"
#include "host/study/total_fluence.h"

namespace turbid {

/// The scene on voxels `times` as large that the finer ones divide; nothing if the domain can't be cut so: open axes
/// grow to whole blocks where nothing fills the domain and no body sticks out of it, others must hold whole blocks
/// already.
std::optional<Scene> coarser_scene(const Scene&, int times);
/// The same, but with as many voxels as before where the domain can grow to them: kernels, which are compiled for a
/// number of voxels, are at hand then. Blocks in which nothing is cost nothing.
std::optional<Scene> coarser_scene_of_same_size(const Scene&, int times);
/// The scene on voxels `times` as small over exactly the same domain.
Scene finer_scene(const Scene&, int times);

/// Total fluence on its voxels, with who is active.
struct SampledFluence {
  FluenceVolume total;
  std::vector<LocalMedium> media;
};
SampledFluence sample_fluence(const FluenceVolume&, const MediumVolume&);

/// Values colour by colour at the voxels of `coarse` of whose finer voxels (those of every one of `fine`) at least this
/// share is active: the fluence of `coarse` first, then the mean of each of `fine` over its active ones. Each grid is a
/// whole number of times finer than the coarse one, or as fine, and aligned with it; it may reach further. Throws
/// std::invalid_argument if one is not.
std::vector<std::vector<float>> common_values(const SampledFluence& coarse,
                                              const std::vector<const SampledFluence*>& fine, double least_share = 1);

/// Values colour by colour at the voxels of `fine` that are active in each of them: the fluence of `coarse`,
/// interpolated trilinearly between its active voxels, 0 where none is near; then that of each of `fine`, which share
/// one grid. The grids fit as for common_values.
std::vector<std::vector<float>> interpolated_values(const SampledFluence& coarse,
                                                    const std::vector<const SampledFluence*>& fine);

}  // namespace turbid
