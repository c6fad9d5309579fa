// SPDX-License-Identifier: Apache-2.0
// See svg.h.
#include "host/report/svg.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

#include "host/report/markup.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

/// Hundredths of a pixel, without trailing zeros; what lies far outside comes nearer.
std::string number(double value) {
  std::string text = line("%.2f", std::clamp(value, -1e5, 1e5));
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + number(value) + "\"";
}

std::string class_attribute(const std::string& classes) {
  return classes.empty() ? "" : " class=\"" + classes + "\"";
}

std::string spans(const std::string& text) {
  std::string out;
  bool raised = false;
  for (const TextRun& run : split_exponents(text)) {
    // dy is relative to where the last character stood: what follows an exponent comes down again.
    if (run.raised)
      out += "<tspan class=\"raised\" dy=\"-0.45em\">" + escaped(run.text) + "</tspan>";
    else
      out += raised ? "<tspan dy=\"0.34em\">" + escaped(run.text) + "</tspan>" : escaped(run.text);
    raised = run.raised;
  }
  return out;
}

/// A closed polygon's corners around a point, radius 1; y downwards.
std::vector<Point> polygon(std::size_t shape) {
  const auto regular = [](int corners, double turn, double radius) {
    std::vector<Point> points;
    for (int i = 0; i < corners; ++i) {
      const double angle = turn + 2 * std::numbers::pi * i / corners;
      points.push_back({radius * std::sin(angle), -radius * std::cos(angle)});
    }
    return points;
  };
  constexpr double kPi = std::numbers::pi;
  switch (shape) {
    case 1:
      return regular(4, kPi / 4, 1.25);  // square
    case 2:
      return regular(3, 0, 1.35);  // triangle
    case 3:
      return regular(4, 0, 1.35);  // diamond
    case 4:
      return regular(3, kPi, 1.35);  // triangle, upside down
    case 5:
      return regular(5, 0, 1.25);
    case 6:
      return {{-0.45, -1.2}, {0.45, -1.2}, {0.45, -0.45}, {1.2, -0.45}, {1.2, 0.45},   {0.45, 0.45},
              {0.45, 1.2},   {-0.45, 1.2}, {-0.45, 0.45}, {-1.2, 0.45}, {-1.2, -0.45}, {-0.45, -0.45}};  // plus
    default:
      return regular(6, 0, 1.2);
  }
}

}  // namespace

double text_width(const std::string& text, double font) {
  constexpr std::string_view kNarrow = "iljtfrI.,:;|'!()[]/ -", kBroad = "mwMW@%&";
  double width = 0;
  for (const TextRun& run : split_exponents(text))
    for (const char c : run.text) {
      if ((c & 0xC0) == 0x80) continue;
      const double one = kNarrow.find(c) != std::string_view::npos  ? 0.37
                         : kBroad.find(c) != std::string_view::npos ? 0.95
                         : c >= 'A' && c <= 'Z'                     ? 0.70
                                                                    : 0.63;
      width += one * font * (run.raised ? 0.75 : 1);
    }
  return width;
}

Svg::Svg(const FigureLayout& layout, double height, const std::string& description) : font_(layout.font) {
  head_ = std::string("<svg class=\"figure ") + layout.name + "\" viewBox=\"0 0 " + number(layout.width) + " " +
          number(height) + "\" font-size=\"" + number(layout.font) + "\" role=\"img\" aria-label=\"" +
          escaped(description) + "\">\n";
}

void Svg::line(Point a, Point b, const std::string& classes) {
  body_ += "<line" + attribute("x1", a.x) + attribute("y1", a.y) + attribute("x2", b.x) + attribute("y2", b.y) +
           class_attribute(classes) + "/>\n";
}

void Svg::rectangle(const Box& box, const std::string& classes, const std::string& tooltip) {
  body_ += "<rect" + attribute("x", box.x) + attribute("y", box.y) + attribute("width", std::max(box.width, 0.0)) +
           attribute("height", std::max(box.height, 0.0)) + class_attribute(classes) +
           (tooltip.empty() ? "/>\n" : "><title>" + escaped(tooltip) + "</title></rect>\n");
}

void Svg::polyline(const std::vector<Point>& points, const std::string& classes) {
  if (points.size() < 2) return;
  std::string text;
  for (const Point& p : points) text += (text.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
  body_ += "<polyline points=\"" + text + "\"" + class_attribute(classes) + "/>\n";
}

void Svg::marker(Point at, std::size_t shape, double radius, const std::string& classes) {
  if (shape % 8 == 0) {
    body_ += "<circle" + attribute("cx", at.x) + attribute("cy", at.y) + attribute("r", radius) +
             class_attribute(classes) + "/>\n";
    return;
  }
  std::string text;
  for (const Point& p : polygon(shape % 8))
    text += (text.empty() ? "" : " ") + number(at.x + radius * p.x) + "," + number(at.y + radius * p.y);
  body_ += "<polygon points=\"" + text + "\"" + class_attribute(classes) + "/>\n";
}

void Svg::text(Point at, Anchor anchor, const std::string& text, const std::string& classes, double room) {
  const char* const name = anchor == Anchor::start ? "start" : anchor == Anchor::middle ? "middle" : "end";
  body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + " text-anchor=\"" + name + "\"" +
           class_attribute(classes);
  if (room > 0 && text_width(text, font_) > room)
    body_ += attribute("textLength", room) + " lengthAdjust=\"spacingAndGlyphs\"";
  body_ += ">" + spans(text) + "</text>\n";
}

void Svg::text_upwards(Point at, const std::string& words, double room) {
  body_ += "<g transform=\"translate(" + number(at.x) + " " + number(at.y) + ") rotate(-90)\">";
  text({0, 0}, Anchor::middle, words, "axis-label", room);
  body_ += "</g>\n";
}

void Svg::begin_clip(const std::string& id, const Box& box) {
  body_ += "<clipPath id=\"" + escaped(id) + "\">";
  rectangle(box, "");
  body_ += "</clipPath><g clip-path=\"url(#" + escaped(id) + ")\">\n";
}

void Svg::end_clip() {
  body_ += "</g>\n";
}

std::string Svg::str() const {
  return head_ + body_ + "</svg>\n";
}

}  // namespace turbid
