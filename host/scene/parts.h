// SPDX-License-Identifier: Apache-2.0
// The parts of a scene, one reading function each, called by read_scene in this order. Private to host/scene.
#pragma once
#include <toml++/toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/scene/effective.h"
#include "host/scene/scene.h"
#include "host/scene/toml_table.h"

namespace turbid::scene {

/// What the parts share while a scene is read.
struct Reading {
  std::filesystem::path folder;  ///< of the scene file: relative paths start here
  Scene scene;
  EffectiveScene effective;

  /// Unit of a coefficient, for messages.
  std::string per_length() const { return std::string("1/") + scene.unit; }
};

/// [domain] as written; the frame needs the objects and comes after them.
struct DomainSpec {
  const toml::table* table = nullptr;  ///< null: no [domain]
  EffectiveTable* effective = nullptr;
  const toml::node* size_node = nullptr;  ///< resolution or voxel_size; null: default
  std::optional<double> resolution, voxel_size;
  std::optional<Box3> box;
  std::string ambient;  ///< material name; empty: vacuum
};

/// The top level: unit and background.
void read_top(Reading& reading, const toml::table& root);
/// [domain]: sets faces and smoothing.
DomainSpec read_domain(Reading& reading, const toml::table& root);
/// [material.NAME], in alphabetical order.
void read_materials(Reading& reading, const toml::table& root);
/// One of them.
Material read_material(const Reading& reading, const TableReader& table);
/// `[material.NAME]`
std::string material_header(const std::string& name);
/// Index of a material; an error with the known names if there is none.
int find_material(const Reading& reading, const toml::node& node, std::string_view key);
/// [[object]]; returns where each one stands in the file, for messages.
std::vector<std::string> read_objects(Reading& reading, const toml::table& root);
/// The frame from the domain and the objects, with checks of how they lie to each other.
void fix_frame(Reading& reading, const DomainSpec& domain, const std::vector<std::string>& object_places);
/// [[light]]
void read_lights(Reading& reading, const toml::table& root);
/// [camera], [ground], [film], and the background
void read_camera(Reading& reading, const toml::table& root);
/// [solver] and [view]
void read_settings(Reading& reading, const toml::table& root);

/// Whether there is anything to meet and to see; warns of what is not used. `has_box`: the domain says how far it reaches.
void check_whole(Reading& reading, bool has_box);

/// Colour2 and edge of `checker = { colour, size }`; a plain colour without it.
void read_checker(const Reading& reading, const TableReader& table, glm::vec3 colour, glm::vec3& colour2, float& size);

/// The file that a key names, as an absolute path; an error with its place if there is no such file. Recorded under
/// `key`, and hashed by its content.
std::string read_file_key(const Reading& reading, const TableReader& table, std::string_view key);

/// The table under a key of the top level; null if there is none.
const toml::table* table_at(const toml::table& root, std::string_view key);
/// The tables under `[[key]]`.
std::vector<const toml::table*> tables_at(const toml::table& root, std::string_view key);

/// One of a material's coefficients: read_field.cpp.
struct FieldRule {
  Range range;  ///< of constant values
  float fallback = 0;
  bool colour = true;           ///< may differ for red, green, blue
  bool index_profiles = false;  ///< { field = "luneburg", ... } is allowed
};
FieldPtr read_field(const Reading& reading, const TableReader& material, const std::string& key, const FieldRule& rule);

}  // namespace turbid::scene
