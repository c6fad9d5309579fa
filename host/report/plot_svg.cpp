// SPDX-License-Identifier: Apache-2.0
// Lines and points over two axes as SVG.
#include <algorithm>
#include <cmath>

#include "host/report/figure.h"
#include "host/report/label_room.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

/// A series' points that the axes can show, in pixels.
struct Drawn {
  std::vector<Point> points;
  std::vector<std::size_t> source;  ///< index of each in the series
};

bool both_showable(const Plot& plot, const Series& series, std::size_t i) {
  return showable(plot.x, series.x[i]) && showable(plot.y, series.y[i]);
}

Scale scale_of_x(const Plot& plot) {
  std::vector<double> values;
  for (const Series& one : plot.series)
    for (std::size_t i = 0; i < one.x.size(); ++i)
      if (both_showable(plot, one, i)) values.push_back(one.x[i]);
  for (const MarkerLine& one : plot.lines)
    if (one.vertical) values.push_back(one.at);
  return fitted_scale(plot.x, values);
}

Scale scale_of_y(const Plot& plot) {
  std::vector<double> values;
  for (const Series& one : plot.series)
    for (std::size_t i = 0; i < one.y.size(); ++i) {
      if (!both_showable(plot, one, i)) continue;
      values.push_back(one.y[i]);
      if (!one.y_low.empty()) values.push_back(one.y_low[i]);
      if (!one.y_high.empty()) values.push_back(one.y_high[i]);
    }
  for (const MarkerLine& one : plot.lines)
    if (!one.vertical) values.push_back(one.at);
  return fitted_scale(plot.y, values);
}

/// Everything that goes into the frame.
class PlotDrawing {
 public:
  PlotDrawing(const Plot& plot, const FigureLayout& layout, Svg& svg, const Box& box, const Scale& x, const Scale& y)
      : plot_(plot), layout_(layout), svg_(svg), box_(box), x_(x), y_(y), room_(box) {
    for (const Series& one : plot.series) drawn_.push_back(drawn(one));
  }

  void draw() {
    svg_.begin_clip("clip-" + plot_.id + "-" + layout_.name,
                    {box_.x - 5, box_.y - 5, box_.width + 10, box_.height + 10});
    draw_marker_lines();
    draw_slopes();
    for (const bool highlighted : {false, true})
      for (std::size_t i = 0; i < plot_.series.size(); ++i)
        if (plot_.series[i].highlighted == highlighted) draw_series(i);
    svg_.end_clip();
    label_marker_lines();
    label_slopes();
    label_points();
    if (std::all_of(drawn_.begin(), drawn_.end(), [](const Drawn& one) { return one.points.empty(); }))
      svg_.text({box_.x + box_.width / 2, box_.y + box_.height / 2}, Anchor::middle, "no data", "note");
  }

