// SPDX-License-Identifier: Apache-2.0
// Turns a light solution into a picture: first hits by rasterising, then the view kernel per sample.
#pragma once
#include <functional>
#include <memory>

#include "host/base/progress.h"
#include "host/cl/session.h"
#include "host/scene/camera.h"
#include "host/scene/features.h"
#include "host/scene/light.h"
#include "host/scene/settings.h"
#include "host/transport/solver.h"
#include "host/view/first_hits.h"
#include "host/view/image.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// Everything that a picture depends on besides the camera. A ViewPass keeps these references.
struct ViewInput {
  const MediumDescription& description;
  const MediumVolume& medium;
  const SceneFeatures& features;
  const LightSolution& solution;
  const LightList& lights;
  const Surroundings& surroundings;
  const ViewSettings& settings;
  FirstHits* first_hits = nullptr;  ///< of earlier pictures of this medium; null: none are kept
};

/// A light solution made ready to be looked at, on the device: what all cameras share is computed and uploaded once.
class ViewPass {
 public:
  ViewPass(cl::Session&, const ViewInput&);
  ~ViewPass();
  ViewPass(ViewPass&&) noexcept;
  /// `progress(fraction)` is called between strips of rows and may throw to stop; the pass can be used again then.
  ViewImage look(const Camera&, const std::function<void(double)>& progress = {});

 private:
  struct Prepared;
  std::unique_ptr<Prepared> prepared_;
};

/// Both in one, as stage "view".
ViewImage render_view(cl::Session&, const ViewInput&, const Camera&, Progress&);

}  // namespace turbid
