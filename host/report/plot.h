// SPDX-License-Identifier: Apache-2.0
// Plots of a report as data: what is drawn, not how. Values that an axis cannot show (not finite; zero or negative on a
// logarithmic axis) are left out, and the caption says how many.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace turbid {

struct Axis {
  std::string label;
  std::string unit = {};
  bool log = false;
  std::optional<std::pair<double, double>> range = {};  ///< least and largest value shown; default: what the data need
};

struct Series {
  std::string name;
  std::vector<double> x = {}, y = {};           ///< equally many
  std::vector<double> y_low = {}, y_high = {};  ///< ends of error bars [as y]; empty: none
  bool line = true;
  bool markers = true;
  bool dashed = false;
  bool highlighted = false;                    ///< heavier, and drawn above the others
  std::vector<std::string> point_labels = {};  ///< beside the points, where there is room; empty: none
};

/// A thin line y ~ x^order beside a series, to see an order of convergence by. Both axes must be logarithmic.
struct ReferenceSlope {
  double order = 1;
  std::string label = {};  ///< empty: "order 2"
  std::size_t series = 0;  ///< the one it is drawn beside
};

/// A line across the whole plot: a limit, a roof, an expected value.
struct MarkerLine {
  bool vertical = false;
  double at = 0;
  std::string label = {};
};

/// Lines and points over two axes.
struct Plot {
  std::string id;  ///< as of a table
  std::string title = {};
  std::string caption = {};
  Axis x = {}, y = {};
  std::vector<Series> series = {};
  std::vector<ReferenceSlope> slopes = {};
  std::vector<MarkerLine> lines = {};
};

struct BarSeries {
  std::string name;
  std::vector<double> values = {};          ///< one per group
  std::vector<double> low = {}, high = {};  ///< ends of error bars; empty: none
};

/// Horizontal bars from zero (on a logarithmic axis: from its lower end), grouped: one group per stage, one bar in it
/// per series.
struct BarChart {
  std::string id;
  std::string title = {};
  std::string caption = {};
  Axis value = {};
  std::vector<std::string> groups = {};
  std::vector<BarSeries> series = {};
};

struct Interval {
  std::string name;  ///< intervals of one name share a colour
  double begin = 0, end = 0;
};

struct Track {
  std::string name;
  std::vector<Interval> intervals = {};
};

/// Who was busy when: one row per track, for example a queue.
struct Timeline {
  std::string id;
  std::string title = {};
  std::string caption = {};
  std::string unit = "ms";  ///< of begin and end
  std::vector<Track> tracks = {};
};

}  // namespace turbid
