// SPDX-License-Identifier: Apache-2.0
// Reads [[light]].
#include "host/base/errors.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {
namespace {

glm::vec3 bright(const TableReader& table, std::string_view key, const std::string& unit) {
  const glm::vec3 value = table.colour(key, Range::at_least(0, unit));
  if (value == glm::vec3(0)) table.fail(key, "must be > 0 [" + unit + "] in one colour at least");
  return value;
}

// Where a spot points: at `target`, or along `direction`.
glm::vec3 read_aim(const Reading& reading, const TableReader& table, glm::vec3 position) {
  if (table.has("direction")) {
    if (table.has("target")) table.fail("direction", "target is given as well: expected one of the two");
    return table.direction("direction");
  }
  const glm::dvec3 aim = glm::dvec3(table.vector("target", Range::any(reading.scene.unit))) - glm::dvec3(position);
  if (!(glm::length(aim) > 0)) table.fail("target", "must differ from position");
  return glm::vec3(glm::normalize(aim));
}

Light read_light(const Reading& reading, const TableReader& table) {
  const std::string& unit = reading.scene.unit;
  Light light;
  light.kind = table.choice<LightKind>(
      "type", {{"directional", LightKind::directional}, {"point", LightKind::point}, {"spot", LightKind::spot}});
  if (light.kind == LightKind::directional) {
    table.allow({"type", "direction", "irradiance"}, "a directional light");
    light.direction = table.direction("direction");
    light.irradiance = bright(table, "irradiance", "W/" + unit + "^2");
    return light;
  }
  if (light.kind == LightKind::point)
    table.allow({"type", "position", "power"}, "a point light");
  else
    table.allow({"type", "position", "target", "direction", "angle", "power"}, "a spot light");
  light.position = table.vector("position", Range::any(unit));
  if (light.kind == LightKind::spot) {
    light.direction = read_aim(reading, table, light.position);
    light.cone_angle = table.number("angle", Range::half_open(0, 170, "degrees"), light.cone_angle);
  }
  light.power = bright(table, "power", "W");
  return light;
}

}  // namespace

void read_lights(Reading& reading, const toml::table& root) {
  for (const toml::table* node : tables_at(root, "light")) {
    const TableReader table(*node, "[[light]]", reading.effective.section("[[light]]"));
    Light light = read_light(reading, table);
    light.name = "light " + std::to_string(reading.scene.lights.size() + 1);
    reading.scene.lights.push_back(std::move(light));
  }
}

}  // namespace turbid::scene
