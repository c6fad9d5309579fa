// SPDX-License-Identifier: Apache-2.0
// Who was busy when, as SVG: a row per track.
#include <algorithm>
#include <cmath>
#include <map>

#include "host/report/figure.h"
#include "host/report/table.h"

namespace turbid {
namespace {

constexpr double kWidestNames = 0.25;  // of the figure's width
constexpr double kClosest = 0.4;       // [px]: nearer intervals of one name are drawn as one

bool drawable(const Interval& one) {
  const Axis linear;
  return showable(linear, one.begin) && showable(linear, one.end) && one.begin <= one.end;
}

/// Names of intervals, the longest in all first: colours are few, and those are seen most.
std::vector<std::string> names_by_time(const Timeline& timeline) {
  std::vector<std::pair<std::string, double>> totals;  // in order of appearance
  std::map<std::string, std::size_t> place;
  for (const Track& track : timeline.tracks)
    for (const Interval& one : track.intervals) {
      if (!drawable(one)) continue;
      if (place.emplace(one.name, totals.size()).second) totals.emplace_back(one.name, 0);
      totals[place[one.name]].second += one.end - one.begin;
    }
  std::stable_sort(totals.begin(), totals.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> names;
  for (const auto& [name, total] : totals) names.push_back(name);
  return names;
}

struct Bar {
  double from, to;  // [px]
  std::size_t colour;
  const Interval* first;
  std::size_t count;
};

std::vector<Bar> bars_of(const Track& track, const Scale& scale, const std::map<std::string, std::size_t>& colours) {
  std::vector<const Interval*> sorted;
  for (const Interval& one : track.intervals)
    if (drawable(one)) sorted.push_back(&one);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Interval* a, const Interval* b) { return a->begin < b->begin; });
  std::vector<Bar> bars;
  for (const Interval* one : sorted) {
    const double from = scale(one->begin), to = scale(one->end);
    const std::size_t colour = colours.at(one->name);
    if (!bars.empty() && bars.back().colour == colour && from - bars.back().to < kClosest) {
      bars.back().to = std::max(bars.back().to, to);
      ++bars.back().count;
    } else {
      bars.push_back({from, to, colour, one, 1});
    }
  }
  return bars;
}

std::string tooltip(const Bar& bar, const std::string& unit) {
  const Interval& one = *bar.first;
  if (bar.count > 1)
    return std::to_string(bar.count) + " of " + one.name + " from " + number_text(one.begin, 4) + " " + unit;
  return one.name + ": " + number_text(one.begin, 4) + " to " + number_text(one.end, 4) + " " + unit;
}

}  // namespace

std::string left_out(const Timeline& timeline) {
  std::size_t count = 0;
  for (const Track& track : timeline.tracks)
    count +=
        std::count_if(track.intervals.begin(), track.intervals.end(), [](const Interval& i) { return !drawable(i); });
  if (count == 0) return {};
  return count == 1 ? "One interval ends before it begins or is not finite: left out."
                    : std::to_string(count) + " intervals end before they begin or are not finite: left out.";
}

std::string timeline_svg(const Timeline& timeline, const FigureLayout& layout) {
  const double font = layout.font, row = 2.1 * font;
  const bool names_above = std::string(layout.name) == kNarrowFigure.name;
  std::map<std::string, std::size_t> colours;
  std::vector<LegendEntry> entries;
  std::vector<double> ends;
  double names = 0;
  for (const Track& track : timeline.tracks) {
    names = std::max(names, text_width(track.name, font));
    for (const Interval& one : track.intervals) {
      if (!drawable(one)) continue;
      ends.insert(ends.end(), {one.begin, one.end});
    }
  }
  for (const std::string& name : names_by_time(timeline)) {
    entries.push_back({name, colours.size(), Swatch::area});
    colours.emplace(name, colours.size());
  }
  const Legend legend(layout, entries);
  names = names_above ? 0 : std::min(names, kWidestNames * layout.width);
  const double name_height = names_above ? 1.35 * font : 0;
  Box box{names + 10, legend.height() + 4, 0,
          static_cast<double>(timeline.tracks.size()) * (row + name_height) + 0.4 * font};
  box.width = layout.width - box.x - 1.5 * font;

  const Axis time{"time", timeline.unit};
  Scale scale = fitted_scale(time, ends);
  scale.from = box.x;
  scale.to = box.x + box.width;
  Svg svg(layout, box.y + box.height + 3.4 * font, timeline.title);
  legend.draw(svg, {4, 0});
  draw_horizontal_axis(svg, box, scale, time);
  for (std::size_t t = 0; t < timeline.tracks.size(); ++t) {
    const Track& track = timeline.tracks[t];
    const double top = box.y + static_cast<double>(t) * (row + name_height) + 0.4 * font;
    if (names_above)
      svg.text({box.x + 2, top + 0.95 * font}, Anchor::start, track.name, "label", box.width);
    else
      svg.text({box.x - 8, top + 0.5 * row}, Anchor::end, track.name, "", names);
    const double y = top + name_height, height = row - 0.6 * font;
    for (const Bar& bar : bars_of(track, scale, colours))
      svg.rectangle({bar.from, y, std::max(bar.to - bar.from, 0.8), height},
                    area_classes(bar.colour) + (bar.to - bar.from > 3 ? " outlined" : ""), tooltip(bar, timeline.unit));
  }
  svg.line({box.x, box.y}, {box.x, box.y + box.height}, "axis");
  return svg.str();
}

}  // namespace turbid
