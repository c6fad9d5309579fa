// SPDX-License-Identifier: Apache-2.0
// Reads [material.NAME]: the coefficients of a medium, or an opaque surface.
#include "host/base/errors.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {

Material read_material(const Reading& reading, const TableReader& table) {
  const std::string& unit = reading.scene.unit;
  Material material;
  if (table.has("opaque")) {
    table.allow({"opaque", "checker"}, "an opaque material");
    material.opaque = true;
    material.reflectance = table.colour("opaque", Range::closed(0, 1));
    read_checker(reading, table, material.reflectance, material.reflectance2, material.checker_size);
    const auto none = constant_field(glm::vec3(0));
    material.eta = constant_field(glm::vec3(1));
    material.sigma_s = material.sigma_a = material.g = material.emission = none;
    return material;
  }
  table.allow({"eta", "sigma_s", "sigma_a", "g", "emission", "opaque"});
  material.eta = read_field(reading, table, "eta", {Range::closed(1, 10), 1.0f, false, true});
  material.sigma_s = read_field(reading, table, "sigma_s", {Range::at_least(0, reading.per_length())});
  material.sigma_a = read_field(reading, table, "sigma_a", {Range::at_least(0, reading.per_length())});
  material.g = read_field(reading, table, "g", {Range::open(-1, 1), 0.0f, false});
  material.emission = read_field(reading, table, "emission", {Range::at_least(0, "W/" + unit + "^3")});
  return material;
}

std::string material_header(const std::string& name) { return "[material." + key_text(name) + "]"; }

void read_checker(const Reading& reading, const TableReader& table, glm::vec3 colour, glm::vec3& colour2, float& size) {
  colour2 = colour;
  size = 0;
  if (!table.has("checker")) return;
  if (!table.find("checker")->is_table()) table.fail("checker", "expected { colour = ..., size = ... }");
  EffectiveTable effective;
  const TableReader checker(*table.find("checker")->as_table(), "checker", effective);
  checker.allow({"colour", "size"});
  colour2 = checker.colour("colour", Range::closed(0, 1));
  size = checker.number("size", Range::above(0, reading.scene.unit));
  table.effective().add("checker", effective);
}

void read_materials(Reading& reading, const toml::table& root) {
  const toml::table* materials = table_at(root, "material");
  if (!materials) return;
  for (const auto& [key, node] : *materials) {
    const std::string name(key.str());
    const std::string header = material_header(name);
    if (!node.is_table())
      throw InputError(place_of(node.source()) + ": material." + key_text(name) + " = " + text_of(node) +
                       ": expected a table, " + header);
    const TableReader table(*node.as_table(), header, reading.effective.section(header));
    Material material = read_material(reading, table);
    material.name = name;
    reading.scene.medium.materials.push_back(std::move(material));
  }
}

int find_material(const Reading& reading, const toml::node& node, std::string_view key) {
  std::vector<std::string> names;
  for (const Material& material : reading.scene.medium.materials) names.push_back(material.name);
  if (!node.is_string()) fail(node, key, "expected the name of a material in quotes");
  const std::string name = node.as_string()->get();
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<int>(i);
  fail(node, key,
       "no such material" + did_you_mean(name, names) + "; " +
           (names.empty() ? "write [material." + key_text(name) + "]" : "there are " + list_of(names, true)));
}

}  // namespace turbid::scene
