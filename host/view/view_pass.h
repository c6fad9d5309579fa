// SPDX-License-Identifier: Apache-2.0
// Turns a light solution into a picture: first hits by rasterising, then the view kernel per sample.
#pragma once
#include "host/base/progress.h"
#include "host/cl/session.h"
#include "host/scene/camera.h"
#include "host/scene/features.h"
#include "host/scene/light.h"
#include "host/scene/settings.h"
#include "host/transport/solver.h"
#include "host/view/image.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// Everything that a picture depends on.
struct ViewInput {
  const MediumDescription& description;
  const MediumVolume& medium;
  const SceneFeatures& features;
  const LightSolution& solution;
  const LightList& lights;
  const Camera& camera;
  const Surroundings& surroundings;
  const ViewSettings& settings;
};

ViewImage render_view(cl::Session&, const ViewInput&, Progress&);

}  // namespace turbid