 private:
  Drawn drawn(const Series& series) const {
    Drawn result;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!both_showable(plot_, series, i)) continue;
      result.points.push_back({x_(series.x[i]), y_(series.y[i])});
      result.source.push_back(i);
    }
    return result;
  }

  bool inside(Point p) const {
    return p.x >= box_.x && p.x <= box_.x + box_.width && p.y >= box_.y && p.y <= box_.y + box_.height;
  }

  void draw_series(std::size_t index) {
    const Series& series = plot_.series[index];
    const std::vector<Point>& points = drawn_[index].points;
    const std::string colour = colour_class(index) + (series.highlighted ? " heavy" : "");
    if (series.line) {
      svg_.polyline(points, "series " + colour + (series.dashed ? " dashed" : ""));
      for (std::size_t i = 1; i < points.size(); ++i) room_.take_line(points[i - 1], points[i]);
    }
    for (std::size_t i = 0; i < points.size(); ++i) draw_error_bar(series, drawn_[index].source[i], points[i], colour);
    const double radius = (series.highlighted ? 5 : 4) * (points.size() > 60 ? 0.6 : 1);
    for (const Point& p : points) {
      if (series.markers) svg_.marker(p, index + index / 8, radius, "mark " + colour);
      room_.take({p.x - radius, p.y - radius, 2 * radius, 2 * radius});
    }
  }

  void draw_error_bar(const Series& series, std::size_t i, Point p, const std::string& colour) {
    const auto end = [&](const std::vector<double>& values, double edge) {
      if (values.empty() || std::isnan(values[i])) return p.y;
      return showable(plot_.y, values[i]) ? y_(values[i]) : edge;  // zero on a logarithmic axis: to the frame
    };
    const double low = end(series.y_low, box_.y + box_.height), high = end(series.y_high, box_.y);
    if (low == high) return;
    svg_.line({p.x, low}, {p.x, high}, "error " + colour);
    for (const double y : {low, high}) svg_.line({p.x - 4, y}, {p.x + 4, y}, "error " + colour);
    room_.take_line({p.x, low}, {p.x, high});
  }

  void draw_marker_lines() {
    for (const MarkerLine& one : plot_.lines) {
      if (!showable(one.vertical ? plot_.x : plot_.y, one.at)) continue;
      const double at = one.vertical ? x_(one.at) : y_(one.at);
      const Point a = one.vertical ? Point{at, box_.y} : Point{box_.x, at};
      const Point b = one.vertical ? Point{at, box_.y + box_.height} : Point{box_.x + box_.width, at};
      svg_.line(a, b, "marker-line");
      room_.take_line(a, b);
    }
  }

  /// The slope's line y = factor x^order, below the whole series by about a text's height; empty if it cannot be drawn.
  std::vector<Point> slope_line(const ReferenceSlope& slope) const {
    if (!plot_.x.log || !plot_.y.log || slope.series >= plot_.series.size()) return {};
    const Series& series = plot_.series[slope.series];
    const std::vector<std::size_t>& shown = drawn_[slope.series].source;
    if (shown.size() < 2) return {};
    // In decades: the line's height at x = 1.
    double height = 1e300, first = 1e300, last = -1e300;
    for (const std::size_t i : shown) {
      const double x = std::log10(series.x[i]);
      height = std::min(height, std::log10(series.y[i]) - slope.order * x);
      first = std::min(first, x);
      last = std::max(last, x);
    }
    height -= (std::log10(y_.high) - std::log10(y_.low)) / box_.height * layout_.font;
    std::vector<Point> line;
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
      const double x = first + (last - first) * i / kSteps, y = height + slope.order * x;
      if (y < std::log10(y_.low) || y > std::log10(y_.high)) continue;
      line.push_back({x_(std::pow(10.0, x)), y_(std::pow(10.0, y))});
    }
    return line;
  }

  void draw_slopes() {
    for (const ReferenceSlope& slope : plot_.slopes) {
      slope_lines_.push_back(slope_line(slope));
      const std::vector<Point>& line = slope_lines_.back();
      if (line.size() < 2) continue;
      svg_.line(line.front(), line.back(), "slope " + colour_class(slope.series));
      room_.take_line(line.front(), line.back());
    }
  }

  /// Places a text at one of the candidates (its lower left corners) and draws it.
  void label(const std::string& text, std::vector<Point> corners, const std::string& classes, bool must) {
    const double font = layout_.font, width = text_width(text, font);
    std::vector<Box> boxes;
    for (const Point& p : corners) boxes.push_back({p.x, p.y - font, width, 1.2 * font});
    const int at = room_.place(boxes, must);
    if (at < 0) return;
    const Point& p = corners[static_cast<std::size_t>(at)];
    const double x = std::clamp(p.x, 2.0, std::max(2.0, layout_.width - width - 2));
    svg_.text({x, p.y}, Anchor::start, text, "label " + classes);
  }

  void label_marker_lines() {
    for (const MarkerLine& one : plot_.lines) {
      if (one.label.empty() || !showable(one.vertical ? plot_.x : plot_.y, one.at)) continue;
      const double width = text_width(one.label, layout_.font), font = layout_.font;
      std::vector<Point> corners;
      for (int i = 0; i < 8; ++i) {
        const double along = i / 8.0;
        if (one.vertical) {
          const double x = x_(one.at), y = box_.y + 1.2 * font + along * (box_.height - 2 * font);
          corners.insert(corners.end(), {{x + 5, y}, {x - 5 - width, y}});
        } else {
          const double y = y_(one.at), x = box_.x + box_.width - width - 4 - along * (box_.width - width);
          corners.insert(corners.end(), {{x, y - 5}, {x, y + font + 2}});
        }
      }
      label(one.label, corners, "muted", true);
    }
  }

  void label_slopes() {
    for (std::size_t i = 0; i < plot_.slopes.size(); ++i) {
      const ReferenceSlope& slope = plot_.slopes[i];
      const std::vector<Point>& points = slope_lines_[i];
      if (points.size() < 2) continue;
      const std::string text = slope.label.empty() ? line("order %g", slope.order) : slope.label;
      const double width = text_width(text, layout_.font);
      std::vector<Point> corners;
      for (const double part : {0.5, 0.6, 0.4, 0.7, 0.3, 0.8, 0.2, 0.9, 0.1}) {
        const Point& p = points[static_cast<std::size_t>(part * static_cast<double>(points.size() - 1))];
        corners.insert(corners.end(), {{p.x + 6, p.y + layout_.font},
                                       {p.x - width - 6, p.y + layout_.font},
                                       {p.x + 6, p.y - 4},
                                       {p.x - width - 6, p.y - 4},
                                       {p.x - width / 2, p.y + 1.6 * layout_.font}});
      }
      label(text, corners, "slope-label", true);
    }
  }

  void label_points() {
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      const Series& series = plot_.series[s];
      for (std::size_t i = 0; i < drawn_[s].points.size() && !series.point_labels.empty(); ++i) {
        const std::string& text = series.point_labels[drawn_[s].source[i]];
        const Point& p = drawn_[s].points[i];
        if (text.empty() || !inside(p)) continue;
        const double width = text_width(text, layout_.font), font = layout_.font;
        std::vector<Point> corners;
        for (const double gap : {8.0, 18.0, 30.0})
          corners.insert(corners.end(), {{p.x + gap, p.y + 0.35 * font},
                                         {p.x + 0.6 * gap, p.y - gap},
                                         {p.x + 0.6 * gap, p.y + gap + 0.8 * font},
                                         {p.x - width - gap, p.y + 0.35 * font},
                                         {p.x - width / 2, p.y - gap},
                                         {p.x - width / 2, p.y + gap + 0.8 * font},
                                         {p.x - width - 0.6 * gap, p.y - gap},
                                         {p.x - width - 0.6 * gap, p.y + gap + 0.8 * font}});
        label(text, corners, "point-label", false);
      }
    }
  }

  const Plot& plot_;
  const FigureLayout& layout_;
  Svg& svg_;
  Box box_;
  Scale x_, y_;
  LabelRoom room_;
  std::vector<Drawn> drawn_;
  std::vector<std::vector<Point>> slope_lines_;
};

