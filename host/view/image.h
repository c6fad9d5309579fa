// SPDX-License-Identifier: Apache-2.0
// Pictures on disk: linear EXR with layers and metadata, sRGB PNG previews. The only user of OpenImageIO.
#pragma once
#include <glm/glm.hpp>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace turbid {

/// What the view pass computes. Row 0 is the top row, x fastest, linear radiance [W/(scene unit^2 sr)].
struct ViewImage {
  int width = 0, height = 0;
  std::vector<glm::vec4> colour;     ///< R, G, B, A: direct + scattered; A is the coverage by objects and ground
  std::vector<glm::vec3> direct;     ///< light from surfaces: ground, opaque objects, background, by any path
  std::vector<glm::vec3> scattered;  ///< light gathered from inside the media
  std::vector<float> depth;          ///< distance from the camera to the first hit [scene units], 1e10 where none
  std::vector<glm::vec3> normal;     ///< unit normal of the first hit, 0 where none
  std::int64_t steps = 0;            ///< that all camera samples took through the media
};

/// Metadata of an EXR file: string, float or int attributes with names like "turbid:scene_hash".
struct ImageMetadata {
  std::map<std::string, std::string> text;
  std::map<std::string, float> numbers;
};

/// Channels R G B A, direct.R.., scattered.R.., depth.Z, N.X N.Y N.Z as 32-bit float.
/// Writes to a temporary name first and renames: no half-written file. Throws InputError if that fails (disk full, ...).
void write_exr(const ViewImage&, const ImageMetadata&, const std::string& path);

/// 2^exposure * radiance, filmic shoulder so that highlights keep their hue, sRGB transfer, 8 bit; alpha is not written.
void write_png_preview(const ViewImage&, float exposure_stops, const std::string& path);
/// What write_png_preview() writes; less compression (1 to 9) is faster.
std::vector<unsigned char> png_preview_bytes(const ViewImage&, float exposure_stops, int compression = 6);

/// Exposure [stops] that maps the picture's bright parts (99th percentile of luminance of covered pixels) near white.
float automatic_exposure(const ViewImage&);

/// Lines for `turbid info`: size, channels with types and value ranges (NaN counted), metadata.
/// Throws InputError if the file can't be read as an image.
std::string describe_image(const std::string& path);

}  // namespace turbid
