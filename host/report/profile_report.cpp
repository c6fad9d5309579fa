// SPDX-License-Identifier: Apache-2.0
// Tables and pictures of a profile.
#include "host/report/profile_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/report/scene_report.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

constexpr double kMs = 1e3, kGiga = 1e-9;

Cell count(double value) { return static_cast<std::int64_t>(std::llround(value)); }

Table ceiling_table(const Ceilings& c) {
  Table table{.id = "ceilings", .title = "What this device can do at best",
              .caption = "Measured by kernels of our own before and after the frames; every fraction below is of the medians.",
              .columns = {{.name = "ceiling"}, {.name = "median"}, {.name = "least"}, {.name = "most"}, {.name = "unit"},
                          {.name = "samples"}}};
  const auto add = [&](const char* name, const Spread& s, double scale, const char* unit) {
    table.rows.push_back({{std::string(name), s.median * scale, s.min * scale, s.max * scale, std::string(unit),
                           std::int64_t{s.count}}});
  };
  add("triad", c.triad, kGiga, "GB/s");
  add("copy", c.copy, kGiga, "GB/s");
  add("fused multiply-add", c.multiply_add, kGiga, "GFLOP/s");
  add("launch, many in a row", c.launch, 1e6, "µs");
  add("launch and wait", c.launch_and_wait, 1e6, "µs");
  return table;
}

Table frame_table(const Profile& p) {
  Table table{.id = "frame", .title = "Warm frame",
              .caption = "March, solve and view of the prepared scene, the second time and later. Overlapping commands count "
                         "once; the host's share is the time in which no command runs.",
              .columns = {{.name = "part"}, {.name = "median", .unit = "ms"}, {.name = "min", .unit = "ms"},
                          {.name = "max", .unit = "ms"}, {.name = "of the frame", .digits = 2, .style = NumberStyle::fixed},
                          {.name = "repeats"}}};
  const auto add = [&](const char* name, const Spread& s) {
    table.rows.push_back({{std::string(name), s.median * kMs, s.min * kMs, s.max * kMs, s.median / p.frame.median,
                           std::int64_t{s.count}}});
  };
  add("frame", p.frame);
  add("kernels running", p.kernels);
  add("any command running", p.device);
  if (p.general.count > 0) add("frame, general path", p.general);
  return table;
}

Table stage_table(const Profile& p) {
  Table table{.id = "stages", .title = "Stages of a warm frame",
              .caption = "Device: at least one command enqueued in the stage is running. Host: the rest of the stage.",
              .columns = {{.name = "stage"}, {.name = "median", .unit = "ms"}, {.name = "min", .unit = "ms"},
                          {.name = "max", .unit = "ms"}, {.name = "device", .unit = "ms"}, {.name = "host", .unit = "ms"},
                          {.name = "commands"}}};
  for (const StageProfile& s : p.stages) {
    table.rows.push_back({{s.name, s.seconds.median * kMs, s.seconds.min * kMs, s.seconds.max * kMs, s.device.median * kMs,
                           s.host.median * kMs, std::int64_t{s.commands}}});
  }
  return table;
}

