// SPDX-License-Identifier: Apache-2.0
// Chrome's trace event format, JSON object form: opens in Perfetto and chrome://tracing.
#include <algorithm>

#include "host/report/json_parts.h"
#include "host/report/profile_report.h"

namespace turbid {
namespace {

constexpr int kProcess = 1;

Json name_of_track(int track, const std::string& name) {
  return {{"ph", "M"}, {"pid", kProcess}, {"tid", track}, {"name", "thread_name"}, {"args", {{"name", name}}}};
}

}  // namespace

std::string chrome_trace(const Frame& frame) {
  struct Event {
    double begin, end;
    int track;
    std::string name;
    Json arguments;
  };
  std::vector<std::string> tracks{"host stages", "host calls"};
  const auto track_of = [&](const std::string& queue) {
    const std::string name = "queue " + queue;
    const auto found = std::find(tracks.begin(), tracks.end(), name);
    if (found != tracks.end()) return static_cast<int>(found - tracks.begin());
    tracks.push_back(name);
    return static_cast<int>(tracks.size()) - 1;
  };
  std::vector<Event> events;
  for (const cl::HostStage& s : frame.stages) events.push_back({s.started, s.ended, 0, s.name, Json::object()});
  for (const cl::BuiltProgram& b : frame.programs)
    events.push_back({b.started, b.ended, 1, "build " + b.file, {{"options", b.options}}});
  for (const cl::Command& c : frame.commands) {
    events.push_back({c.called, c.returned, 1, "enqueue " + c.name, Json::object()});
    events.push_back({c.started, c.ended, track_of(c.queue), c.name,
                      {{"program", c.program},
                       {"stage", c.stage},
                       {"global", {c.global[0], c.global[1]}},
                       {"local", {c.local[0], c.local[1]}},
                       {"bytes", c.bytes()},
                       {"queued_us", 1e6 * (c.queued - frame.started)},
                       {"submitted_us", 1e6 * (c.submitted - frame.started)}}});
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.begin < b.begin; });
  Json list = Json::array();
  list.push_back({{"ph", "M"}, {"pid", kProcess}, {"name", "process_name"}, {"args", {{"name", "turbid"}}}});
  for (std::size_t i = 0; i < tracks.size(); ++i) list.push_back(name_of_track(static_cast<int>(i), tracks[i]));
  for (const Event& e : events) {
    list.push_back({{"ph", "X"},
                    {"pid", kProcess},
                    {"tid", e.track},
                    {"ts", 1e6 * (e.begin - frame.started)},
                    {"dur", 1e6 * std::max(0.0, e.end - e.begin)},
                    {"name", e.name},
                    {"args", e.arguments}});
  }
  return document(Json{{"displayTimeUnit", "ms"}, {"traceEvents", list}});
}

}  // namespace turbid
