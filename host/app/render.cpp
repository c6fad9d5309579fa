// SPDX-License-Identifier: Apache-2.0
// turbid render: a scene in, pictures and a report out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/app/pipeline.h"
#include "host/base/atomic_file.h"
#include "host/base/errors.h"
#include "host/report/checksum.h"
#include "host/report/run_report.h"
#include "host/study/choose_settings.h"
#include "host/study/picture_metadata.h"
#include "host/study/run_warnings.h"

namespace turbid::app {
namespace {

constexpr int kProbeVoxels = 48;  // of the small run that --error chooses by

struct RenderOptions : SceneOptions {
  std::string output;
};

std::size_t pixels_not_finite(const ViewImage& image) {
  std::size_t count = 0;
  for (const glm::vec4& pixel : image.colour)
    if (!std::isfinite(pixel.x + pixel.y + pixel.z + pixel.w)) ++count;
  return count;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Settings for the asked error, chosen by the estimate of a small run and put into the options. Returns what was
/// chosen and why; nothing for the photon solver, which takes the error itself.
std::string choose(RenderOptions& options, const cl::DeviceChoice& choice, Progress& progress) {
  progress.stage("choose");
  SceneOverrides overrides = options.overrides;
  if (!overrides.resolution) overrides.resolution = kProbeVoxels;
  Scene scene = read_scene(options.scene, overrides);
  if (!scene.has_camera || scene.solver.solver == "photon") return "";
  if (!(*options.error > 0)) throw InputError("--error 0: expected an error in (0, 1] to choose settings for");
  scene.solver.error_estimate = EstimateEffort::full;  // what is chosen by it costs more than it
  Progress quiet(Verbosity::quiet);
  cl::Session session(choice);
  const SceneOnGrid on_grid = put_on_grid(std::move(scene), quiet);
  const LightSolution solution = solve_light(session, on_grid, quiet);
  ViewPass view = view_of(session, on_grid, solution);
  const ErrorEstimate estimate = *estimate_error(session, on_grid, solution, &view, quiet);
  const SolverSettings& used = on_grid.scene.solver;
  const glm::ivec3 voxels = on_grid.scene.medium.frame.voxels;
  const ChosenSettings chosen = choose_settings(*estimate.image, estimate.scatter_of_one,
                                                {std::max({voxels.x, voxels.y, voxels.z}), used.march.step_in_voxels,
                                                 used.march.rays_per_face, used.steady.tolerance},
                                                *options.error);
  progress.finish();
  if (!options.overrides.resolution) options.overrides.resolution = chosen.with.voxels;
  const std::string grid = std::to_string(*options.overrides.resolution) + " voxels, ";
  std::vector<std::string>& settings = options.overrides.settings;
  if (chosen.photon) {
    options.overrides.solver = "photon";
    const auto photons = static_cast<std::int64_t>(chosen.photons);
    settings.push_back("solver.photon.photons=" + std::to_string(photons));
    settings.push_back("solver.photon.error=0");  // --error is the picture's, this would be the fluence's
    return grid + number(chosen.photons) + " photons: " + chosen.reason;
  }
  settings.push_back("solver.march.step_in_voxels=" + number(chosen.with.step));
  settings.push_back("solver.march.rays_per_face=" + number(chosen.with.rays));
  settings.push_back("solver.tolerance=" + number(chosen.with.tolerance));
  return grid + "step " + number(chosen.with.step) + ", " + number(chosen.with.rays) + " rays per face, tolerance " +
         number(chosen.with.tolerance) + ": " + chosen.reason;
}

void render(RenderOptions options) {
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  const RenderOutput output = render_output(options.output, options.scene);
  Progress progress(options.verbosity());
  const std::string chosen = options.error ? choose(options, choice, progress) : "";
  const VoxelisedScene in = read_and_voxelise(options, progress);
  if (!in.scene.has_camera)
    throw InputError(options.scene + ": has no [camera], so there is nothing to render; turbid solve needs none");
  for (const std::string& sentence : in.warnings) progress.warn(sentence);

  cl::Session session(choice);
  progress.detail("device " + choice.device.label() + ": " + choice.reason);
  const LightSolution solution = solve_light(session, in, progress);
  for (const std::string& sentence : run_warnings(solution.report, in.scene.solver)) progress.warn(sentence);
  progress.stage("view");
  ViewPass view = view_of(session, in, solution);
  const ViewImage image = view.look(in.scene.camera, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  const std::optional<ErrorEstimate> error = estimate_error(session, in, solution, &view, progress);
  if (!chosen.empty() && error && error->image->total() > *options.error)
    progress.warn("the picture's estimated error is " + number(error->image->total()) + ", more than the " +
                  number(*options.error) + " asked for; its parts are in the report");

  progress.stage("write");
  const FolderInUse folder(output.folder);
  const float exposure = in.scene.film.exposure ? *in.scene.film.exposure : automatic_exposure(image);
  ImageMetadata metadata = picture_metadata(in, choice.device, solution.report, progress.times());
  metadata.numbers.merge(error_metadata(error));
  write_exr(image, metadata, output.exr);
  write_png_preview(image, exposure, output.png);
  progress.finish();
  RunReport report = run_report(in, choice, solution, error, progress);
  report.outputs = {{"exr", output.exr}, {"png", output.png}, {"report", output.report}};
  report.checksums.emplace_back("picture", checksum(image.colour, image.direct, image.scattered));
  report.exposure = exposure;
  report.chosen = chosen;
  const std::string json = report_json(report);
  write_file_atomically(output.report, json.data(), json.size());
  print(options.json ? json : report_text(report, options.quiet));

  if (const std::size_t bad = pixels_not_finite(image))
    throw VerificationError(output.exr + ": " + std::to_string(bad) + " pixels are not finite");
  require_balance(solution.report.energy);
}

}  // namespace

void add_render(CLI::App& program, Work& work) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App& command = *program.add_subcommand("render", "Render a scene to EXR and PNG");
  add_scene_options(command, *options);
  add_solver_options(command, *options);
  command
      .add_option("-o,--output", options->output,
                  "Folder for NAME.exr, NAME.png and report.json (default: out/NAME), or a file that ends in .exr, "
                  "beside which .png and .report.json are written")
      ->type_name("DIR|FILE.exr");
  command.footer(
      "Example:\n"
      "  turbid render scenes/bunny.toml -o pictures -D camera.width=1024 -D camera.height=1024 --resolution 192\n"
      "  turbid render scenes/bunny.toml --error 0.1");
  command.callback([options, &work] { work = [options] { render(*options); }; });
}

}  // namespace turbid::app
