// SPDX-License-Identifier: Apache-2.0
// What the samples of a camera see first, kept for its next picture: only the bodies and the camera decide it, not the
// light.
#pragma once
#include <list>
#include <span>

#include "host/raster/raster.h"

namespace turbid {

class FirstHits {
 public:
  /// Rasterises only a view that is not among the last two: a preview is a coarse picture and a fine one in turns.
  /// Between two calls the meshes' shapes must not change. The answer holds until the next call.
  const RasterImage& of(std::span<const RasterMesh> meshes, const RasterView& view);
  void clear() { kept_.clear(); }

 private:
  struct Kept {
    RasterView view;
    RasterImage image;
  };
  std::list<Kept> kept_;  ///< latest first
};

}  // namespace turbid