std::vector<LegendEntry> legend_entries(const Plot& plot) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& one = plot.series[i];
    const Swatch swatch = !one.line     ? Swatch::markers
                          : one.markers ? (one.dashed ? Swatch::dashed_line_and_markers : Swatch::line_and_markers)
                                        : (one.dashed ? Swatch::dashed_line : Swatch::line);
    if (!one.name.empty()) entries.push_back({one.name, i, swatch});
  }
  return entries;
}

}  // namespace

std::string left_out(const Plot& plot) {
  std::size_t count = 0;
  for (const Series& one : plot.series)
    for (std::size_t i = 0; i < one.x.size(); ++i) count += !both_showable(plot, one, i);
  if (count == 0) return {};
  const std::string reason = plot.x.log || plot.y.log ? "zero, negative or not finite" : "not finite";
  return count == 1 ? "One point is " + reason + " and cannot be shown on these axes."
                    : std::to_string(count) + " points are " + reason + " and cannot be shown on these axes.";
}

std::string plot_svg(const Plot& plot, const FigureLayout& layout) {
  const Legend legend(layout, legend_entries(plot));
  Scale x = scale_of_x(plot), y = scale_of_y(plot);
  const double font = layout.font, top = legend.height() + (legend.height() > 0 ? 8 : 0.8 * font);
  Box box{0, top, 0, layout.height - 3.4 * font - 0.8 * font};
  const Ticks ticks = ticks_for(y, ticks_wanted(box.height, font, false));
  if (!ticks.factor.empty()) box.y += 1.3 * font;
  box.x = std::ceil(1.7 * font + tick_label_width(ticks, font) + 8);
  box.width = layout.width - box.x - font;
  x.from = box.x;
  x.to = box.x + box.width;
  y.from = box.y + box.height;
  y.to = box.y;
  Svg svg(layout, box.y + box.height + 3.4 * font, plot.title);
  legend.draw(svg, {4, 0});
  draw_horizontal_axis(svg, box, x, plot.x);
  draw_vertical_axis(svg, box, y, plot.y, 0);
  PlotDrawing(plot, layout, svg, box, x, y).draw();
  return svg.str();
}

}  // namespace turbid
