// SPDX-License-Identifier: Apache-2.0
// change_scene(): the effective scene with some keys changed, read again where they touch it.
#include <algorithm>

#include "host/base/errors.h"
#include "host/scene/overrides.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"

namespace turbid {
namespace scene {
namespace {

bool same(const toml::node* a, const toml::node* b) {
  if (!a || !b) return a == b;
  if (a->is_table() && b->is_table()) return *a->as_table() == *b->as_table();
  if (a->is_array() && b->is_array()) return *a->as_array() == *b->as_array();
  return text_of(*a, std::string::npos) == text_of(*b, std::string::npos);
}

const SceneSection* find_section(const Scene& scene, const std::string& header) {
  const auto at = std::find_if(scene.sections.begin(), scene.sections.end(),
                               [&](const SceneSection& section) { return section.header == header; });
  return at == scene.sections.end() ? nullptr : &*at;
}

void keep_sections(Reading& reading, const Scene& before, const std::string& header) {
  for (const SceneSection& section : before.sections)
    if (section.header == header) reading.effective.keep(section);
}

/// Coefficients whose text stayed keep their fields, which may be large or slow to evaluate.
void keep_fields(Material& material, const Material& before, const SceneSection& now, const SceneSection& then) {
  const std::pair<const char*, FieldPtr Material::*> members[] = {{"eta", &Material::eta},
                                                                  {"sigma_s", &Material::sigma_s},
                                                                  {"sigma_a", &Material::sigma_a},
                                                                  {"g", &Material::g},
                                                                  {"emission", &Material::emission}};
  for (const auto& [key, member] : members)
    for (const SceneEntry& entry : now.entries)
      if (entry.key == key && std::find(then.entries.begin(), then.entries.end(), entry) != then.entries.end())
        material.*member = before.*member;
}

void change_materials(Reading& reading, const toml::table& root, const toml::table& root_before, const Scene& before) {
  const toml::table* now = table_at(root, "material");
  const toml::table* then = table_at(root_before, "material");
  if (!now) return;
  for (const auto& [key, node] : *now)
    if (!then || !then->contains(key.str()))
      throw InputError(place_of(key.source()) + ": there is no material " + toml_string(key.str()) + " in the scene");
  std::size_t i = 0;
  for (const auto& [key, node] : *now) {
    const std::string header = material_header(std::string(key.str()));
    const Material& known = before.medium.materials.at(i);
    const SceneSection& section = *find_section(before, header);
    if (same(&node, then->get(key.str()))) {
      reading.effective.keep(section);
    } else {
      if (!node.is_table()) fail(node, "material." + std::string(key.str()), "expected a table, " + header);
      EffectiveTable& effective = reading.effective.section(header);
      Material material = read_material(reading, TableReader(*node.as_table(), header, effective));
      material.name = known.name;
      if (!material.opaque && !known.opaque) keep_fields(material, known, effective.section(), section);
      reading.scene.medium.materials[i] = std::move(material);
    }
    ++i;
  }
  const int ambient = reading.scene.medium.ambient_material;
  if (ambient >= 0 && reading.scene.medium.materials[static_cast<std::size_t>(ambient)].opaque)
    throw InputError("the domain's material can't become opaque");
}

}  // namespace
}  // namespace scene

Scene change_scene(const Scene& before, const std::vector<std::string>& settings) {
  using namespace scene;
  const std::string source = before.path + " as it is shown";
  const toml::table root_before = toml::parse(before.effective_toml, source);
  toml::table root = toml::parse(before.effective_toml, source);
  apply_overrides(root, {.settings = settings, .resolution = {}, .solver = {}, .seed = {}});
  for (const char* key : {"domain", "object", "unit", "solver"})
    if (!same(root.get(key), root_before.get(key)))
      throw InputError(std::string(key) + ": can't be changed while the scene is shown; start again with it changed");

  Reading reading;
  reading.folder = std::filesystem::absolute(before.path).parent_path();
  Scene& scene = reading.scene;
  scene = before;
  scene.lights.clear();
  scene.camera = {};
  scene.has_camera = false;
  scene.surroundings = {};
  scene.film = {};
  scene.solver = {};
  scene.view = {};
  read_top(reading, root);
  keep_sections(reading, before, "[domain]");
  change_materials(reading, root, root_before, before);
  keep_sections(reading, before, "[[object]]");
  read_lights(reading, root);
  read_camera(reading, root);
  read_settings(reading, root);
  check_whole(reading, true);
  scene.warnings = before.warnings;
  reading.effective.finish(scene);
  return std::move(reading.scene);
}

}  // namespace turbid
