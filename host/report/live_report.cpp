// SPDX-License-Identifier: Apache-2.0
// See live_report.h.
#include "host/report/live_report.h"

#include "host/report/json_parts.h"

namespace turbid {
namespace {

Json vector(glm::vec3 v) {
  return Json::array({v.x, v.y, v.z});
}

/// What a slider can move: a constant value, the factor of a varying field, or nothing.
Json coefficient(const FieldPtr& field) {
  if (const auto value = field->constant()) return {{"value", vector(*value)}};
  if (const auto scale = field->scale()) return {{"scale", vector(*scale)}, {"field", field->describe()}};
  return {{"field", field->describe()}};
}

Json material_part(const Material& material) {
  Json part{{"name", material.name}, {"opaque", material.opaque}};
  if (material.opaque) {
    part["reflectance"] = vector(material.reflectance);
    return part;
  }
  part["sigma_s"] = coefficient(material.sigma_s);
  part["sigma_a"] = coefficient(material.sigma_a);
  part["eta"] = coefficient(material.eta);
  part["g"] = coefficient(material.g);
  return part;
}

Json light_part(const Light& light) {
  Json part{{"name", light.name}, {"direction", vector(light.direction)}};
  if (light.kind == LightKind::directional) {
    part["type"] = "directional";
    part["irradiance"] = vector(light.irradiance);
    return part;
  }
  part["type"] = light.kind == LightKind::point ? "point" : "spot";
  part["position"] = vector(light.position);
  part["power"] = vector(light.power);
  if (light.kind == LightKind::spot) part["angle"] = light.cone_angle;
  return part;
}

/// Whether a spot light is aimed by `target`, and at what.
void add_targets(const Scene& scene, Json& lights) {
  std::size_t i = 0;
  for (const SceneSection& section : scene.sections) {
    if (section.header != "[[light]]") continue;
    for (const SceneEntry& entry : section.entries)
      if (entry.key == "target") lights[i]["target"] = Json::parse(entry.value);
    ++i;
  }
}

Json solver_part(const SolverReport& s, double allowed) {
  const EnergyBalance& e = s.energy;
  return {{"name", s.solver},
          {"iterations", s.iterations},
          {"rays", s.rays},
          {"active_voxels", s.active_voxels},
          {"error_estimate", s.error_estimate},
          {"energy",
           {{"emitted", colours(e.emitted)},
            {"missed", colours(e.missed)},
            {"reflected", colours(e.reflected)},
            {"absorbed", colours(e.absorbed + e.absorbed_opaque)},
            {"escaped", colours(e.escaped)},
            {"in_flight", colours(e.in_flight)},
            {"imbalance", e.imbalance()},
            {"balanced", e.imbalance() <= allowed}}}};
}

}  // namespace

std::string live_json(const LiveReport& r) {
  const Scene& scene = r.scene;
  const GridFrame& frame = scene.medium.frame;
  Json json{{"number", r.number},
            {"version", TURBID_VERSION},
            {"scene", {{"name", scene.name}, {"unit", scene.unit}, {"hash", scene.hash}}},
            {"device", r.device.label()},
            {"grid",
             {{"voxels", {frame.voxels.x, frame.voxels.y, frame.voxels.z}},
              {"lower", vector(frame.origin)},
              {"upper", vector(frame.upper())}}},
            {"camera",
             {{"position", vector(scene.camera.position)},
              {"target", vector(scene.camera.target)},
              {"up", vector(scene.camera.up)},
              {"fov", scene.camera.fov},
              {"width", scene.camera.width},
              {"height", scene.camera.height},
              {"samples", scene.camera.samples}}},
            {"exposure", scene.film.exposure ? Json(*scene.film.exposure) : Json("auto")},
            {"lights", Json::array()},
            {"materials", Json::array()},
            {"stage", r.stage},
            {"fraction", r.fraction},
            {"first_seconds", r.first_seconds},
            {"message", r.message}};
  for (const Light& light : scene.lights) json["lights"].push_back(light_part(light));
  add_targets(scene, json["lights"]);
  for (const Material& material : scene.medium.materials) json["materials"].push_back(material_part(material));
  json["times"] = Json::array();
  for (const StageTime& time : r.times) json["times"].push_back({{"name", time.name}, {"seconds", time.seconds}});
  if (const LivePicture* p = r.picture)
    json["picture"] = {{"number", p->number},   {"width", p->width},     {"height", p->height},
                       {"samples", p->samples}, {"refined", p->refined}, {"exposure", p->exposure},
                       {"seconds", p->seconds}};
  if (r.solver) json["solver"] = solver_part(*r.solver, r.allowed_imbalance);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string saved_json(const std::vector<std::string>& files) {
  return document({{"files", files}});
}

std::string address_json(const std::string& url) {
  return document({{"url", url}});
}

}  // namespace turbid
