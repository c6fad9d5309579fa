// SPDX-License-Identifier: Apache-2.0
// turbid voxelise: a scene in, the medium's grids as an OpenVDB file out. Needs no OpenCL.
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/app/pipeline.h"
#include "host/report/scene_report.h"

namespace turbid::app {
namespace {

struct VoxeliseOptions : SceneOptions {
  std::string output;
};

void run(const VoxeliseOptions& options) {
  const std::filesystem::path output = vdb_output(options.output, options.scene, "medium.vdb");
  Progress progress(options.verbosity());
  const VoxelisedScene in = read_and_voxelise(options, progress);
  for (const std::string& sentence : in.warnings) progress.warn(sentence);
  progress.stage("write");
  const FolderInUse folder(output.parent_path());
  in.medium.write_vdb(output.string(), in.scene.unit);
  progress.finish();
  const SceneReport report{in.scene, in.features, in.survey, progress.warnings(), output.string()};
  print(options.json ? scene_json(report)
                     : "medium     " + output.string() + "\n" + (options.quiet ? "" : grid_text(report)));
}

}  // namespace

void add_voxelise(CLI::App& program, Work& work) {
  const auto options = std::make_shared<VoxeliseOptions>();
  CLI::App& command = *program.add_subcommand("voxelise", "Turn a scene's meshes and materials into OpenVDB grids");
  add_scene_options(command, *options);
  command.add_option("-o,--output", options->output, "File for the grids (default: out/NAME/medium.vdb)")
      ->type_name("FILE.vdb");
  command.footer("Example:\n  turbid voxelise scenes/bunny.toml -o bunny-medium.vdb --resolution 64");
  command.callback([options, &work] { work = [options] { run(*options); }; });
}

}  // namespace turbid::app
