// SPDX-License-Identifier: Apache-2.0
// Reads [domain] and, once the objects are known, fixes the grid of voxels.
#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/scene/frame_rules.h"
#include "host/scene/parts.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {
namespace {

constexpr int kDefaultResolution = 128;
const char* const kFaceNames[6] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

FaceBoundary face_of(const TableReader& table, std::string_view key) {
  return table.choice<FaceBoundary>(
      key, {{"open", FaceBoundary::open}, {"mirror", FaceBoundary::mirror}, {"periodic", FaceBoundary::periodic}},
      "open");
}

std::string word_for(FaceBoundary face) {
  return face == FaceBoundary::open ? "open" : face == FaceBoundary::mirror ? "mirror" : "periodic";
}

std::array<FaceBoundary, 6> read_boundary(const TableReader& domain) {
  std::array<FaceBoundary, 6> faces{};
  EffectiveTable scratch;  // the effective scene gets one form, whatever was written
  if (domain.has("boundary") && domain.find("boundary")->is_table()) {
    const TableReader table(*domain.find("boundary")->as_table(), "boundary", scratch);
    table.allow({"x", "y", "z", "x_min", "x_max", "y_min", "y_max", "z_min", "z_max"});
    for (int face = 0; face < 6; ++face) {
      const std::string axis(1, "xyz"[face / 2]), name = kFaceNames[face];
      if (table.has(axis) && table.has(name)) table.fail(name, axis + " is given as well: expected one of the two");
      faces[static_cast<std::size_t>(face)] = face_of(table, table.has(axis) ? axis : name);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(2 * axis);
      if ((faces[a] == FaceBoundary::periodic) == (faces[a + 1] == FaceBoundary::periodic)) continue;
      const char* name = kFaceNames[faces[a] == FaceBoundary::periodic ? a : a + 1];
      table.fail(name, "an axis is periodic at both of its faces or at none");
    }
  } else if (domain.has("boundary") && !domain.find("boundary")->is_string()) {
    domain.fail(
        "boundary",
        "expected \"open\", \"mirror\", \"periodic\" or a table such as { x = \"periodic\", y_min = \"mirror\" }");
  } else {
    faces.fill(face_of(TableReader(domain), "boundary"));
    return faces;
  }
  EffectiveTable effective;
  for (std::size_t face = 0; face < 6; ++face) effective.add(kFaceNames[face], toml_string(word_for(faces[face])));
  domain.effective().add("boundary", effective);
  return faces;
}

std::string box_text(const Box3& box) {
  return text_of(box.lower) + " to " + text_of(box.upper);
}

// Objects that an explicit domain misses or cuts. `sealed`: the axis ends in a mirror or repeats, so that bodies may go
// on.
void check_objects(Reading& reading, const Box3& domain, const std::vector<std::string>& places) {
  const MediumDescription& medium = reading.scene.medium;
  for (std::size_t i = 0; i < medium.bodies.size(); ++i) {
    const Box3 body = bounds(medium.bodies[i].solid.mesh);
    bool cut = false;
    double largest_ratio = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (body.upper[axis] <= domain.lower[axis] || body.lower[axis] >= domain.upper[axis])
        throw InputError(places[i] + " reaches from " + box_text(body) + ", outside the domain, which reaches from " +
                         box_text(domain) + ": move or scale it, or change [domain] min and max");
      const float tolerance = 1e-4f * reading.scene.medium.frame.voxel_size;
      const auto face = static_cast<std::size_t>(2 * axis);
      cut = cut || (medium.faces[face] == FaceBoundary::open && body.lower[axis] < domain.lower[axis] - tolerance) ||
            (medium.faces[face + 1] == FaceBoundary::open && body.upper[axis] > domain.upper[axis] + tolerance);
      largest_ratio = std::max<double>(largest_ratio, body.size()[axis] / domain.size()[axis]);
    }
    if (!cut) continue;
    std::string text = places[i] + " is cut by the domain: it reaches from " + box_text(body) + ", the domain from " +
                       box_text(domain);
    if (largest_ratio > 4)
      text +=
          "; it is " + text_of(std::round(static_cast<float>(largest_ratio))) + " times as large: is its scale right?";
    reading.scene.warnings.push_back(text);
  }
}

