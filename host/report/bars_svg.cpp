// SPDX-License-Identifier: Apache-2.0
// Grouped horizontal bars as SVG.
#include <algorithm>
#include <cmath>

#include "host/report/figure.h"
#include "host/report/markup.h"
#include "host/report/table.h"

namespace turbid {
namespace {

constexpr double kWidestNames = 0.35;  // of the figure's width, beside the bars

std::string value_text(double value) {
  return with_power_of_ten(number_text(value, 3));
}

Scale scale_of(const BarChart& chart) {
  std::vector<double> values;
  if (!chart.value.log) values.push_back(0);
  for (const BarSeries& one : chart.series)
    for (const auto* list : {&one.values, &one.low, &one.high}) values.insert(values.end(), list->begin(), list->end());
  Scale scale = fitted_scale(chart.value, values);
  // A bar on a logarithmic axis needs some length to be seen: down to a whole decade below the least.
  if (chart.value.log && !chart.value.range) scale.low = std::pow(10.0, std::floor(std::log10(scale.low) - 1e-9));
  return scale;
}

void draw_bar(Svg& svg, const BarChart& chart, std::size_t series, std::size_t group, const Box& slot,
              const Scale& scale) {
  const BarSeries& one = chart.series[series];
  const double value = one.values[group], middle = slot.y + slot.height / 2;
  const double left = slot.x, right = slot.x + slot.width;
  double end = chart.value.log ? left : std::clamp(scale(0), left, right);
  const double start = end;
  if (showable(chart.value, value)) {
    end = std::clamp(scale(value), left, right);
    svg.rectangle({std::min(start, end), slot.y, std::abs(end - start), slot.height}, area_classes(series),
                  one.name + ": " + number_text(value, 6));
  }
  if (!one.low.empty() && !one.high.empty() && std::isfinite(one.low[group]) && std::isfinite(one.high[group])) {
    const auto place = [&](double at) { return showable(chart.value, at) ? std::clamp(scale(at), left, right) : left; };
    svg.line({place(one.low[group]), middle}, {place(one.high[group]), middle}, "error ink");
    for (const double at : {place(one.low[group]), place(one.high[group])})
      svg.line({at, middle - 3}, {at, middle + 3}, "error ink");
    end = std::max(end, place(one.high[group]));
  }
  const std::string text = value_text(value);
  svg.text({std::max(start, end) + 5, middle + 0.35 * svg.font()}, Anchor::start, text, "tick");
}

}  // namespace

std::string left_out(const BarChart& chart) {
  std::size_t count = 0;
  for (const BarSeries& one : chart.series)
    count += std::count_if(one.values.begin(), one.values.end(), [&](double v) { return !showable(chart.value, v); });
  if (count == 0) return {};
  return std::to_string(count) +
         (count == 1 ? " bar is missing: its value is " : " bars are missing: their values are ") +
         (chart.value.log ? "zero, negative or not finite." : "not finite.");
}

std::string bars_svg(const BarChart& chart, const FigureLayout& layout) {
  const double font = layout.font, bar = 1.25 * font, gap = 0.7 * font;
  const bool names_above = std::string(layout.name) == kNarrowFigure.name;
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < chart.series.size(); ++i)
    if (!chart.series[i].name.empty()) entries.push_back({chart.series[i].name, i, Swatch::area});
  const Legend legend(layout, entries);

  double names = 0, values = 0;
  for (const std::string& name : chart.groups) names = std::max(names, text_width(name, font));
  for (const BarSeries& one : chart.series)
    for (const double value : one.values) values = std::max(values, text_width(value_text(value), font));
  names = names_above ? 0 : std::min(names, kWidestNames * layout.width);
  const double bars = static_cast<double>(chart.series.size()) * bar;
  const double name_height = names_above ? 1.35 * font : 0;
  const double group_height = std::max(bars + name_height, 1.3 * font) + gap;
  Box box{names + 10, legend.height() + 4, 0, static_cast<double>(chart.groups.size()) * group_height + gap};
  box.width = layout.width - box.x - values - 12;

  Scale scale = scale_of(chart);
  scale.from = box.x;
  scale.to = box.x + box.width;
  Svg svg(layout, box.y + box.height + 3.4 * font, chart.title);
  legend.draw(svg, {4, 0});
  draw_horizontal_axis(svg, box, scale, chart.value);
  for (std::size_t group = 0; group < chart.groups.size(); ++group) {
    const double y = box.y + gap + static_cast<double>(group) * group_height;
    if (names_above)
      svg.text({box.x + 4, y + 0.95 * font}, Anchor::start, chart.groups[group], "label", layout.width - box.x - 4);
    else
      svg.text({box.x - 8, y + (group_height - gap) / 2 + 0.35 * font}, Anchor::end, chart.groups[group], "", names);
    for (std::size_t series = 0; series < chart.series.size(); ++series) {
      const double top = y + name_height + static_cast<double>(series) * bar;
      draw_bar(svg, chart, series, group, {box.x, top + 1, box.width, bar - 2}, scale);
    }
  }
  const double zero = chart.value.log ? box.x : std::clamp(scale(0), box.x, box.x + box.width);
  svg.line({zero, box.y}, {zero, box.y + box.height}, "axis");
  return svg.str();
}

}  // namespace turbid