Table kernel_table(const Profile& p) {
  Table table{.id = "kernels", .title = "Kernels and copies of a warm frame",
              .caption = "Times are of all calls of one frame; bytes and operations are counted from the algorithm (below), "
                         "fractions are of the triad and of fused multiply-adds. Above 1: caches keep what is counted as "
                         "memory traffic.",
              .columns = {{.name = "kernel"}, {.name = "program"}, {.name = "queue"}, {.name = "calls"},
                          {.name = "median", .unit = "ms"}, {.name = "min", .unit = "ms"}, {.name = "max", .unit = "ms"},
                          {.name = "per call", .unit = "µs"}, {.name = "bytes", .unit = "MB"},
                          {.name = "operations", .unit = "MFLOP"}, {.name = "bandwidth", .unit = "GB/s"},
                          {.name = "of triad", .digits = 2}, {.name = "rate", .unit = "GFLOP/s"},
                          {.name = "of multiply-add", .digits = 2}}};
  for (const KernelProfile& k : p.commands) {
    const bool counted = k.work.operations > 0;
    table.rows.push_back({{k.name, k.program, k.queue, std::int64_t{k.calls}, k.frame_seconds.median * kMs,
                           k.frame_seconds.min * kMs, k.frame_seconds.max * kMs, k.call_seconds.median * 1e6,
                           k.work.bytes * 1e-6, counted ? Cell(k.work.operations * 1e-6) : Cell(), k.bandwidth() * kGiga,
                           k.bandwidth() / p.ceilings.triad.median, counted ? Cell(k.rate() * kGiga) : Cell(),
                           counted ? Cell(k.rate() / p.ceilings.multiply_add.median) : Cell()}});
  }
  return table;
}

Table work_table(const Profile& p) {
  Table table{.id = "counts", .title = "How bytes and operations are counted",
              .columns = {{.name = "kernel"}, {.name = "counted"}}};
  for (const KernelProfile& k : p.commands) table.rows.push_back({{k.name, k.work.counted}});
  return table;
}

Table ray_table(const Profile& p) {
  Table table{.id = "rays", .title = "Work of the ray kernels in one frame", .columns = {{.name = "quantity"}, {.name = "count"}}};
  const std::vector<std::pair<const char*, double>> counts{
      {"light rays", p.rays.rays},           {"steps of light rays", p.rays.march_steps},
      {"deposits", p.rays.deposits},         {"surfaces met by light rays", p.rays.interfaces},
      {"camera samples", p.rays.samples},    {"steps of camera paths", p.rays.view_steps}};
  for (const auto& [name, value] : counts) table.rows.push_back({{std::string(name), count(value)}});
  return table;
}

Plot roofline(const Profile& p) {
  const double peak = p.ceilings.multiply_add.median * kGiga, triad = p.ceilings.triad.median * kGiga;
  Plot plot{.id = "roofline", .title = "Roofline",
            .caption = "Each kernel by its operations per byte; the roof is what triad and fused multiply-adds reach on this "
                       "device. Points above the slope live in caches.",
            .x = {.label = "arithmetic intensity", .unit = "FLOP/byte", .log = true},
            .y = {.label = "rate", .unit = "GFLOP/s", .log = true}};
  double low = 0.03, high = 2 * peak / triad;
  for (const KernelProfile& k : p.commands) {
    if (k.work.operations <= 0) continue;
    low = std::min(low, k.work.operations / k.work.bytes / 2);
    high = std::max(high, k.work.operations / k.work.bytes * 2);
  }
  plot.series.push_back({.name = "roof", .x = {low, peak / triad, high}, .y = {low * triad, peak, peak}, .markers = false,
                         .highlighted = true});
  for (const KernelProfile& k : p.commands) {
    if (k.work.operations <= 0) continue;
    plot.series.push_back({.name = k.name, .x = {k.work.operations / k.work.bytes}, .y = {k.rate() * kGiga}, .line = false,
                           .point_labels = {k.name}});
  }
  return plot;
}

Timeline timeline(const Frame& frame) {
  Timeline result{.id = "timeline", .title = "The frame of median length",
                  .caption = "Gaps in a queue are the host's: rasterising, gathering, scalars of the solve. Overlapping "
                             "intervals of two queues prove no gain; only the wall clock does."};
  const auto ms = [&](double time) { return (time - frame.started) * kMs; };
  Track host{.name = "host"};
  for (const cl::HostStage& stage : frame.stages) host.intervals.push_back({stage.name, ms(stage.started), ms(stage.ended)});
  result.tracks.push_back(host);
  for (const char* queue : {"march", "lattice"}) {
    Track track{.name = queue};
    for (const cl::Command& command : frame.commands)
      if (command.queue == queue) track.intervals.push_back({command.name, ms(command.started), ms(command.ended)});
    if (!track.intervals.empty()) result.tracks.push_back(track);
  }
  return result;
}

