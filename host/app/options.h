// SPDX-License-Identifier: Apache-2.0
// Flags that several commands share.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "host/base/progress.h"
#include "host/scene/scene.h"

namespace turbid::app {

/// What a command prints, and how much of it.
struct TalkOptions {
  bool verbose = false, quiet = false, json = false;
  Verbosity verbosity() const { return verbose ? Verbosity::verbose : quiet ? Verbosity::quiet : Verbosity::normal; }
};

/// Which scene, what is changed in it, and where it is computed.
struct SceneOptions : TalkOptions {
  std::string scene;
  SceneOverrides overrides;
  std::string device;
  std::optional<double> error;  ///< --error, which is also the photon solver's
  std::string checkpoint;       ///< of the photon solver; empty: none
};

void add_json_option(CLI::App& command, TalkOptions&);
void add_talk_options(CLI::App& command, TalkOptions&);
/// SCENE, -D and --resolution, with the talk options.
void add_scene_options(CLI::App& command, SceneOptions&);
void add_device_option(CLI::App& command, std::string& device);
/// --device, --solver, --seed, and for the photon solver --photons, --error and --checkpoint.
void add_solver_options(CLI::App& command, SceneOptions&);

/// The whole command line as one text, for reports; set once by main.
void remember_command_line(int argc, const char* const* argv);
const std::string& command_line();

/// To standard output.
void print(const std::string& text);

}  // namespace turbid::app
