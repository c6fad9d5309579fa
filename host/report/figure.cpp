// SPDX-License-Identifier: Apache-2.0
// See figure.h: axes and legend.
#include "host/report/figure.h"

#include <algorithm>
#include <cmath>

namespace turbid {
namespace {

constexpr double kTick = 5, kMinorTick = 3;  // [px]

/// Where the frame or the axis itself stands, no grid line is wanted.
bool at_edge(double at, double begin, double size) {
  return at < begin + 0.5 || at > begin + size - 0.5;
}

}  // namespace

std::string colour_class(std::size_t index) {
  return "c" + std::to_string(index % 8);
}

std::string area_classes(std::size_t index) {
  return "area " + colour_class(index) + (index / 8 % 2 == 1 ? " pale" : "");
}

std::string axis_title(const Axis& axis) {
  return axis.unit.empty() ? axis.label : axis.label + " [" + axis.unit + "]";
}

Legend::Legend(const FigureLayout& layout, std::vector<LegendEntry> entries)
    : font_(layout.font), swatch_(2 * layout.font), entries_(std::move(entries)) {
  const double most = layout.width - 8;
  double x = 0;
  int row = 0;
  for (const LegendEntry& entry : entries_) {
    const double room = std::min(text_width(entry.name, font_), most - swatch_ - 6);
    const double width = swatch_ + 6 + room;
    if (x > 0 && x + width > most) {
      x = 0;
      ++row;
    }
    places_.push_back({x, row, room});
    x += width + font_;
  }
}

double Legend::height() const {
  return places_.empty() ? 0 : (places_.back().row + 1) * 1.45 * font_ + 4;
}

void Legend::draw(Svg& svg, Point corner) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const LegendEntry& entry = entries_[i];
    const std::string colour = colour_class(entry.index);
    const double x = corner.x + places_[i].x, y = corner.y + (places_[i].row + 0.7) * 1.45 * font_;
    const bool dashed = entry.swatch == Swatch::dashed_line || entry.swatch == Swatch::dashed_line_and_markers;
    if (entry.swatch == Swatch::area)
      svg.rectangle({x + 0.5 * font_, y - 0.4 * font_, font_, 0.8 * font_}, area_classes(entry.index));
    else if (entry.swatch != Swatch::markers)
      svg.line({x, y}, {x + swatch_, y}, "series " + colour + (dashed ? " dashed" : ""));
    if (entry.swatch == Swatch::markers || entry.swatch == Swatch::line_and_markers ||
        entry.swatch == Swatch::dashed_line_and_markers)
      svg.marker({x + swatch_ / 2, y}, entry.index + entry.index / 8, 4, "mark " + colour);
    svg.text({x + swatch_ + 6, y + 0.35 * font_}, Anchor::start, entry.name, "", places_[i].room + 1);
  }
}

double tick_label_width(const Ticks& ticks, double font) {
  double width = 0;
  for (const Tick& tick : ticks.ticks) width = std::max(width, text_width(tick.label, font));
  return width;
}

int ticks_wanted(double length, double font, bool horizontal) {
  return std::clamp(static_cast<int>(length / (font * (horizontal ? 5.0 : 3.2))), 2, 10);
}

void draw_horizontal_axis(Svg& svg, const Box& box, const Scale& scale, const Axis& axis) {
  const double bottom = box.y + box.height, font = svg.font();
  const Ticks ticks = ticks_for(scale, ticks_wanted(box.width, font, true));
  double free_from = -1e9;  // labels keep a distance
  for (const Tick& tick : ticks.ticks) {
    const double x = scale(tick.at);
    const bool major = !tick.label.empty();
    if (major && !at_edge(x, box.x, box.width)) svg.line({x, box.y}, {x, bottom}, "grid");
    svg.line({x, bottom}, {x, bottom + (major ? kTick : kMinorTick)}, "axis");
    const double half = 0.5 * text_width(tick.label, font);
    if (!major || x - half < free_from) continue;
    svg.text({x, bottom + kTick + 1.05 * font}, Anchor::middle, tick.label, "tick");
    free_from = x + half + 0.4 * font;
  }
  const double title_y = bottom + kTick + 2.45 * font;
  svg.line({box.x, bottom}, {box.x + box.width, bottom}, "axis");
  svg.text({box.x + box.width / 2, title_y}, Anchor::middle, axis_title(axis), "axis-label", box.width);
  if (!ticks.factor.empty()) svg.text({box.x + box.width, title_y}, Anchor::end, ticks.factor, "tick");
}

void draw_vertical_axis(Svg& svg, const Box& box, const Scale& scale, const Axis& axis, double edge) {
  const double font = svg.font();
  const Ticks ticks = ticks_for(scale, ticks_wanted(box.height, font, false));
  double free_below = 1e9;  // the first label is the lowest
  for (const Tick& tick : ticks.ticks) {
    const double y = scale(tick.at);
    const bool major = !tick.label.empty();
    if (major && !at_edge(y, box.y, box.height)) svg.line({box.x, y}, {box.x + box.width, y}, "grid");
    svg.line({box.x - (major ? kTick : kMinorTick), y}, {box.x, y}, "axis");
    if (!major || y > free_below) continue;
    svg.text({box.x - kTick - 3, y + 0.35 * font}, Anchor::end, tick.label, "tick");
    free_below = y - 1.25 * font;
  }
  svg.line({box.x, box.y}, {box.x, box.y + box.height}, "axis");
  svg.text_upwards({edge + 0.95 * font, box.y + box.height / 2}, axis_title(axis), box.height);
  if (!ticks.factor.empty()) svg.text({box.x, box.y - 6}, Anchor::start, ticks.factor, "tick");
}

}  // namespace turbid
