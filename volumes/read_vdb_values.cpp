// SPDX-License-Identifier: Apache-2.0
// See read_vdb_values.h.
#include "volumes/read_vdb_values.h"

#include <cstdio>
#include <type_traits>

#include "host/base/errors.h"
#include "volumes/vdb_file.h"

namespace turbid {
namespace {

using Comparable = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;
using Grids = std::vector<openvdb::GridBase::ConstPtr>;

constexpr openvdb::Index64 kMostVoxels = 1u << 30;  ///< 8 GB of floats

std::string quoted(const openvdb::GridBase& grid) {
  return "\"" + grid.getName() + "\" (" + grid.valueType() + ")";
}

std::string list_of(const Grids& grids) {
  std::string list;
  for (const auto& grid : grids) list += (list.empty() ? "" : ", ") + quoted(*grid);
  return list.empty() ? "none" : list;
}

const openvdb::GridBase* find(const Grids& grids, const std::string& name) {
  for (const auto& grid : grids)
    if (grid->getName() == name) return grid.get();
  return nullptr;
}

Grids comparable_grids(const std::string& path, const std::string& only) {
  Grids all, chosen;
  for (const auto& grid : read_vdb_file(path)) {
    if (!grid->apply<Comparable>([](const auto&) {})) continue;
    if (find(all, grid->getName())) throw InputError(path + ": holds two grids named " + quoted(*grid));
    all.push_back(grid);
    if (only.empty() || grid->getName() == only) chosen.push_back(grid);
  }
  if (all.empty()) throw InputError(path + ": holds no grid of numbers or vectors of numbers");
  if (chosen.empty()) throw InputError(path + ": holds no grid \"" + only + "\"; it has " + list_of(all));
  return chosen;
}

void require_all_of(const std::string& path, const Grids& grids, const std::string& other, const Grids& wanted) {
  for (const auto& grid : wanted)
    if (!find(grids, grid->getName()))
      throw InputError(path + ": lacks the grid " + quoted(*grid) + " of " + other + "; it has " + list_of(grids) +
                       "; --grid NAME compares one grid");
}

/// To a thousandth of a voxel at the corners of what the grids hold.
bool in_one_place(const openvdb::GridBase& a, const openvdb::GridBase& b) {
  openvdb::CoordBBox box = b.evalActiveVoxelBoundingBox();
  const openvdb::CoordBBox box_a = a.evalActiveVoxelBoundingBox();
  if (box.empty())
    box = box_a;
  else if (!box_a.empty())
    box.expand(box_a);
  if (box.empty()) box = openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(1));
  for (int corner = 0; corner < 8; ++corner) {
    openvdb::Vec3d index;
    for (int axis = 0; axis < 3; ++axis) index[axis] = (corner >> axis & 1) ? box.max()[axis] : box.min()[axis];
    if (!((b.worldToIndex(a.indexToWorld(index)) - index).length() < 1e-3)) return false;
  }
  return true;
}

std::string place_of(const openvdb::GridBase& grid) {
  const openvdb::Vec3d first = grid.indexToWorld(openvdb::Vec3d(0)), voxel = grid.voxelSize();
  char text[200];
  std::snprintf(text, sizeof text, "voxels of %g x %g x %g, the first at (%g, %g, %g)", voxel[0], voxel[1], voxel[2],
                first[0], first[1], first[2]);
  return text;
}

template <class Value>
void append(std::vector<float>& values, const Value& value) {
  if constexpr (openvdb::VecTraits<Value>::IsVec) {
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(value[c]));
  } else {
    values.push_back(static_cast<float>(value));
  }
}

template <class Grid>
GridPair values_of(const Grid& a, const Grid& b, const std::string& path_a) {
  openvdb::MaskTree active(a.tree(), false, true, openvdb::TopologyCopy());
  active.topologyUnion(b.tree());
  const openvdb::Index64 voxels = active.activeVoxelCount();
  if (voxels > kMostVoxels)
    throw InputError(path_a + ": the grid " + quoted(a) + " and the reference's have " + std::to_string(voxels) +
                     " active voxels, more than can be compared");
  GridPair pair;
  pair.name = b.getName();
  pair.components = openvdb::VecTraits<typename Grid::ValueType>::IsVec ? 3 : 1;
  pair.a.reserve(voxels * pair.components);
  pair.b.reserve(voxels * pair.components);
  const auto of_a = a.getConstAccessor();
  const auto of_b = b.getConstAccessor();
  for (auto on = active.cbeginValueOn(); on; ++on) {
    openvdb::CoordBBox box;
    on.getBoundingBox(box);  // one voxel, or an active tile
    for (const openvdb::Coord& at : box) {
      append(pair.a, of_a.getValue(at));
      append(pair.b, of_b.getValue(at));
    }
  }
  return pair;
}

}  // namespace

void for_each_grid_pair(const std::string& path_a, const std::string& path_b, const std::string& only,
                        const std::function<void(const GridPair&)>& visit) {
  const Grids grids_a = comparable_grids(path_a, only), grids_b = comparable_grids(path_b, only);
  require_all_of(path_a, grids_a, "the reference " + path_b, grids_b);
  require_all_of(path_b, grids_b, path_a, grids_a);
  for (const auto& b : grids_b) {
    const openvdb::GridBase& a = *find(grids_a, b->getName());
    if (a.type() != b->type())
      throw InputError(path_a + ": the grid " + quoted(a) + " is of another type than that of the reference, " +
                       b->valueType());
    if (!in_one_place(a, *b))
      throw InputError(path_a + ": the grid " + quoted(a) + " has " + place_of(a) + ", but in the reference " + path_b +
                       " " + place_of(*b));
  }
  for (const auto& b : grids_b)
    b->apply<Comparable>([&](const auto& typed) {
      using Grid = std::decay_t<decltype(typed)>;
      visit(values_of(static_cast<const Grid&>(*find(grids_a, typed.getName())), typed, path_a));
    });
}

}  // namespace turbid
