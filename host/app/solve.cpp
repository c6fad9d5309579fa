// SPDX-License-Identifier: Apache-2.0
// turbid solve: a scene in, the fluence as an OpenVDB file out.
#include <memory>

#include "host/app/command.h"
#include "host/app/options.h"
#include "host/app/output.h"
#include "host/app/pipeline.h"
#include "host/report/run_report.h"
#include "host/study/run_warnings.h"

namespace turbid::app {
namespace {

struct SolveOptions : SceneOptions {
  std::string output;
};

void solve(const SolveOptions& options) {
  const cl::DeviceChoice choice = cl::choose_device(options.device);
  const std::filesystem::path output = vdb_output(options.output, options.scene, "fluence.vdb");
  Progress progress(options.verbosity());
  const VoxelisedScene in = read_and_voxelise(options, progress);
  for (const std::string& sentence : in.warnings) progress.warn(sentence);

  cl::Session session(choice);
  progress.detail("device " + choice.device.label() + ": " + choice.reason);
  const LightSolution solution = solve_light(session, in, progress);
  for (const std::string& sentence : run_warnings(solution.report, in.scene.solver)) progress.warn(sentence);
  const std::optional<ErrorEstimate> error = estimate_error(session, in, solution, nullptr, progress);
  progress.stage("write");
  const FolderInUse folder(output.parent_path());
  write_fluence_vdb(solution.volume, in.medium, output.string(), in.scene.unit, error_metadata(error));
  progress.finish();

  RunReport report = run_report(in, choice, solution, error, progress);
  report.outputs = {{"vdb", output.string()}};
  print(options.json ? report_json(report) : report_text(report, options.quiet));
  require_balance(solution.report.energy);
}

}  // namespace

void add_solve(CLI::App& program, Work& work) {
  const auto options = std::make_shared<SolveOptions>();
  CLI::App& command = *program.add_subcommand("solve", "Solve for the fluence in a scene, as OpenVDB grids");
  add_scene_options(command, *options);
  add_solver_options(command, *options);
  command
      .add_option("-o,--output", options->output,
                  "File for the fluence, the deposit and the medium's grids (default: out/NAME/fluence.vdb)")
      ->type_name("FILE.vdb");
  command.footer("Example:\n  turbid solve scenes/bunny.toml -o bunny-fluence.vdb --json");
  command.callback([options, &work] { work = [options] { solve(*options); }; });
}

}  // namespace turbid::app
