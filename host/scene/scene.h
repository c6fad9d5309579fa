// SPDX-License-Identifier: Apache-2.0
// A scene as plain data, after reading and checking: what the file said with every default filled in.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/light.h"
#include "host/scene/settings.h"
#include "volumes/medium_volume.h"

namespace turbid {

/// How pictures are made of radiance; linear EXR files are not touched by it.
struct FilmSettings {
  std::optional<float> exposure;    ///< stops applied to the PNG preview; unset: automatic
};

/// One line of the effective scene.
struct SceneEntry {
  std::string key, value;           ///< TOML texts
  std::string hashed;               ///< the value; where it names a file, made from that file's content instead
  bool operator==(const SceneEntry&) const = default;
};

/// One table of the effective scene.
struct SceneSection {
  std::string header;               ///< `[camera]`, `[[light]]`; empty for the top level, which comes first
  std::vector<SceneEntry> entries;
  std::vector<std::string> comments;
  bool operator==(const SceneSection&) const = default;
};

struct Scene {
  std::string path;                 ///< the .toml file
  std::string name;                 ///< file name without folder and .toml
  std::string unit = "mm";          ///< name of the scene's one length unit
  MediumDescription medium;         ///< meshes read, placed and checked; the frame fixed
  LightList lights;
  Camera camera;
  bool has_camera = false;          ///< the scene has [camera]; without it there is nothing to render, only to solve
  Surroundings surroundings;
  SolverSettings solver;
  ViewSettings view;
  FilmSettings film;
  std::vector<std::string> warnings;  ///< one sentence each: repairs of meshes, doubtful values
  std::vector<SceneSection> sections; ///< the effective scene, table by table
  std::string effective_toml;       ///< the scene with all defaults and overrides, as TOML that read_scene accepts
  std::string hash;                 ///< 16 hex digits: changes whenever the effective scene or a file it reads changes
};

/// What the command line may change.
struct SceneOverrides {
  std::vector<std::string> settings;            ///< `key.sub=value`, TOML values; `light.0.power=[1,2,3]` for arrays
  std::optional<int> resolution;                ///< --resolution
  std::optional<std::string> solver;            ///< --solver
  std::optional<std::uint64_t> seed;            ///< --seed
};

/// Reads and checks a scene. Strict: unknown, repeated, missing or ill-typed keys and values out of range throw
/// InputError with `file:line:column: key = found: expected`. Relative paths are relative to the scene file.
Scene read_scene(const std::string& path, const SceneOverrides& overrides = {});

/// The same scene with some keys changed, given like SceneOverrides::settings: materials, lights, camera, ground,
/// background, film and view settings. The bodies, the grid and the solver stay as they are, so a change of [domain],
/// [[object]], [solver] or the unit, or a material that was not there, throws InputError, as every bad value does. A
/// coefficient whose text stays the same keeps its Field object.
Scene change_scene(const Scene&, const std::vector<std::string>& settings);

}  // namespace turbid
