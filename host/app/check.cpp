// SPDX-License-Identifier: Apache-2.0
// turbid check: validates a scene and says what it needs. What it prints is the effective scene, a scene file again,
// with everything else in comments.
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/pipeline.h"
#include "host/base/errors.h"
#include "host/report/scene_report.h"

namespace turbid::app {
namespace {

/// The device if there is one; a scene can be checked without.
void look_at_device(const SceneOptions& options, SceneReport& report) {
  try {
    report.device = cl::choose_device(options.device);
  } catch (const InputError& error) {
    if (!options.device.empty()) throw;
    report.warnings.push_back(error.what());
    return;
  }
  const double bytes = static_cast<double>(report.survey.memory_bytes),
               offered = static_cast<double>(report.device->device.global_memory);
  if (bytes > offered)
    report.warnings.push_back("needs about " + megabytes(report.survey.memory_bytes) + ", more than the " +
                              megabytes(report.device->device.global_memory) + " of " + report.device->device.label() +
                              ": lower the resolution");
}

void check(const SceneOptions& options) {
  Progress progress(options.verbosity());
  const VoxelisedScene in = read_and_voxelise(options, progress);
  SceneReport report{in.scene, in.features, in.survey, in.warnings, {}};
  look_at_device(options, report);
  print(options.json ? scene_json(report) : scene_text(report));
}

}  // namespace

void add_check(CLI::App& program, Work& work) {
  const auto options = std::make_shared<SceneOptions>();
  CLI::App& command = *program.add_subcommand("check", "Validate a scene and say what it needs");
  add_scene_options(command, *options);
  add_solver_options(command, *options);
  command.footer(
      "Example:\n"
      "  turbid check scenes/bunny.toml --resolution 256\n"
      "  turbid check scenes/bunny.toml -D camera.fov=20 > closer.toml   (the output is a scene file again)");
  command.callback([options, &work] { work = [options] { check(*options); }; });
}

}  // namespace turbid::app
