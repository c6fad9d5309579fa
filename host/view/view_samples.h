// SPDX-License-Identifier: Apache-2.0
// A camera's samples: what each pixel sees first, from a rasterised picture of the bodies' surfaces.
#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "host/raster/pixel_hit.h"
#include "host/transport/light_rays.h"
#include "host/view/view_pass.h"
#include "kernels/shared/view_params.h"

namespace turbid {

inline constexpr float kFarAway = 1e10f;  ///< depth of a sample that hits nothing

inline void copy(glm::vec3 from, float (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

/// The frame's voxel coordinates of scene points.
struct VoxelSpace {
  GridFrame frame;
  glm::vec3 point(glm::vec3 x) const { return (x - frame.origin) / frame.voxel_size; }
};

/// The samples of a strip of rows, and what the host knows of their first hits. They stand in squares of 8 x 8 pixels, all of
/// a pixel's samples together: rays that follow each other meet the same tiles of the medium.
struct Strip {
  static constexpr int kSquare = 8;
  int width = 0, rows = 0, per_pixel = 1;
  /// Of a pixel's first sample; `row` within the strip.
  std::size_t index(int x, int row) const {
    const int top = row / kSquare * kSquare, left = x / kSquare * kSquare;
    const int height = std::min(kSquare, rows - top), edge = std::min(kSquare, width - left);
    return static_cast<std::size_t>(per_pixel) * (top * width + left * height + (row - top) * edge + (x - left));
  }
  std::vector<ViewSample> samples;
  std::vector<float> depth;        // per sample
  std::vector<glm::vec3> normal;
  std::vector<float> coverage;
};

class SampleMaker {
 public:
  /// Finds the first hits. Keeps references to the input and the camera.
  SampleMaker(const ViewInput&, const Camera&, const EntrySurfaces&, const VoxelSpace&);
  int grid() const { return grid_; }  ///< samples along a pixel's edge

  /// Samples of pixel rows [first, last).
  Strip strip(int first, int last) const;

 private:
  void add(int x, int y, std::size_t to, Strip* out) const;
  void start_at(glm::vec3 hit, glm::vec3 direction, int region, glm::vec3 normal, ViewSample* sample) const;
  float ground_distance(glm::vec3 eye, glm::vec3 direction) const;

  const ViewInput& in_;
  const Camera& camera_;
  VoxelSpace space_;
  int grid_;
  RasterView view_;
  FirstHits own_hits_;  ///< where the input keeps none
  const RasterImage* image_ = nullptr;  ///< null: there are no surfaces
  std::optional<PixelRays> rays_;
  bool ambient_ = false;
  int camera_region_ = -1;
};

}  // namespace turbid