/// What the grid adds to the domain that was asked for, where it is not empty space: else nothing changes by it.
void tell_if_widened(Reading& reading, const DomainSpec& spec, const FrameRequest& request) {
  const MediumDescription& medium = reading.scene.medium;
  const Box3 asked = request.box, used{medium.frame.origin, medium.frame.upper()};
  const float tolerance = 1e-4f * medium.frame.voxel_size;
  bool wider = false, cuts_elsewhere = false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool below = used.lower[axis] < asked.lower[axis] - tolerance;
    const bool above = used.upper[axis] > asked.upper[axis] + tolerance;
    wider = wider || below || above;
    for (const Body& body : medium.bodies) {
      const Box3 box = bounds(body.solid.mesh);
      cuts_elsewhere = cuts_elsewhere || (below && box.lower[axis] < asked.lower[axis] - tolerance) ||
                       (above && box.upper[axis] > asked.upper[axis] + tolerance);
    }
  }
  if (!wider || !(!spec.ambient.empty() || cuts_elsewhere)) return;
  const std::string fits = fitting_resolutions(request, medium.frame.voxel_size);
  reading.scene.warnings.push_back(
      place_of(spec.table->source()) + ": [domain] from " + box_text(asked) +
      " is no whole number of 8-voxel blocks: it became " + box_text(used) + ", all filled with " +
      (spec.ambient.empty() ? "the objects that reach beyond it" : "\"" + spec.ambient + "\"") +
      (fits.empty() ? "; no resolution fits all three sides" : "; resolutions that fit exactly are " + fits));
}

Box3 bounds_of_all(const std::vector<Body>& bodies) {
  Box3 box = bounds(bodies.front().solid.mesh);
  for (const Body& body : bodies) {
    const Box3 b = bounds(body.solid.mesh);
    box.lower = glm::min(box.lower, b.lower);
    box.upper = glm::max(box.upper, b.upper);
  }
  return box;
}

}  // namespace

DomainSpec read_domain(Reading& reading, const toml::table& root) {
  static const toml::table none;
  DomainSpec spec;
  const std::string unit = reading.scene.unit;
  spec.table = table_at(root, "domain");
  spec.effective = &reading.effective.section("[domain]");
  const TableReader table(spec.table ? *spec.table : none, "[domain]", *spec.effective);
  table.allow({"resolution", "voxel_size", "min", "max", "boundary", "material", "smoothing"});
  if (table.has("resolution") && table.has("voxel_size"))
    table.fail("voxel_size", "resolution is given as well: expected one of the two");
  if (table.has("voxel_size"))
    spec.voxel_size = table.number("voxel_size", Range::above(0, unit));
  else
    spec.resolution =
        static_cast<double>(table.integer("resolution", Range::at_least(8, "voxels"), kDefaultResolution));
  spec.size_node = table.find(spec.voxel_size ? "voxel_size" : "resolution");
  if (table.has("min") != table.has("max"))
    table.fail(table.has("min") ? "min" : "max", "expected both min and max, or neither");
  if (table.has("min")) {
    spec.box = Box3{table.vector("min", Range::any(unit)), table.vector("max", Range::any(unit))};
    for (int axis = 0; axis < 3; ++axis)
      if (!(spec.box->lower[axis] < spec.box->upper[axis])) table.fail("max", "must be greater than min in x, y and z");
  }
  reading.scene.medium.faces = read_boundary(table);
  const auto& faces = reading.scene.medium.faces;
  if (!spec.box && std::any_of(faces.begin(), faces.end(), [](FaceBoundary f) { return f != FaceBoundary::open; }))
    table.fail("boundary", "mirror and periodic faces need [domain] min and max, which say where they lie");
  if (table.has("material")) spec.ambient = table.text("material");
  reading.scene.medium.smoothing_voxels = table.number("smoothing", Range::closed(0, 8, "voxels"), 1.0f);
  return spec;
}

void fix_frame(Reading& reading, const DomainSpec& spec, const std::vector<std::string>& object_places) {
  Scene& scene = reading.scene;
  FrameRequest request{spec.resolution, spec.voxel_size, {}, !spec.box, scene.medium.faces};
  if (!spec.box && scene.medium.bodies.empty())
    throw InputError((spec.table ? place_of(spec.table->source()) : scene.path) +
                     ": a scene without objects needs [domain] min and max, which say how far the medium reaches");
  request.box = spec.box ? *spec.box : bounds_of_all(scene.medium.bodies);
  FrameAnswer answer;
  try {
    answer = make_frame(request);
  } catch (const InputError& error) {
    if (spec.size_node) fail(*spec.size_node, spec.voxel_size ? "voxel_size" : "resolution", error.what());
    throw InputError((spec.table ? place_of(spec.table->source()) : scene.path) +
                     ": [domain] resolution = " + std::to_string(kDefaultResolution) + " (default): " + error.what());
  }
  scene.medium.frame = answer.frame;
  if (spec.voxel_size && answer.frame.voxel_size < (1 - 1e-5) * answer.asked_voxel_size)
    scene.warnings.push_back(place_of(spec.size_node->source()) + ": voxel_size = " + text_of(*spec.size_node) +
                             " became " + text_of(answer.frame.voxel_size) +
                             " so that mirror and periodic extents are whole blocks");
  if (spec.box) tell_if_widened(reading, spec, request);
  if (spec.box) check_objects(reading, {answer.frame.origin, answer.frame.upper()}, object_places);
  const glm::ivec3 n = answer.frame.voxels;
  spec.effective->comment(std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) +
                          " voxels of " + text_of(answer.frame.voxel_size) + " " + scene.unit + ", from " +
                          box_text({answer.frame.origin, answer.frame.upper()}));
}

}  // namespace turbid::scene
