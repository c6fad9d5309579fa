// SPDX-License-Identifier: Apache-2.0
// Small bodies under light, spread over everything that makes diffusion good or bad: what the error estimate is
// calibrated on, and others, drawn separately, that it is tested on.
#pragma once
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace turbid {

enum class TrialSet {
  calibration,  ///< the constants of error_estimate.cpp are held against these
  held_out,     ///< no constant was chosen by looking at these
};

struct TrialBody {
  std::string name;  ///< "held_out 7: two balls, depth 0.31, albedo 0.8, eta 1.5, g -0.5, spot"
  Scene scene;
};

/// 60 bodies of 32 voxels in a picture of 40 x 40 pixels. Each is a ball, box, slab, core in a clear or a scattering
/// shell, two balls, ball around a void, filled domain or lens of graded index; of transport depth .1 to 30 (over the
/// mean chord), albedo .3 to 1, index 1, 1.33 or 1.5, g 0, .8 or -.5, even or with a coefficient field; lit by a spot,
/// the sun, a lamp outside or inside, or by its own glow. Every property is shuffled by itself so that a set holds each
/// of its values equally often; the two sets differ in the seed. Grey, so that photons tell as much as they can.
std::vector<TrialBody> trial_bodies(TrialSet);

}  // namespace turbid
