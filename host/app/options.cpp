// SPDX-License-Identifier: Apache-2.0
// Declares the shared flags.
#include "host/app/options.h"

#include <cstdio>
#include <cstdlib>

namespace turbid::app {
namespace {

std::string the_command_line;

}  // namespace

void add_json_option(CLI::App& command, TalkOptions& options) {
  command.add_flag("--json", options.json, "Print the result as JSON, and nothing else, on standard output");
}

void add_talk_options(CLI::App& command, TalkOptions& options) {
  add_json_option(command, options);
  CLI::Option* verbose = command.add_flag("-v,--verbose", options.verbose, "Say more while working");
  command.add_flag("-q,--quiet", options.quiet, "Say nothing but warnings while working")->excludes(verbose);
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
  command.add_option("SCENE", options.scene, "The scene, a .toml file")->required();
  command
      .add_option("-D", options.overrides.settings,
                  "Override a key of the scene: -D camera.fov=30, -D light.0.power=[1,2,3]; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--resolution", options.overrides.resolution, "Voxels along the domain's longest side")
      ->type_name("N");
  add_talk_options(command, options);
}

void add_device_option(CLI::App& command, std::string& device) {
  command.add_option("--device", device, "OpenCL device: its number P:D in `turbid devices`, or part of its name")
      ->type_name("DEVICE");
}

void add_solver_options(CLI::App& command, SceneOptions& options) {
  add_device_option(command, options.device);
  command
      .add_option("--solver", options.overrides.solver,
                  "How to solve for the scattered light: steady, lattice or photon (Monte Carlo)")
      ->type_name("NAME");
  command.add_option("--seed", options.overrides.seed, "Shifts the grid of light rays; the same seed, the same bits")
      ->type_name("N");
  // Written as overrides, so that a bad value is told like that of any other key.
  const auto photon_key = [&](const char* flag, const char* key, const char* help, const char* type) {
    command
        .add_option_function<std::string>(
            flag,
            [&options, key](const std::string& value) {
              {
                options.overrides.settings.push_back(key + value);
                if (std::string(key) == "solver.photon.error=") options.error = std::strtod(value.c_str(), nullptr);
              }
            },
            help)
        ->type_name(type);
  };
  photon_key("--photons", "solver.photon.photons=", "Photon solver: photons to follow, over all colours", "N");
  photon_key("--error", "solver.photon.error=",
             "Photon solver: stop when the fluence's mean relative standard error is below this. Render with another "
             "solver: choose settings (or photons) so that the picture's error is below it",
             "E");
  command
      .add_option("--checkpoint", options.checkpoint,
                  "Photon solver: file that is written every few seconds, and gone on from if it is there")
      ->type_name("FILE");
}

void remember_command_line(int argc, const char* const* argv) {
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain = !word.empty() && word.find_first_of(" \t\n\"'\\$&|;<>()*?[]{}#~`!") == std::string::npos;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    the_command_line += (i ? " " : "") + (plain ? word : quoted + "'");
  }
}

const std::string& command_line() {
  return the_command_line;
}

void print(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace turbid::app
