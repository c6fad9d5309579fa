// SPDX-License-Identifier: Apache-2.0
// Fields read from OpenVDB files: a float or Vec3f grid, interpolated trilinearly in its own transform. See
// procedural.h.
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "host/base/errors.h"
#include "volumes/procedural.h"

namespace turbid {
namespace {

template <class Grid>
class VdbField final : public Field {
 public:
  VdbField(typename Grid::ConstPtr grid, std::string text, glm::vec3 scale, glm::vec3 offset)
      : grid_(std::move(grid)), text_(std::move(text)), scale_(scale), offset_(offset) {}

  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    const auto accessor = grid_->getConstUnsafeAccessor();  // "unsafe": not told of changes, and there are none
    const openvdb::math::Transform& transform = grid_->transform();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const glm::vec3 x = positions[i];
      const auto value =
          openvdb::tools::BoxSampler::sample(accessor, transform.worldToIndex(openvdb::Vec3d(x.x, x.y, x.z)));
      if constexpr (openvdb::VecTraits<typename Grid::ValueType>::IsVec) {
        values[i] = scale_ * glm::vec3(value[0], value[1], value[2]) + offset_;
      } else {
        values[i] = scale_ * static_cast<float>(value) + offset_;
      }
    }
  }
  std::optional<glm::vec3> scale() const override { return scale_; }
  std::string describe() const override { return text_; }

 private:
  typename Grid::ConstPtr grid_;
  std::string text_;
  glm::vec3 scale_, offset_;
};

bool holds_values(const openvdb::GridBase& grid) {
  return grid.isType<openvdb::FloatGrid>() || grid.isType<openvdb::DoubleGrid>() || grid.isType<openvdb::Vec3SGrid>() ||
         grid.isType<openvdb::Vec3DGrid>();
}

std::string class_name(const openvdb::GridBase& grid) {
  if (grid.valueType() == "ptdataidx32" || grid.valueType() == "ptdataidx64") return "points";
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) return "a level set (distances to a surface)";
  if (grid.getGridClass() == openvdb::GRID_STAGGERED) return "a staggered velocity";
  if (!holds_values(grid)) return "of type " + grid.valueType();
  return "a density";
}

bool suits(const openvdb::GridBase& grid) {
  return class_name(grid) == "a density";
}

/// A file's grids without their voxels, by names that tell them apart: of two grids "a" the second is "a[1]".
using Directory = std::vector<std::pair<std::string, openvdb::GridBase::ConstPtr>>;

Directory directory_of(openvdb::io::File& file) {
  Directory directory;
  for (auto name = file.beginName(); name != file.endName(); ++name)
    directory.emplace_back(name.gridName(), file.readGridMetadata(name.gridName()));
  return directory;
}

std::string list_of(const Directory& directory) {
  std::string text;
  for (const auto& [name, grid] : directory)
    text += (text.empty() ? "\"" : ", \"") + name + "\" (" + grid->valueType() +
            (suits(*grid) ? ")" : ", " + class_name(*grid) + ")");
  return text;
}

/// OpenVDB reads a file that is cut short without a word, so the ends that its grids announce are compared with its
/// size.
class FileEnd : private openvdb::io::Archive {
 public:
  static std::uintmax_t announced(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    FileEnd archive;
    archive.readHeader(in);
    archive.setFormatVersion(in);
    archive.setLibraryVersion(in);
    if (!archive.inputHasGridOffsets()) return 0;
    in.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    openvdb::MetaMap().readMeta(in);
    std::uintmax_t end = 0;
    for (int grids = readGridCount(in); grids > 0; --grids) {
      openvdb::io::GridDescriptor descriptor;
      descriptor.read(in);
      end = std::max(end, static_cast<std::uintmax_t>(descriptor.getEndPos()));
      descriptor.seekToEnd(in);
    }
    return end;
  }
};

void refuse_cut_short(const std::string& path) {
  const std::uintmax_t size = std::filesystem::file_size(path), announced = FileEnd::announced(path);
  if (size < announced)
    throw InputError(path + ": is cut short: holds " + std::to_string(size) + " of " + std::to_string(announced) +
                     " bytes");
}

/// The grid that is meant: `wanted`, or the only suitable one.
std::string choose(const std::string& path, const std::string& wanted, const Directory& directory) {
  if (directory.empty()) throw InputError(path + ": holds no grids");
  std::vector<const Directory::value_type*> matches;
  for (const auto& entry : directory) {
    const bool named = entry.first == wanted || entry.second->getName() == wanted;
    if (wanted.empty() ? suits(*entry.second) : named) matches.push_back(&entry);
  }
  const std::string there_are = "; there are " + list_of(directory);
  if (matches.empty() && wanted.empty())
    throw InputError(path + ": holds no density (float or vec3s values of a fog volume)" + there_are);
  if (matches.empty()) throw InputError(path + ": has no grid \"" + wanted + "\"" + there_are);
  if (matches.size() > 1)
    throw InputError(path +
                     (wanted.empty() ? ": holds several densities" : ": holds several grids \"" + wanted + "\"") +
                     ", say which with the key grid" + there_are);
  if (!suits(*matches[0]->second))
    throw InputError(path + ": grid \"" + wanted + "\" is " + class_name(*matches[0]->second) +
                     ": expected a density (float or vec3s values of a fog volume)" + there_are);
  return matches[0]->first;
}

template <class Grid>
FieldPtr make(const openvdb::GridBase::Ptr& grid, const std::string& text, glm::vec3 scale, glm::vec3 offset) {
  auto typed = openvdb::gridPtrCast<Grid>(grid);
  return typed ? std::make_shared<VdbField<Grid>>(typed, text, scale, offset) : nullptr;
}

}  // namespace

FieldPtr vdb_field(const std::string& path, const std::string& grid, glm::vec3 scale, glm::vec3 offset) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw InputError(path + ": no such file");
  if (!std::filesystem::is_regular_file(path, ignored)) throw InputError(path + ": is no regular file");
  openvdb::initialize();
  openvdb::io::File file(path);
  openvdb::GridBase::Ptr read;
  std::string name;
  try {
    refuse_cut_short(path);
    file.open(/*delayLoad=*/false);
    name = choose(path, grid, directory_of(file));
    read = file.readGrid(name);
  } catch (const openvdb::Exception& error) {
    throw InputError(path + ": can't be read as an OpenVDB file (" + error.what() + ")");
  } catch (const std::ios_base::failure&) {
    throw InputError(path + ": is cut short or can't be read");
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": does not fit into memory, or is damaged");
  }
  const std::string text = "OpenVDB grid \"" + name + "\" of " + path;
  for (auto make_as :
       {make<openvdb::FloatGrid>, make<openvdb::Vec3SGrid>, make<openvdb::DoubleGrid>, make<openvdb::Vec3DGrid>})
    if (FieldPtr field = make_as(read, text, scale, offset)) return field;
  throw InputError(path + ": grid \"" + name + "\" is of type " + read->valueType() + ": expected float or vec3s");
}

}  // namespace turbid
