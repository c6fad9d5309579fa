// SPDX-License-Identifier: Apache-2.0
// Owners of what the rasteriser needs from OSMesa: a current off-screen context, and in it a target of 32-bit triangle
// numbers with a 32-bit float depth, and the one program that fills it. Internal to host/raster.
#pragma once
#include <GL/osmesa.h>

#include <cstdint>
#include <span>
#include <vector>

namespace turbid {

/// An OpenGL 3.3 core context with ARB_clip_control, current on this thread from construction to destruction.
/// Throws DeviceError if there is none.
class OsmesaContext {
 public:
  OsmesaContext();
  ~OsmesaContext();
  OsmesaContext(const OsmesaContext&) = delete;
  OsmesaContext& operator=(const OsmesaContext&) = delete;

 private:
  OSMesaContext context_ = nullptr;
  std::vector<unsigned char> window_;  ///< OSMesa wants a default framebuffer; nothing is drawn to it
};

/// Draws triangles given in clip coordinates and keeps the number of the nearest one per pixel.
/// Depth is reversed (1 near, 0 far, clip z in [0, w]), where 32-bit floats resolve relative distances evenly.
class NumberTarget {
 public:
  NumberTarget(const OsmesaContext&, int width, int height);
  ~NumberTarget();
  NumberTarget(const NumberTarget&) = delete;
  NumberTarget& operator=(const NumberTarget&) = delete;

  /// Largest width and height that the driver can draw at once.
  static int largest_size(const OsmesaContext&);
  void clear(int width, int height);
  /// x y z w per corner, three corners per triangle; the triangles are numbered from `first`, which is >= 1.
  void draw(std::span<const float> corners, std::uint32_t first);
  /// The triangle numbers of the lower left width x height pixels, rows from clip y = -1 upwards, 0 where nothing is.
  void read(int width, int height, std::uint32_t* numbers);

 private:
  unsigned framebuffer_ = 0, colour_ = 0, depth_ = 0, program_ = 0, vertices_ = 0, layout_ = 0;
  int first_ = -1;  ///< location of the uniform `first`
};

}  // namespace turbid
