// SPDX-License-Identifier: Apache-2.0
// Reads [[object]]: a mesh or a primitive, its material, and where it stands.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/errors.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {
namespace {

/// Which point of the object stands at the origin before it is translated.
enum class Origin { file, centre, base };

// Degrees about x, then y, then z, each counter-clockwise seen against the axis.
glm::mat3 rotation(glm::vec3 degrees) {
  const glm::dvec3 angle = glm::dvec3(degrees) * (std::numbers::pi / 180.0);
  const glm::dvec3 c(std::cos(angle.x), std::cos(angle.y), std::cos(angle.z));
  const glm::dvec3 s(std::sin(angle.x), std::sin(angle.y), std::sin(angle.z));
  const glm::dmat3 about_x(1, 0, 0, 0, c.x, s.x, 0, -s.x, c.x);  // columns
  const glm::dmat3 about_y(c.y, 0, -s.y, 0, 1, 0, s.y, 0, c.y);
  const glm::dmat3 about_z(c.z, s.z, 0, -s.z, c.z, 0, 0, 0, 1);
  return glm::mat3(about_z * about_y * about_x);
}

struct Standing {
  Placement placement;
  Origin origin = Origin::file;
};

Standing read_standing(const Reading& reading, const TableReader& table, const Box3& box) {
  Standing standing;
  if (table.has("scale") && table.has("fit")) table.fail("fit", "scale is given as well: expected one of the two");
  if (table.has("fit")) {
    const glm::vec3 size = box.size();
    standing.placement.scale =
        table.number("fit", Range::above(0, reading.scene.unit)) / std::max({size.x, size.y, size.z});
  } else {
    standing.placement.scale = table.number("scale", Range::above(0), 1.0f);
  }
  if (!std::isfinite(standing.placement.scale) || standing.placement.scale <= 0)
    table.fail("fit", "can't be reached with a finite scale");
  standing.origin = table.choice<Origin>(
      "origin", {{"file", Origin::file}, {"centre", Origin::centre}, {"base", Origin::base}}, "file");
  standing.placement.rotation = rotation(table.vector("rotate", Range::any("degrees"), glm::vec3(0)));
  standing.placement.translation = table.vector("translate", Range::any(reading.scene.unit), glm::vec3(0));
  return standing;
}

Solid read_mesh_object(Reading& reading, const TableReader& table) {
  table.allow({"name", "mesh", "material", "scale", "fit", "origin", "rotate", "translate", "interface"},
              "an object with a mesh");
  const std::string path = read_file_key(reading, table, "mesh");
  TriangleMesh mesh;
  std::vector<std::string> repairs;
  try {
    mesh = read_mesh(path, repairs);
  } catch (const InputError& error) {
    throw InputError(place_of(table.need("mesh").source()) + ": mesh: " + error.what());
  }
  reading.scene.warnings.insert(reading.scene.warnings.end(), repairs.begin(), repairs.end());
  const Box3 box = bounds(mesh);
  Standing standing = read_standing(reading, table, box);
  Placement& placement = standing.placement;
  if (standing.origin != Origin::file) {
    const auto placed = [&](glm::vec3 x) { return placement.rotation * (placement.scale * (x - box.centre())); };
    float lowest = 0;
    if (standing.origin == Origin::base)
      for (const glm::vec3 x : mesh.positions) lowest = std::min(lowest, placed(x).y);
    placement.translation += placed(glm::vec3(0)) - glm::vec3(0, lowest, 0);
  }
  return make_mesh_solid(std::move(mesh), placement);
}

Solid read_shape_object(const Reading& reading, const TableReader& table) {
  const std::string shape = table.word("shape", {"sphere", "box", "cylinder"});
  std::vector<std::string> keys{"name", "shape", "material", "scale", "origin", "rotate", "translate", "interface"};
  const Range length = Range::above(0, reading.scene.unit);
  std::function<Solid(const Placement&)> make;
  const auto allow_also = [&](std::vector<std::string> own) {
    keys.insert(keys.begin() + 2, own.begin(), own.end());
    table.allow(keys, "a " + shape);
  };
  if (shape == "sphere") {
    allow_also({"radius"});
    make = [radius = table.number("radius", length)](const Placement& p) { return make_sphere(radius, p); };
  } else if (shape == "box") {
    allow_also({"size"});
    make = [size = table.colour("size", length)](const Placement& p) { return make_box(size, p); };
  } else {
    allow_also({"radius", "height"});
    const float radius = table.number("radius", length);
    make = [radius, height = table.number("height", length)](const Placement& p) {
      return make_cylinder(radius, height, p);
    };
  }
  Standing standing = read_standing(reading, table, {});
  if (standing.origin == Origin::base) {
    Placement about_origin = standing.placement;
    about_origin.translation = glm::vec3(0);
    standing.placement.translation.y -= bounds(make(about_origin).mesh).lower.y;
  }
  return make(standing.placement);
}

std::string unused_name(const Reading& reading, const std::string& wanted) {
  const auto taken = [&](const std::string& name) {
    return std::any_of(reading.scene.medium.bodies.begin(), reading.scene.medium.bodies.end(),
                       [&](const Body& body) { return body.name == name; });
  };
  std::string name = wanted;
  for (int i = 2; taken(name); ++i) name = wanted + " " + std::to_string(i);
  return name;
}

}  // namespace

