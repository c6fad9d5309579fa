// SPDX-License-Identifier: Apache-2.0
// The figures of a page as SVG, and what they share: a frame with axes, a legend. Private to host/report.
#pragma once
#include <string>
#include <vector>

#include "host/report/plot.h"
#include "host/report/scale.h"
#include "host/report/svg.h"

namespace turbid {

std::string plot_svg(const Plot&, const FigureLayout&);
std::string bars_svg(const BarChart&, const FigureLayout&);
std::string timeline_svg(const Timeline&, const FigureLayout&);

/// One sentence on what the figure cannot show, for its caption; empty: nothing.
std::string left_out(const Plot&);
std::string left_out(const BarChart&);
std::string left_out(const Timeline&);

/// Class of the colour of a series, by index modulo 8.
std::string colour_class(std::size_t index);

/// Classes of an area of that colour; the second eight are pale with an outline.
std::string area_classes(std::size_t index);

enum class Swatch { line, dashed_line, markers, line_and_markers, dashed_line_and_markers, area };

struct LegendEntry {
  std::string name;
  std::size_t index;  ///< of its colour and marker
  Swatch swatch;
};

/// Rows of names above a figure, as many as they need.
class Legend {
 public:
  Legend(const FigureLayout&, std::vector<LegendEntry>);
  double height() const;
  void draw(Svg&, Point corner) const;

 private:
  struct Place {
    double x;
    int row;
    double room;
  };
  double font_, swatch_;
  std::vector<LegendEntry> entries_;
  std::vector<Place> places_;
};

/// "voxel size [mm]"
std::string axis_title(const Axis&);
/// Draws ticks, grid lines, labels and title of a horizontal axis below the box.
void draw_horizontal_axis(Svg&, const Box&, const Scale&, const Axis&);
/// The same left of the box; `edge`: the figure's left edge, where the title begins.
void draw_vertical_axis(Svg&, const Box&, const Scale&, const Axis&, double edge);
/// Width that the labels of a vertical axis' ticks need.
double tick_label_width(const Ticks&, double font);
/// Labelled ticks that a horizontal or vertical axis of this length has room for.
int ticks_wanted(double length, double font, bool horizontal);

}  // namespace turbid
