// SPDX-License-Identifier: Apache-2.0
// Reads what a picture needs besides the medium and its lights: [camera], [ground], [film].
#include <cmath>

#include "host/base/errors.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {
namespace {

Camera read_camera_table(const Reading& reading, const TableReader& table) {
  const std::string& unit = reading.scene.unit;
  table.allow({"position", "target", "up", "fov", "width", "height", "samples"});
  Camera camera;
  camera.position = table.vector("position", Range::any(unit));
  camera.target = table.vector("target", Range::any(unit), camera.target);
  camera.up = table.direction("up", camera.up);
  camera.fov = table.number("fov", Range::half_open(0, 170, "degrees"), camera.fov);
  camera.width = static_cast<int>(table.integer("width", Range::closed(1, 16384, "pixels"), camera.width));
  camera.height = static_cast<int>(table.integer("height", Range::closed(1, 16384, "pixels"), camera.height));
  camera.samples = static_cast<int>(table.integer("samples", Range::closed(1, 1024), camera.samples));
  const glm::dvec3 sight = glm::dvec3(camera.target) - glm::dvec3(camera.position);
  if (!(glm::length(sight) > 0)) table.fail("position", "must differ from target, " + text_of(camera.target));
  if (glm::length(glm::cross(glm::normalize(sight), glm::dvec3(camera.up))) < 1e-4)
    table.fail(table.has("up") ? "up" : "position",
               "the camera looks along up, " + text_of(camera.up) + ": give another up, such as [0, 0, 1]");
  const int root = static_cast<int>(std::lround(std::sqrt(camera.samples)));
  if (root * root != camera.samples) table.fail("samples", "must be a square number: 1, 4, 9, 16, ...");
  return camera;
}

Ground read_ground(const Reading& reading, const TableReader& table) {
  table.allow({"height", "colour", "checker"});
  Ground ground;
  ground.height = table.number("height", Range::any(reading.scene.unit), ground.height);
  ground.colour = table.colour("colour", Range::closed(0, 1), ground.colour);
  read_checker(reading, table, ground.colour, ground.colour2, ground.checker_size);
  return ground;
}

}  // namespace

void read_camera(Reading& reading, const toml::table& root) {
  Scene& scene = reading.scene;
  if (const toml::table* node = table_at(root, "camera")) {
    scene.camera = read_camera_table(reading, TableReader(*node, "[camera]", reading.effective.section("[camera]")));
    scene.has_camera = true;
  }
  if (const toml::table* node = table_at(root, "ground"))
    scene.surroundings.ground =
        read_ground(reading, TableReader(*node, "[ground]", reading.effective.section("[ground]")));

  static const toml::table none;
  const toml::table* node = table_at(root, "film");
  const TableReader film(node ? *node : none, "[film]", reading.effective.section("[film]"));
  film.allow({"exposure"});
  const toml::node* exposure = film.find("exposure");
  if (!exposure || exposure->is_string())
    film.word("exposure", {"auto"}, "auto");
  else if (!exposure->is_number())
    film.fail("exposure", "expected \"auto\" or a number [stops]");
  else
    scene.film.exposure = film.number("exposure", Range::closed(-64, 64, "stops"));
}

}  // namespace turbid::scene