std::string read_file_key(const Reading& reading, const TableReader& table, std::string_view key) {
  const toml::node& node = table.need(key);
  if (!node.is_string() || node.as_string()->get().empty()) fail(node, key, "expected the name of a file in quotes");
  const std::filesystem::path given(node.as_string()->get());
  const std::filesystem::path path = std::filesystem::absolute(reading.folder / given).lexically_normal();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    const auto beside = path.lexically_relative(std::filesystem::absolute(reading.folder).lexically_normal());
    const bool bundled = beside.begin() != beside.end() && *beside.begin() == "meshes";
    fail(node, key,
         "no such file, " + path.string() +
             (bundled ? "; run scripts/setup, which fetches the meshes of the bundled scenes" : ""));
  }
  if (!std::filesystem::is_regular_file(path, ignored)) fail(node, key, path.string() + " is not a regular file");
  try {
    table.effective().add(std::string(key), toml_string(path.string()), toml_string(hash_file(path.string())));
  } catch (const InputError& error) {
    fail(node, key, error.what());
  }
  return path.string();
}

std::vector<std::string> read_objects(Reading& reading, const toml::table& root) {
  std::vector<std::string> places;
  for (const toml::table* object : tables_at(root, "object")) {
    const TableReader table(*object, "[[object]]", reading.effective.section("[[object]]"));
    if (table.has("mesh") == table.has("shape")) {
      table.allow({"name", "mesh", "shape", "radius", "size", "height", "material", "scale", "fit", "origin", "rotate",
                   "translate", "interface"});
      if (table.has("mesh")) table.fail("shape", "mesh is given as well: expected one of the two");
      throw InputError(table.place() + ": [[object]] lacks the key mesh or shape");
    }
    Body body;
    body.solid = table.has("mesh") ? read_mesh_object(reading, table) : read_shape_object(reading, table);
    body.material = find_material(reading, table.need("material"), "material");
    table.text("material");
    const std::string kind = table.has("mesh")
                                 ? std::filesystem::path(table.find("mesh")->as_string()->get()).stem().string()
                                 : table.find("shape")->as_string()->get();
    body.name = table.text("name", unused_name(reading, kind));
    body.surface = table.choice<SurfaceKind>("interface",
                                             {{"sharp", SurfaceKind::sharp}, {"smooth", SurfaceKind::smooth}}, "sharp");
    places.push_back(table.place() + ": object " + toml_string(body.name));
    reading.scene.medium.bodies.push_back(std::move(body));
  }
  return places;
}

}  // namespace turbid::scene
