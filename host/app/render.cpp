// SPDX-License-Identifier: Apache-2.0
// turbid render: a scene in, pictures and a report out.
#include <cmath>
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/app/pipeline.h"
#include "host/base/atomic_file.h"
#include "host/base/errors.h"
#include "host/report/checksum.h"
#include "host/report/run_report.h"
#include "host/study/picture_metadata.h"
#include "host/study/run_warnings.h"

namespace turbid::app {
namespace {

struct RenderOptions : SceneOptions {
  std::string output;
};

std::size_t pixels_not_finite(const ViewImage& image) {
  std::size_t count = 0;
  for (const glm::vec4& pixel : image.colour)
    if (!std::isfinite(pixel.x + pixel.y + pixel.z + pixel.w)) ++count;
  return count;
}

void render(const RenderOptions& options) {
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  const RenderOutput output = render_output(options.output, options.scene);
  Progress progress(options.verbosity());
  const VoxelisedScene in = read_and_voxelise(options, progress);
  if (!in.scene.has_camera)
    throw InputError(options.scene + ": has no [camera], so there is nothing to render; turbid solve needs none");
  for (const std::string& sentence : in.warnings) progress.warn(sentence);

  cl::Session session(choice);
  progress.detail("device " + choice.device.label() + ": " + choice.reason);
  const LightSolution solution = solve_light(session, in, progress);
  for (const std::string& sentence : run_warnings(solution.report, in.scene.solver)) progress.warn(sentence);
  const ViewImage image = look_at(session, in, solution, progress);

  progress.stage("write");
  const FolderInUse folder(output.folder);
  const float exposure = in.scene.film.exposure ? *in.scene.film.exposure : automatic_exposure(image);
  write_exr(image, picture_metadata(in, choice.device, solution.report, progress.times()), output.exr);
  write_png_preview(image, exposure, output.png);
  progress.finish();
  RunReport report = run_report(in, choice, solution, progress);
  report.outputs = {{"exr", output.exr}, {"png", output.png}, {"report", output.report}};
  report.checksums.emplace_back("picture", checksum(image.colour, image.direct, image.scattered));
  report.exposure = exposure;
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
      "  turbid render scenes/bunny.toml -o pictures -D camera.width=1024 -D camera.height=1024 --resolution 192");
  command.callback([options, &work] { work = [options] { render(*options); }; });
}

}  // namespace turbid::app
