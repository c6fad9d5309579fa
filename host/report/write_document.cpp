// SPDX-License-Identifier: Apache-2.0
// A Document to its files, whole or not at all.
#include <set>
#include <stdexcept>

#include "host/base/atomic_file.h"
#include "host/report/document.h"

namespace turbid {
namespace {

[[noreturn]] void unfit(const std::string& what) {
  throw std::invalid_argument("a report cannot be written: " + what);
}

/// Checks one part; collects the ids.
struct PartCheck {
  std::set<std::string>& ids;

  void check_id(const std::string& id) const {
    if (id.empty() || id != identifier(id)) unfit("\"" + id + "\" is no id");
    if (!ids.insert(id).second) unfit("two parts have the id \"" + id + "\"");
  }
  static void check_size(const std::string& id, std::size_t size, std::size_t expected, bool optional) {
    if (size != expected && !(optional && size == 0))
      unfit("\"" + id + "\" has arrays of " + std::to_string(size) + " and " + std::to_string(expected) + " entries");
  }

  void operator()(const Paragraph&) const {}
  void operator()(const Code&) const {}
  void operator()(const Table& table) const {
    check_id(table.id);
    for (const Row& row : table.rows) check_size(table.id, row.cells.size(), table.columns.size(), false);
  }
  void operator()(const Plot& plot) const {
    check_id(plot.id);
    for (const Series& one : plot.series) {
      check_size(plot.id, one.y.size(), one.x.size(), false);
      check_size(plot.id, one.y_low.size(), one.x.size(), true);
      check_size(plot.id, one.y_high.size(), one.x.size(), true);
      check_size(plot.id, one.point_labels.size(), one.x.size(), true);
    }
    for (const ReferenceSlope& slope : plot.slopes)
      if (slope.series >= plot.series.size()) unfit("\"" + plot.id + "\" has a slope beside a series that it lacks");
  }
  void operator()(const BarChart& chart) const {
    check_id(chart.id);
    for (const BarSeries& one : chart.series) {
      check_size(chart.id, one.values.size(), chart.groups.size(), false);
      check_size(chart.id, one.low.size(), chart.groups.size(), true);
      check_size(chart.id, one.high.size(), chart.groups.size(), true);
    }
  }
  void operator()(const Timeline& timeline) const { check_id(timeline.id); }
  void operator()(const Pictures& pictures) const { check_id(pictures.id); }
};

}  // namespace

NamedTexts write_document(const Document& document, const std::string& prefix) {
  std::set<std::string> ids;
  for (const Section& section : document.sections)
    for (const Part& part : section.parts) std::visit(PartCheck{ids}, part);

  NamedTexts names{{"page", prefix + ".html"}, {"json", prefix + ".json"}};
  std::vector<std::pair<std::string, std::string>> files{{prefix + ".html", document_html(document)},
                                                         {prefix + ".json", document_json(document)}};
  for (const Section& section : document.sections)
    for (const Part& part : section.parts)
      if (const auto* table = std::get_if<Table>(&part)) {
        names.emplace_back("csv", prefix + "." + table->id + ".csv");
        files.emplace_back(names.back().second, table_csv(*table));
      }
  write_files_atomically(files);
  return names;
}

}  // namespace turbid
