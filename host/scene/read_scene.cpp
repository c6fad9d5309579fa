// SPDX-License-Identifier: Apache-2.0
// Reads a scene file: parses it, applies the command line's changes, reads part by part, checks the whole. See scene.h.
#include <algorithm>
#include <fstream>
#include <iterator>

#include "host/base/errors.h"
#include "host/scene/overrides.h"
#include "host/scene/parts.h"
#include "host/scene/scene.h"
#include "host/scene/toml_text.h"

namespace turbid {
namespace scene {

const toml::table* table_at(const toml::table& root, std::string_view key) {
  const toml::node* node = root.get(key);
  if (node && !node->is_table()) fail(*node, key, "expected a table, [" + std::string(key) + "]");
  return node ? node->as_table() : nullptr;
}

std::vector<const toml::table*> tables_at(const toml::table& root, std::string_view key) {
  std::vector<const toml::table*> tables;
  const toml::node* node = root.get(key);
  if (!node) return tables;
  const std::string expected = "expected a list of tables, [[" + std::string(key) + "]]";
  if (node->is_table()) throw InputError(place_of(node->source()) + ": [" + std::string(key) + "]: " + expected);
  if (!node->is_array()) fail(*node, key, expected);
  for (const toml::node& element : *node->as_array()) {
    if (!element.is_table()) fail(element, key, expected);
    tables.push_back(element.as_table());
  }
  return tables;
}

namespace {

toml::table parse(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw InputError(path + ": no such file");
  if (std::filesystem::is_directory(path, ignored))
    throw InputError(path + ": is a folder, expected a scene file (.toml)");
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw InputError(path + ": can't be read");
  try {
    // A path that begins with "-" would look like an option in messages.
    return toml::parse(text, path.starts_with('-') ? "./" + path : path);
  } catch (const toml::parse_error& error) {
    throw InputError(place_of(error.source()) + ": " + std::string(error.description()));
  }
}

bool takes_part(const Material& material) {
  const auto absent = [](const FieldPtr& field, float value) {
    const auto constant = field->constant();
    return constant && *constant == glm::vec3(value);
  };
  return !material.opaque && !(absent(material.sigma_s, 0) && absent(material.sigma_a, 0) &&
                               absent(material.emission, 0) && material.eta->constant());
}

bool shines(const Material& material) {
  const auto constant = material.emission->constant();
  return !material.opaque && (!constant || *constant != glm::vec3(0));
}

}  // namespace

void check_whole(Reading& reading, bool has_box) {
  Scene& scene = reading.scene;
  const MediumDescription& medium = scene.medium;
  const bool ambient =
      medium.ambient_material >= 0 && takes_part(medium.materials[static_cast<std::size_t>(medium.ambient_material)]);
  if (medium.bodies.empty() && !ambient)
    throw InputError(scene.path +
                     ": holds nothing that light could meet: add an [[object]], or give [domain] a material that "
                     "scatters, absorbs, emits or bends light");
  if (ambient && !has_box && !medium.bodies.empty())
    scene.warnings.push_back(
        scene.path +
        ": the domain's own medium ends two voxels beyond the objects; give [domain] min and max to "
        "say how far it reaches");
  std::vector<bool> used(medium.materials.size());
  for (const Body& body : medium.bodies) used[static_cast<std::size_t>(body.material)] = true;
  if (medium.ambient_material >= 0) used[static_cast<std::size_t>(medium.ambient_material)] = true;
  bool shining = false;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i])
      scene.warnings.push_back(scene.path + ": material " + toml_string(medium.materials[i].name) + " is not used");
    shining = shining || (used[i] && shines(medium.materials[i]));
  }
  if (scene.has_camera && scene.lights.empty() && !shining)
    throw InputError(scene.path +
                     ": has a camera but no light: add a [[light]], or an object whose material has emission");
}

void read_top(Reading& reading, const toml::table& root) {
  Scene& scene = reading.scene;
  const TableReader top(root, "a scene", reading.effective.section(""));
  top.allow(
      {"unit", "background", "domain", "material", "object", "light", "camera", "ground", "film", "solver", "view"});
  scene.unit = top.text("unit", scene.unit);
  if (scene.unit.size() > 16 || scene.unit.find_first_of("\n\r\t[]") != std::string::npos)
    top.fail("unit", "expected the short name of a length, such as \"mm\"");
  scene.surroundings.background =
      top.colour("background", Range::at_least(0, "W/(" + scene.unit + "^2 sr)"), scene.surroundings.background);
}

}  // namespace scene

Scene read_scene(const std::string& path, const SceneOverrides& overrides) {
  using namespace scene;
  toml::table root = parse(path);
  apply_overrides(root, overrides);

  Reading reading;
  reading.folder = std::filesystem::absolute(path).parent_path();
  Scene& scene = reading.scene;
  scene.path = path;
  scene.name = std::filesystem::path(path).stem().string();
  read_top(reading, root);
  const DomainSpec domain = read_domain(reading, root);
  read_materials(reading, root);
  if (!domain.ambient.empty()) {
    const toml::node& node = *domain.table->get("material");
    scene.medium.ambient_material = find_material(reading, node, "material");
    if (scene.medium.materials[static_cast<std::size_t>(scene.medium.ambient_material)].opaque)
      fail(node, "material", "is opaque: expected a medium that light can cross");
  }
  const std::vector<std::string> places = read_objects(reading, root);
  read_lights(reading, root);
  read_camera(reading, root);
  read_settings(reading, root);
  check_whole(reading, domain.box.has_value());
  fix_frame(reading, domain, places);

  reading.effective.finish(scene);
  return std::move(reading.scene);
}

}  // namespace turbid