BarChart stage_bars(const Profile& p) {
  BarChart chart{.id = "stage_bars", .title = "Stages", .value = {.label = "time", .unit = "ms"}};
  BarSeries device{.name = "device"}, host{.name = "host"};
  for (const StageProfile& s : p.stages) {
    chart.groups.push_back(s.name);
    device.values.push_back(s.device.median * kMs);
    host.values.push_back(s.host.median * kMs);
  }
  chart.series = {device, host};
  return chart;
}

Section memory_section(const Profile& p) {
  Table stages{.id = "memory_stages", .title = "Device memory asked for, by stage",
               .columns = {{.name = "stage"}, {.name = "allocated", .unit = "MB"}}};
  for (const auto& [stage, bytes] : p.memory_by_stage)
    stages.rows.push_back({{stage.empty() ? std::string("(between stages)") : stage, 1e-6 * static_cast<double>(bytes)}});
  Table buffers{.id = "buffers", .title = "Buffers that kernels were given",
                .columns = {{.name = "buffer"}, {.name = "first used by"}, {.name = "buffers"}, {.name = "size", .unit = "MB"}}};
  for (const BufferUse& b : p.buffers)
    buffers.rows.push_back({{b.argument, b.kernel, std::int64_t{b.buffers}, 1e-6 * static_cast<double>(b.bytes)}});
  Section section{.title = "Memory of the device", .parts = {}};
  section.parts.push_back(Paragraph{"Held now " + megabytes(p.memory_now) + ", at the most " + megabytes(p.memory_peak) +
                                    " while frames were computed."});
  section.parts.push_back(stages);
  section.parts.push_back(buffers);
  return section;
}

Section build_section(const Profile& p) {
  Table builds{.id = "builds", .title = "Programs built",
               .caption = "Apart from run time; drivers cache binaries, and compile once more at the first launch of each "
                          "work-group size, which the warm-up takes.",
               .columns = {{.name = "program"}, {.name = "stage"}, {.name = "time", .unit = "ms"}, {.name = "options"}}};
  for (const Frame* frame : {&p.preparation, &p.median_frame})
    for (const cl::BuiltProgram& b : frame->programs)
      builds.rows.push_back({{b.file, b.stage + (frame == &p.preparation ? "" : " (every frame)"),
                              (b.ended - b.started) * kMs, b.options}});
  Table once{.id = "preparation", .title = "Once per scene",
             .columns = {{.name = "stage"}, {.name = "time", .unit = "ms"}}};
  for (const cl::HostStage& s : p.preparation.stages) once.rows.push_back({{s.name, (s.ended - s.started) * kMs}});
  return {.title = "Preparation", .parts = {once, builds}};
}

}  // namespace

Document profile_document(const Profile& p, const std::string& scene, const NamedTexts& context) {
  Document document{.title = "Profile of " + scene, .context = context};
  document.summary = line("A warm frame takes %.1f ms (%.1f to %.1f over %d repeats), %.2f times the %.1f ms in which kernels "
                          "run; the solve's estimated error is %.1e.",
                          p.frame.median * kMs, p.frame.min * kMs, p.frame.max * kMs, p.frame.count,
                          p.frame.median / p.kernels.median, p.kernels.median * kMs, p.solver.error_estimate);
  if (p.general.count > 0)
    document.summary += line(" The general path takes %.1f ms: what the scene does not need would cost a factor of %.2f.",
                             p.general.median * kMs, p.general.median / p.frame.median);
  Section times{.title = "Time", .parts = {frame_table(p), stage_table(p), stage_bars(p), timeline(p.median_frame)}};
  Section kernels{.title = "Kernels", .parts = {kernel_table(p), roofline(p), ceiling_table(p.ceilings), ray_table(p), work_table(p)}};
  document.sections = {times, kernels, memory_section(p), build_section(p)};
  return document;
}

}  // namespace turbid
