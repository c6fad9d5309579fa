// SPDX-License-Identifier: Apache-2.0
// How time grows with voxels, their active share, pixels and lights: warm frames of scenes/sphere.toml.
#include <cmath>

#include "host/bench/light_run.h"
#include "host/bench/paper.h"

namespace turbid {
namespace {

constexpr double kDegree = 3.14159265358979 / 180;

std::vector<double> row_of(double x, LightRun& run) {
  return {x, static_cast<double>(run.solution().report.active_voxels), 1e3 * run.frame_seconds().median,
          1e3 * run.frame_seconds().min, 1e3 * run.frame_seconds().max, 1e3 * run.stage("march").median,
          1e3 * run.stage("diffuse").median, 1e3 * run.view_seconds().median,
          static_cast<double>(run.solution().report.iterations), run.solution().report.error_estimate};
}

std::vector<Quantity> columns_of(Quantity x) {
  return {std::move(x), {"active voxels"}, {"frame", "ms"}, {"min", "ms"}, {"max", "ms"}, {"march", "ms"},
          {"diffuse", "ms"}, {"view", "ms"}, {"iterations"}, {"estimated error"}};
}

std::vector<std::string> picture(const BenchSettings& settings) {
  const std::string edge = settings.quick ? "64" : "512";
  return {"camera.width=" + edge, "camera.height=" + edge, "camera.samples=1"};
}

/// Exponents of frame, march, diffuse and view in column x.
std::string exponents(const Experiment& e, int x) {
  std::string text;
  for (const auto& [name, column] : {std::pair{"frame", 2}, {"march", 5}, {"diffuse", 6}, {"view", 7}}) {
    std::vector<double> xs, ys;
    for (const auto& row : e.rows) {
      xs.push_back(row[x]);
      ys.push_back(row[column]);
    }
    text += figures("%s%s %.2f", text.empty() ? "" : ", ", name, exponent_of(xs, ys));
  }
  return text;
}

Experiment sweep(cl::Session& session, const BenchSettings& settings, Experiment e, const std::vector<double>& values,
                 const std::function<std::pair<SceneOverrides, std::function<void(Scene&)>>(double)>& of) {
  for (const double value : values) {
    auto [overrides, change] = of(value);
    LightRun run(session, settings.scene("sphere.toml"), overrides, change);
    run_interleaved({&run}, 3, true);
    e.rows.push_back(row_of(value, run));
  }
  return e;
}

Experiment voxels(cl::Session& session, const BenchSettings& settings) {
  Experiment e{.id = "voxels", .title = "Voxels", .method = "Sphere of milk, steady solver, warm frames.",
               .columns = columns_of({"resolution"}), .plot_x = 1, .plot_y = {2, 5, 6, 7}, .log_x = true, .log_y = true};
  const std::vector<double> levels = settings.quick ? std::vector<double>{16, 32, 48} : std::vector<double>{32, 48, 64, 96, 128, 192, 256};
  e = sweep(session, settings, std::move(e), levels, [&](double n) {
    SceneOverrides o;
    o.resolution = static_cast<int>(n);
    o.settings = picture(settings);
    return std::pair{o, std::function<void(Scene&)>{}};
  });
  e.found = "Exponents in active voxels: " + exponents(e, 1) + ".";
  return e;
}

Experiment fraction(cl::Session& session, const BenchSettings& settings) {
  Experiment e{.id = "fraction", .title = "Active fraction",
               .method = "Spheres of different radius in one domain: only blocks in which something happens should cost.",
               .columns = columns_of({"radius", "mm"}), .plot_x = 1, .plot_y = {2, 6}, .log_x = true, .log_y = true};
  e = sweep(session, settings, std::move(e), {20, 16, 12, 8, 5}, [&](double radius) {
    SceneOverrides o;
    o.resolution = settings.quick ? 48 : 128;
    o.settings = picture(settings);
    o.settings.insert(o.settings.end(), {"domain.min=[-21,-1,-21]", "domain.max=[21,41,21]",
                                         "object.0.radius=" + figures("%g", radius)});
    return std::pair{o, std::function<void(Scene&)>{}};
  });
  e.found = "Exponents in active voxels at one size of the domain: " + exponents(e, 1) + ".";
  return e;
}

Experiment pixels(cl::Session& session, const BenchSettings& settings) {
  Experiment e{.id = "pixels", .title = "Pixels", .method = "Sphere of milk at a fixed resolution, one sample per pixel.",
               .columns = columns_of({"pixels"}), .plot_x = 0, .plot_y = {2, 7}, .log_x = true, .log_y = true};
  const std::vector<double> edges = settings.quick ? std::vector<double>{64, 128, 256} : std::vector<double>{128, 256, 512, 1024, 2048};
  e = sweep(session, settings, std::move(e), edges, [&](double edge) {
    SceneOverrides o;
    o.resolution = settings.quick ? 32 : 96;
    const std::string text = figures("%g", edge);
    o.settings = {"camera.width=" + text, "camera.height=" + text, "camera.samples=1"};
    return std::pair{o, std::function<void(Scene&)>{}};
  });
  for (auto& row : e.rows) row[0] *= row[0];
  e.found = "Exponents in pixels: " + exponents(e, 0) + ".";
  return e;
}

Experiment lights(cl::Session& session, const BenchSettings& settings) {
  Experiment e{.id = "lights", .title = "Lights", .method = "The sphere's spot light repeated around it.",
               .columns = columns_of({"lights"}), .plot_x = 0, .plot_y = {2, 5, 6}, .log_x = true, .log_y = true};
  const std::vector<double> counts = settings.quick ? std::vector<double>{1, 2, 4} : std::vector<double>{1, 2, 4, 8, 16};
  e = sweep(session, settings, std::move(e), counts, [&](double count) {
    SceneOverrides o;
    o.resolution = settings.quick ? 32 : 96;
    o.settings = picture(settings);
    const std::function<void(Scene&)> more = [count](Scene& scene) {
      const Light first = scene.lights.at(0);
      for (int i = 1; i < static_cast<int>(count); ++i) {
        const double angle = 360 * kDegree * i / count, c = std::cos(angle), s = std::sin(angle);
        const auto turned = [&](glm::vec3 v) { return glm::vec3(c * v.x + s * v.z, v.y, c * v.z - s * v.x); };
        Light light = first;
        light.position = turned(first.position);
        light.direction = turned(first.direction);
        scene.lights.push_back(light);
      }
    };
    return std::pair{o, more};
  });
  e.found = "Exponents in lights: " + exponents(e, 0) + ". All lights are diffused in one solve.";
  return e;
}

}  // namespace

const std::vector<NamedExperiment>& scaling_experiments() {
  static const std::vector<NamedExperiment> list{
      {"voxels", voxels}, {"fraction", fraction}, {"pixels", pixels}, {"lights", lights},
      {"specialised", specialised_or_general}, {"colours", colours_together_or_apart}};
  return list;
}

}  // namespace turbid
