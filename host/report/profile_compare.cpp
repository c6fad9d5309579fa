// SPDX-License-Identifier: Apache-2.0
// An older profile's tables, read back from its JSON, beside a new profile.
#include <fstream>
#include <map>

#include "host/base/errors.h"
#include "host/report/json_parts.h"
#include "host/report/profile_report.h"

namespace turbid {
namespace {

constexpr double kNoise = 1.05;

/// The table of this id in any section.
const Json& table_of(const Json& document, const std::string& id) {
  for (const Json& section : document.at("sections"))
    for (const Json& part : section.at("parts"))
      if (part.value("kind", "") == "table" && part.value("id", "") == id) return part;
  throw std::out_of_range("no table \"" + id + "\"");
}

std::size_t column_of(const Json& table, const std::string& name) {
  const Json& columns = table.at("columns");
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i].at("name") == name) return i;
  throw std::out_of_range("no column \"" + name + "\"");
}

/// First cell of each row to its min, median and max [s], which are in ms.
std::map<std::string, Spread> spreads_of(const Json& document, const std::string& id) {
  const Json& table = table_of(document, id);
  const std::size_t median = column_of(table, "median"), least = column_of(table, "min"), most = column_of(table, "max");
  std::map<std::string, Spread> result;
  for (const Json& row : table.at("rows")) {
    result[row.at(0).get<std::string>()] = {1e-3 * row.at(least).get<double>(), 1e-3 * row.at(median).get<double>(),
                                            1e-3 * row.at(most).get<double>(), 0};
  }
  return result;
}

double triad_of(const Json& document) {
  const Json& table = table_of(document, "ceilings");
  for (const Json& row : table.at("rows"))
    if (row.at(0) == "triad") return 1e9 * row.at(column_of(table, "median")).get<double>();
  throw std::out_of_range("no triad");
}

ProfileChange change(const std::string& name, const Spread& before, const Spread& after, double triad_gain) {
  ProfileChange result{name, before, after, after.median / before.median, 0, false};
  result.corrected = result.ratio * triad_gain;
  result.regression = after.min > before.max && result.ratio > kNoise && result.corrected > kNoise;
  return result;
}

/// What a comparison needs of an older profile.
struct OldProfile {
  double triad = 0;
  std::map<std::string, Spread> frame, stages, kernels;
};

OldProfile read_profile(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw InputError("--compare " + file + ": can't be read");
  try {
    const Json json = Json::parse(stream);
    return {triad_of(json), spreads_of(json, "frame"), spreads_of(json, "stages"), spreads_of(json, "kernels")};
  } catch (const std::exception& error) {
    throw InputError("--compare " + file + ": is not the JSON of a profile: " + error.what());
  }
}

}  // namespace

void require_profile(const std::string& old_json_file) { read_profile(old_json_file); }

std::vector<ProfileChange> compare_profiles(const std::string& old_json_file, const Profile& now) {
  const OldProfile old = read_profile(old_json_file);
  std::vector<ProfileChange> changes;
  const auto add = [&](const std::string& prefix, const auto& table, const std::string& name, const Spread& after) {
    if (const auto found = table.find(name); found != table.end() && found->second.median > 0)
      changes.push_back(change(prefix + name, found->second, after, now.ceilings.triad.median / old.triad));
  };
  add("", old.frame, "frame", now.frame);
  for (const StageProfile& stage : now.stages) add("stage ", old.stages, stage.name, stage.seconds);
  for (const KernelProfile& kernel : now.commands) add("kernel ", old.kernels, kernel.name, kernel.frame_seconds);
  return changes;
}

Table change_table(const std::vector<ProfileChange>& changes) {
  Table table{.id = "changes", .title = "Against the older profile",
              .caption = "Ratios above 1 are slower. Corrected: times the triad's gain, as if the machine had been equally fast. "
                         "A regression fails: every new time is above every old one, and both ratios are above 1.05.",
              .columns = {{.name = "what"}, {.name = "before", .unit = "ms"}, {.name = "now", .unit = "ms"},
                          {.name = "ratio"}, {.name = "corrected"}, {.name = "note"}}};
  for (const ProfileChange& c : changes) {
    const bool faster = c.after.max < c.before.min && c.ratio < 1 / kNoise;
    table.rows.push_back({{c.name, 1e3 * c.before.median, 1e3 * c.after.median, c.ratio, c.corrected,
                           std::string(c.regression ? "regression" : faster ? "faster" : "within noise")},
                          c.regression ? RowState::fail : RowState::pass});
  }
  return table;
}

}  // namespace turbid
