// SPDX-License-Identifier: Apache-2.0
// From pixels to the bytes of an image file and those to disk. Internal to host/view/image_*.cpp.
#pragma once
#include <OpenImageIO/imageio.h>

#include <string>
#include <vector>

#include "host/view/image.h"

namespace turbid {

/// The bytes of an image file. `pixels` has spec.nchannels values of `type` per pixel. `format` is OpenImageIO's name
/// ("openexr", "png"); `path` names the file in errors.
std::vector<unsigned char> encode_image(const std::string& path, const char* format, const OIIO::ImageSpec& spec,
                                        OIIO::TypeDesc type, const void* pixels);

/// Encodes in memory, so that whatever can go wrong on the disk is met (and named) in write_file_atomically.
void write_image_file(const std::string& path, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                      const void* pixels);

/// Throws std::invalid_argument if an array of the image does not have width * height entries.
void require_whole(const ViewImage&);

}  // namespace turbid
