// SPDX-License-Identifier: Apache-2.0
// A small SVG writer: shapes with classes (colours are the style sheet's), texts with raised exponents.
// Private to host/report.
#pragma once
#include <string>
#include <vector>

namespace turbid {

/// How large a figure is laid out: each is drawn twice, for a page and for a phone, and the style sheet shows one.
struct FigureLayout {
  const char* name;  ///< class of the drawing and part of ids in it
  double width, height;
  double font;  ///< text size, shown at about this size [px]
};
inline constexpr FigureLayout kWideFigure{"wide", 720, 430, 14};
inline constexpr FigureLayout kNarrowFigure{"narrow", 360, 330, 12};

struct Point {
  double x, y;
};
struct Box {
  double x, y, width, height;
};

enum class Anchor { start, middle, end };

/// Estimated for a broad sans-serif face (DejaVu Sans), so rather too wide: no fonts are at hand here.
double text_width(const std::string& text, double font);

class Svg {
 public:
  Svg(const FigureLayout&, double height, const std::string& description);

  void line(Point a, Point b, const std::string& classes);
  void rectangle(const Box&, const std::string& classes, const std::string& tooltip = "");
  void polyline(const std::vector<Point>&, const std::string& classes);
  /// One of eight shapes of about equal weight, by index modulo 8.
  void marker(Point, std::size_t shape, double radius, const std::string& classes);
  /// `room`: squeezed to fit if it is estimated to be wider; 0: as long as it likes.
  void text(Point, Anchor, const std::string& text, const std::string& classes = "", double room = 0);
  /// Turned by a quarter, bottom to top, centred on the point.
  void text_upwards(Point, const std::string& text, double room);
  /// What is drawn until end_clip() shows inside the box only. `id` must be unique in the page.
  void begin_clip(const std::string& id, const Box&);
  void end_clip();

  double font() const { return font_; }
  std::string str() const;

 private:
  double font_;
  std::string head_, body_;
};

}  // namespace turbid
