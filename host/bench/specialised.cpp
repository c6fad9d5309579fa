// SPDX-License-Identifier: Apache-2.0
// What it saves to build for a scene only what it needs: whole warm frames beside the general path, interleaved; and
// three colours solved together or apart.
#include "host/bench/hard_media.h"
#include "host/bench/light_run.h"
#include "host/bench/paper.h"
#include "host/profile/profile.h"
#include "host/study/error_measures.h"
#include "host/study/photon_reference.h"
#include "host/transport/steady.h"

namespace turbid {
Experiment specialised_or_general(cl::Session& session, const BenchSettings& settings) {
  constexpr double kMega = 1e-6;
  const int resolution = settings.quick ? 24 : 96, edge = settings.quick ? 64 : 384;
  Experiment e{
      .id = "specialised",
      .title = "Only what a scene needs",
      .method = figures(
          "Warm frames at %d^3 and %d^2 pixels, built for the scene's own physics, and for all there is (graded "
          "index, interfaces, varying anisotropic coefficients, three colours), interleaved.",
          resolution, edge),
      .columns = {{"specialised", "ms"},
                  {"general", "ms"},
                  {"general / specialised"},
                  {"light alone, general / specialised"},
                  {"device memory", "MB"},
                  {"general", "MB"},
                  {"pictures differ", "rel-L2"}}};
  std::string found;
  for (const char* name : {"glass", "fog", "sphere", "bunny"}) {
    SceneOverrides overrides;
    overrides.resolution = resolution;
    overrides.settings = {"camera.width=" + std::to_string(edge), "camera.height=" + std::to_string(edge)};
    const std::size_t empty = session.memory().now;
    LightRun own(session, settings.scene(std::string(name) + ".toml"), overrides);
    const std::size_t with_own = session.memory().now;
    LightRun general(session, own, {}, general_features);
    const std::size_t with_both = session.memory().now;
    run_interleaved({&own, &general}, settings.repeats(), true);
    const double factor = general.frame_seconds().median / own.frame_seconds().median;
    e.labels.push_back(name);
    e.rows.push_back({1e3 * own.frame_seconds().median, 1e3 * general.frame_seconds().median, factor,
                      general.seconds().median / own.seconds().median, kMega * static_cast<double>(with_own - empty),
                      kMega * static_cast<double>(with_both - with_own),
                      relative_l2(rgb_values(general.image()), rgb_values(own.image()))});
    found += figures("%s%s %.2f", found.empty() ? "" : ", ", name, factor);
  }
  e.found = "What the scenes do not need would multiply their frame's time: " + found + ".";
  return e;
}

Experiment colours_together_or_apart(cl::Session& session, const BenchSettings& settings) {
  const int n = settings.quick ? 32 : 96;
  Experiment e{
      .id = "colours",
      .title = "Three colours together or apart",
      .method = figures("steady, s = 1 at %d^3, equal colours: one solve of three channels, or three solves of one, "
                        "interleaved.",
                        n),
      .columns = {{"together", "ms"},
                  {"apart", "ms"},
                  {"apart / together"},
                  {"iterations"},
                  {"of each apart"},
                  {"difference", "rel-L2"}}};
  double least = 1e9, most = 0;
  bool same_count = true;
  for (const HardMedium kind : {HardMedium::homogeneous, HardMedium::random, HardMedium::sphere}) {
    const DiffusionMedium three = hard_medium(kind, n, 1, 0.9999, 3), one = hard_medium(kind, n, 1, 0.9999, 1);
    const std::vector<float> q3 = beam_source(three), q1 = beam_source(one);
    SteadySolve together(session, three, {}), apart(session, one, {});
    SteadyResult all, single;
    std::vector<double> a, b;
    for (int i = 0; i <= settings.repeats(); ++i) {
      const double started = wall_time();
      all = together.solve(q3);
      const double between = wall_time();
      for (int c = 0; c < 3; ++c) single = apart.solve(q1);
      const double ended = wall_time();
      if (i == 0) continue;
      a.push_back(between - started);
      b.push_back(ended - between);
    }
    const double ratio = spread_of(b).median / spread_of(a).median;
    least = std::min(least, ratio);
    most = std::max(most, ratio);
    same_count = same_count && all.iterations == single.iterations;
    const std::vector<float> first(all.u.begin(), all.u.begin() + static_cast<std::ptrdiff_t>(single.u.size()));
    e.labels.push_back(name_of(kind));
    e.rows.push_back({1e3 * spread_of(a).median, 1e3 * spread_of(b).median, ratio, static_cast<double>(all.iterations),
                      static_cast<double>(single.iterations), relative_l2(first, single.u)});
  }
  e.found = figures("Apart takes %.2f to %.2f of the time of together, by %s number of iterations.", least, most,
                    same_count ? "the same" : "another");
  return e;
}

}  // namespace turbid
