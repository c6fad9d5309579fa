// SPDX-License-Identifier: Apache-2.0
// Reads a coefficient: a number, a colour, or a table with an expression, an OpenVDB grid or a named index profile.
#include "host/base/errors.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"
#include "volumes/procedural.h"

namespace turbid::scene {
namespace {

// What the field itself finds wrong gets the place in the scene in front.
template <class Make>
FieldPtr with_place(const toml::node& node, const std::string& key, Make make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(place_of(node.source()) + ": " + key + ": " + error.what());
  }
}

/// A factor or summand of the values: one number or, for colours, three.
glm::vec3 read_factor(const TableReader& table, const FieldRule& rule, const char* name, float fallback) {
  return rule.colour ? table.colour(name, Range::any(), glm::vec3(fallback))
                     : glm::vec3(table.number(name, Range::any(), fallback));
}

FieldPtr read_expression(const TableReader& table, const std::string& key, const FieldRule& rule) {
  table.allow({"expression", "scale"});
  const toml::node& node = table.need("expression");
  const std::string expected =
      rule.colour ? "expected a text, or three for red, green, blue" : "expected a text in quotes";
  std::array<std::string, 3> texts;
  if (const auto* text = node.as_string()) {
    texts.fill(text->get());
    table.effective().add("expression", toml_string(text->get()));
  } else {
    const toml::array* array = node.as_array();
    if (!rule.colour || !array || array->size() != 3) table.fail("expression", expected);
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(*array)[c].is_string()) fail((*array)[c], "expression[" + std::to_string(c) + "]", expected);
      texts[c] = (*array)[c].as_string()->get();
    }
    table.effective().add("expression", std::string("[") + toml_string(texts[0]) + ", " + toml_string(texts[1]) + ", " +
                                            toml_string(texts[2]) + "]");
  }
  const glm::vec3 scale = read_factor(table, rule, "scale", 1);
  return with_place(node, key, [&] { return scaled_field(expression_field(texts), scale); });
}

FieldPtr read_vdb(const Reading& reading, const TableReader& table, const std::string& key, const FieldRule& rule) {
  table.allow({"vdb", "grid", "scale", "offset"});
  const std::string path = read_file_key(reading, table, "vdb");
  const std::string grid = table.has("grid") ? table.text("grid") : "";
  const glm::vec3 scale = read_factor(table, rule, "scale", 1), offset = read_factor(table, rule, "offset", 0);
  return with_place(table.need("vdb"), key, [&] { return vdb_field(path, grid, scale, offset); });
}

FieldPtr read_index_profile(const Reading& reading, const TableReader& table) {
  const std::string& unit = reading.scene.unit;
  const Range index = Range::closed(1, 10);
  const std::string name = table.word("field", {"luneburg", "fisheye", "rod", "linear"});
  const std::string what = std::string("the field ") + toml_string(name);
  if (name == "luneburg") table.allow({"field", "centre", "radius", "surface"}, what);
  if (name == "fisheye") table.allow({"field", "centre", "radius", "index"}, what);
  if (name == "rod") table.allow({"field", "centre", "axis", "index", "alpha"}, what);
  if (name == "linear") table.allow({"field", "centre", "index", "gradient"}, what);
  const glm::vec3 centre = table.vector("centre", Range::any(unit), glm::vec3(0));
  if (name == "luneburg") {
    const float radius = table.number("radius", Range::above(0, unit));
    return luneburg_index(centre, radius, table.number("surface", index, 1.0f));
  }
  if (name == "fisheye") {
    const float radius = table.number("radius", Range::above(0, unit));
    return fisheye_index(centre, radius, table.number("index", index, 2.0f));
  }
  if (name == "rod") {
    const glm::vec3 axis = table.direction("axis", glm::vec3(0, 0, 1));
    const float eta = table.number("index", index);
    return rod_index(centre, axis, eta, table.number("alpha", Range::above(0, reading.per_length())));
  }
  const float eta = table.number("index", index);
  return linear_index(centre, eta, table.vector("gradient", Range::any(reading.per_length())));
}

FieldPtr read_field_table(const Reading& reading, const TableReader& table, const std::string& key,
                          const FieldRule& rule) {
  if (table.has("expression")) return read_expression(table, key, rule);
  if (table.has("vdb")) return read_vdb(reading, table, key, rule);
  if (table.has("field") && rule.index_profiles) return read_index_profile(reading, table);
  std::vector<std::string> kinds{"expression", "vdb"};
  if (rule.index_profiles) kinds.push_back("field");
  table.allow(kinds);
  throw InputError(table.place() + ": " + key + " = {}: expected one of the keys " + list_of(kinds, false));
}

}  // namespace

FieldPtr read_field(const Reading& reading, const TableReader& material, const std::string& key,
                    const FieldRule& rule) {
  if (!material.has(key) || !material.find(key)->is_table()) {
    if (material.has(key) && !material.find(key)->is_number() && !(rule.colour && material.find(key)->is_array()))
      material.fail(key, std::string("expected a number ") + rule.range.text() +
                             (rule.colour ? ", [red, green, blue]" : "") + ", { expression = ... }" +
                             (rule.index_profiles ? ", { field = ... }" : "") + " or { vdb = ... }");
    return constant_field(rule.colour ? material.colour(key, rule.range, glm::vec3(rule.fallback))
                                      : glm::vec3(material.number(key, rule.range, rule.fallback)));
  }
  EffectiveTable effective;
  const TableReader table(*material.find(key)->as_table(), key, effective);
  const FieldPtr field = read_field_table(reading, table, key, rule);
  material.effective().add(key, effective);
  if (const auto value = field->constant())
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite((*value)[c]) || !rule.range.contains((*value)[c]))
        material.fail(key, "is " + text_of((*value)[c]) + " everywhere: must be " + rule.range.text());
  return field;
}

}  // namespace turbid::scene
