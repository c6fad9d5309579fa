// SPDX-License-Identifier: Apache-2.0
// The scene computed once more by other means, cheaply: on voxels twice as large, with other light rays, by a few
// photons. How far the answers lie apart is what the error estimate is made of.
#pragma once
#include <optional>
#include <vector>

#include "host/study/companion.h"
#include "host/study/scene_run.h"

namespace turbid {

/// Of two answers, relative.
struct Difference {
  double fluence = 0;  ///< relative_l2
  double image = 0;    ///< root_relmse of a small picture
  double through = 0;  ///< the same by surfaces seen through bodies alone; of `coarser` only
};

/// What a photon run's picture scatters by, as the root of relMSE: from a second, short run beside it.
double picture_scatter(cl::Session&, const SceneOnGrid&, const LightSolution&, ViewPass& of_it);

class CompanionRun {
 public:
  static constexpr int kTimes = 2;

  /// Computes the scene on voxels twice as large if the domain can be cut so and enough of them lie inside. `view`: of
  /// the run itself, if pictures count too; all are looked at in a few pixels. Keeps the other references.
  CompanionRun(cl::Session&, const SceneOnGrid&, const SampledFluence&, ViewPass* view);

  /// Root mean square share of the small picture that comes from inside media.
  double scattered() const { return scattered_; }
  /// How far the answer on voxels twice as large lies from the run's own; nothing if there is none.
  std::optional<Difference> coarser() const;
  /// How far other light rays change the answer on those voxels; nothing if there is none.
  std::optional<Difference> with(const MarchSettings&) const;
  /// How far the answers lie from radiative transfer in the same medium, by two runs of half the photons each, whose
  /// own scatter is taken out of the mean and put on top as two standard deviations: upper ends of what was measured.
  struct Transport {
    Difference apart;            ///< of the run's fluence, and of the small pictures
    double picture_scatter = 0;  ///< of a picture from one photon: that from N scatters by this / sqrt(N), on these
                                 ///< voxels, and by more in smaller ones
  };
  Transport from_transport(double photons) const;
  /// Edge of the voxels of its runs over that of the run itself.
  int times_as_large() const { return coarse_ ? kTimes : 1; }

 private:
  struct Answer {
    SampledFluence fluence;
    std::vector<float> picture, through;  ///< R, G, B: all light, surfaces seen through bodies; empty: none
  };

  Answer seen(const SceneOnGrid&, const LightSolution&) const;

  cl::Session& session_;
  const SceneOnGrid& in_;
  const SampledFluence& sampled_;
  mutable Progress quiet_{Verbosity::quiet};
  Camera camera_;
  std::vector<float> picture_, through_;  ///< of the run itself
  double scattered_ = 0;
  std::optional<SceneOnGrid> coarse_;
  std::optional<Answer> base_;
};

}  // namespace turbid
