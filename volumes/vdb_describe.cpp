// SPDX-License-Identifier: Apache-2.0
// One line per grid of a .vdb file, whatever it holds: densities, level sets, points.
#include <cstdio>
#include <limits>
#include <sstream>

#include "volumes/fluence_volume.h"
#include "volumes/vdb_file.h"

namespace turbid {
namespace {

using Numbers = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                                  openvdb::BoolGrid>;
using Vectors = openvdb::TypeList<openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}
std::string text(const openvdb::Vec3d& v) {
  return "(" + text(v[0]) + ", " + text(v[1]) + ", " + text(v[2]) + ")";
}
std::string text(const openvdb::Coord& c) {
  return "(" + std::to_string(c.x()) + ", " + std::to_string(c.y()) + ", " + std::to_string(c.z()) + ")";
}

std::string class_name(openvdb::GridClass grid_class) {
  switch (grid_class) {
    case openvdb::GRID_LEVEL_SET:
      return "level set";
    case openvdb::GRID_FOG_VOLUME:
      return "fog volume";
    case openvdb::GRID_STAGGERED:
      return "staggered";
    default:
      return "no class";
  }
}

/// Smallest and largest active value, for vectors per component.
std::string value_range(const openvdb::GridBase& grid) {
  std::string range = "values not shown for this type";
  grid.apply<Numbers>([&](const auto& typed) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (auto value = typed.cbeginValueOn(); value; ++value) {
      low = std::min(low, double(value.getValue()));
      high = std::max(high, double(value.getValue()));
    }
    range = low <= high ? "values " + text(low) + " .. " + text(high) : "no active values";
  });
  grid.apply<Vectors>([&](const auto& typed) {
    openvdb::Vec3d low(std::numeric_limits<double>::infinity()), high(-low);
    for (auto value = typed.cbeginValueOn(); value; ++value) {
      low = openvdb::math::minComponent(low, openvdb::Vec3d(*value));
      high = openvdb::math::maxComponent(high, openvdb::Vec3d(*value));
    }
    range = low[0] <= high[0] ? "values " + text(low) + " .. " + text(high) : "no active values";
  });
  return range;
}

std::string describe(const openvdb::GridBase& grid) {
  std::ostringstream line;
  line << (grid.getName().empty() ? "(no name)" : grid.getName()) << ": " << grid.valueType() << ", "
       << class_name(grid.getGridClass()) << ", " << grid.activeVoxelCount() << " active voxels";
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (!box.empty()) {
    // Grids of other programs may be rotated or in perspective: the corners are those of the index box.
    line << " " << text(box.min()) << " .. " << text(box.max()) << ", centres at "
         << text(grid.indexToWorld(box.min().asVec3d())) << " .. " << text(grid.indexToWorld(box.max().asVec3d()));
  }
  const openvdb::Vec3d voxel = grid.voxelSize();
  line << ", voxel size " << (grid.hasUniformVoxels() ? text(voxel[0]) : text(voxel)) << ", " << value_range(grid);
  for (auto meta = grid.beginMeta(); meta != grid.endMeta(); ++meta) {
    const std::string& key = meta->first;
    if (key == "name" || key == "class" || key.rfind("file_", 0) == 0 || !meta->second) continue;
    line << ", " << key << " = " << meta->second->str();
  }
  return line.str();
}

}  // namespace

std::string describe_vdb(const std::string& path) {
  const openvdb::GridPtrVec grids = read_vdb_file(path);
  if (grids.empty()) return path + ": holds no grids\n";
  std::string lines;
  for (const auto& grid : grids) lines += describe(*grid) + "\n";
  return lines;
}

}  // namespace turbid
