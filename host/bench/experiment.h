// SPDX-License-Identifier: Apache-2.0
// One measurement of `turbid bench` as data: a table of numbers, what it is held against, and how it is drawn.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "host/view/image.h"

namespace turbid {

struct Quantity {
  std::string name;
  std::string unit = {};
};

struct Experiment {
  std::string id, title;
  std::string paper = {};       ///< what Bernabei et al. state; empty: nothing
  std::string method = {};      ///< what was run
  std::string found = {};       ///< what came out, with figures
  std::vector<Quantity> columns = {};
  std::vector<std::vector<double>> rows = {};       ///< not a number: not measured
  std::vector<std::string> labels = {};             ///< of the rows; empty: the first column tells them apart
  int plot_x = -1;              ///< column along x; -1: no plot
  std::vector<int> plot_y = {};
  bool log_x = false, log_y = false;
  std::vector<std::pair<std::string, ViewImage>> pictures = {};
};

/// How thoroughly, and where the bundled scenes are.
struct BenchSettings {
  bool quick = false;           ///< small grids, fewer levels and repeats: minutes become seconds
  std::string scenes;           ///< folder
  int repeats() const { return quick ? 3 : 5; }
  std::string scene(const std::string& file) const { return scenes + "/" + file; }
};

}  // namespace turbid
