// SPDX-License-Identifier: Apache-2.0
// Which of the stages from scene to picture a change of the scene makes necessary again.
#pragma once
#include "host/scene/scene.h"

namespace turbid {

/// The first stage to do again; all that stand before it in this list follow it.
enum class Redo {
  nothing,
  tone,     ///< radiance to screen colours: exposure
  look,     ///< camera rays: the camera
  gather,   ///< what all cameras share: background, how rays gather
  light,    ///< march and solve: lights
  prepare,  ///< the medium on the device and the operators: ground
  medium,   ///< coefficients on the grid: materials
  all,      ///< the grid itself
};

/// By comparing the effective scenes table by table.
Redo redo_for(const Scene& before, const Scene& after);

}  // namespace turbid
