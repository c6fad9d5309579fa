// SPDX-License-Identifier: Apache-2.0
// OpenImageIO writing into memory.
#include "host/view/encode_image.h"

#include <OpenImageIO/filesystem.h>

#include <stdexcept>

#include "host/base/atomic_file.h"
#include "host/base/errors.h"

namespace turbid {

std::vector<unsigned char> encode_image(const std::string& path, const char* format, const OIIO::ImageSpec& spec,
                                        OIIO::TypeDesc type, const void* pixels) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(path + ": cannot be encoded as " + format + ": " + reason);
  };
  std::vector<unsigned char> bytes;
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) refuse(OIIO::geterror());
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!output->set_ioproxy(&memory)) refuse("this build of OpenImageIO cannot write it to memory");
  if (!output->open(path, spec)) refuse(output->geterror());
  if (!output->write_image(type, pixels)) refuse(output->geterror());
  if (!output->close()) refuse(output->geterror());
  return bytes;
}

void write_image_file(const std::string& path, const char* format, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                      const void* pixels) {
  const std::vector<unsigned char> bytes = encode_image(path, format, spec, type, pixels);
  write_file_atomically(path, bytes.data(), bytes.size());
}

void require_whole(const ViewImage& image) {
  const std::size_t pixels = image.width > 0 && image.height > 0 ? std::size_t(image.width) * image.height : 0;
  if (pixels == 0 || image.colour.size() != pixels || image.direct.size() != pixels ||
      image.scattered.size() != pixels || image.depth.size() != pixels || image.normal.size() != pixels)
    throw std::invalid_argument("a ViewImage needs width * height > 0 entries in each of its arrays");
}

}  // namespace turbid
