// SPDX-License-Identifier: Apache-2.0
// The values of two OpenVDB files side by side, grid by grid, for comparing them.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace turbid {

/// A grid of one name from both files: its values at the voxels that are active in either.
struct GridPair {
  std::string name;
  int components = 1;       ///< 1, or 3 for vectors
  std::vector<float> a, b;  ///< components together, voxel after voxel
};

/// Calls visit for each grid of floats or of vectors of floats (single or double precision), in the order of the
/// reference b; for the one named `only` if that is not empty. Other grids are passed over. Throws InputError if a file
/// can't be read, if one lacks a grid of the other, or if type or transform (position, voxel size) of a pair differ;
/// all this is found before the first visit.
void for_each_grid_pair(const std::string& path_a, const std::string& path_b, const std::string& only,
                        const std::function<void(const GridPair&)>& visit);

}  // namespace turbid
