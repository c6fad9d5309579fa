// SPDX-License-Identifier: Apache-2.0
// Writes .vdb files through a stream of our own, whose state tells about full disks, and reads them likewise.
#include "volumes/vdb_file.h"

#include <openvdb/io/Stream.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "host/base/errors.h"

namespace turbid {
namespace {

/// OpenVDB's own File opens its stream out of sight and does not look whether everything arrived on the disk.
struct SeekableArchive : openvdb::io::Archive {
  using Archive::write;
};

std::string reason_of(int error) {
  return error != 0 ? std::strerror(error) : "the file system gives no reason";
}

constexpr char kMagic[8] = {' ', 'B', 'D', 'V', 0, 0, 0, 0};  // OPENVDB_MAGIC as it lies in the file

}  // namespace

void initialise_vdb() {
  openvdb::initialize();
}

void label_grid(openvdb::GridBase& grid, const std::string& name, openvdb::GridClass grid_class,
                const std::string& unit, const std::string& unit_of_values) {
  grid.setName(name);
  grid.setGridClass(grid_class);
  grid.setCreator("Turbid " TURBID_VERSION);
  grid.insertMeta("unit", openvdb::StringMetadata(unit));
  grid.insertMeta("turbid:unit_of_values", openvdb::StringMetadata(unit_of_values));
}

void write_vdb_file(const std::string& path, const openvdb::GridCPtrVec& grids) {
  initialise_vdb();
  const std::string part = path + ".part";
  std::error_code ignored;
  const auto fail = [&](const std::string& reason, bool remove) {
    if (remove) std::filesystem::remove(part, ignored);
    throw InputError(path + ": can't be written: " + reason);
  };
  if (std::filesystem::is_directory(path, ignored)) fail("it is a folder", false);

  errno = 0;
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  if (!file) fail(reason_of(errno), false);
  try {
    openvdb::MetaMap metadata;
    metadata.insertMeta("creator", openvdb::StringMetadata("Turbid " TURBID_VERSION));
    errno = 0;
    static_cast<const SeekableArchive&>(SeekableArchive()).write(file, grids, /*seekable=*/true, metadata);
    file.close();
  } catch (const std::exception& error) {
    const std::string reason = file ? error.what() : reason_of(errno);
    file.close();
    fail(reason, true);
  }
  if (!file) fail(reason_of(errno), true);
  std::error_code renamed;
  std::filesystem::rename(part, path, renamed);
  if (renamed) fail(renamed.message(), true);
}

openvdb::GridPtrVec read_vdb_file(const std::string& path) {
  initialise_vdb();
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw InputError(path + ": is a folder, not an OpenVDB file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path + ": can't be opened: " + reason_of(errno));
  char magic[sizeof kMagic] = {};
  file.read(magic, sizeof magic);
  if (std::memcmp(magic, kMagic, sizeof magic) != 0)
    throw InputError(path + ": is not an OpenVDB file (it does not begin with OpenVDB's magic number)");
  file.seekg(0);
  try {
    file.exceptions(std::ios::failbit | std::ios::badbit |
                    std::ios::eofbit);  // a file cut short must not go on as zeros
    openvdb::io::Stream stream(file, /*delayLoad=*/false);
    return *stream.getGrids();
  } catch (const std::ios_base::failure&) {
    throw InputError(path + ": is cut short or damaged");
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": is damaged: it asks for more memory than there is");
  } catch (const std::length_error&) {
    throw InputError(path + ": is damaged: it asks for more memory than there is");
  } catch (const openvdb::Exception& error) {
    throw InputError(path + ": OpenVDB can't read it: " + error.what());
  }
}

}  // namespace turbid
