// SPDX-License-Identifier: Apache-2.0
// report.json.
#include "host/base/memory.h"
#include "host/report/json_parts.h"
#include "host/report/run_report.h"

namespace turbid {
namespace {

const char* const kFaces[6] = {"-x", "+x", "-y", "+y", "-z", "+z"};

Json energy_part(const EnergyBalance& e, double allowed) {
  Json faces;
  for (std::size_t face = 0; face < 6; ++face) faces[kFaces[face]] = colours(e.escaped_faces[face]);
  return {{"unit", "W"},
          {"emitted", colours(e.emitted)},
          {"missed", colours(e.missed)},
          {"reflected_at_entry", colours(e.reflected)},
          {"absorbed", colours(e.absorbed)},
          {"absorbed_by_opaque", colours(e.absorbed_opaque)},
          {"escaped", colours(e.escaped)},
          {"escaped_faces", faces},
          {"in_flight", colours(e.in_flight)},
          {"roulette", colours(e.roulette)},
          {"rounding", colours(e.rounding)},
          {"imbalance", e.imbalance()},
          {"allowed_imbalance", allowed},
          {"balanced", e.imbalance() <= allowed}};
}

Json estimate(const Estimate& e) {
  return {{"value", colours(e.value)}, {"standard_error", colours(e.error)}};
}

Json photon_part(const PhotonTallies& t) {
  Json faces, unscattered, regions = Json::array();
  for (std::size_t face = 0; face < 6; ++face) {
    faces[kFaces[face]] = estimate(t.escaped_faces[face]);
    unscattered[kFaces[face]] = estimate(t.unscattered_faces[face]);
  }
  for (const Estimate& region : t.absorbed_regions) regions.push_back(estimate(region));
  return {{"photons", t.photons},
          {"batches", t.batches},
          {"reflected_at_entry", estimate(t.reflected)},
          {"absorbed", estimate(t.absorbed)},
          {"absorbed_regions", regions},
          {"absorbed_by_opaque", estimate(t.absorbed_opaque)},
          {"escaped", estimate(t.escaped)},
          {"escaped_faces", faces},
          {"unscattered", estimate(t.unscattered)},
          {"unscattered_faces", unscattered},
          {"in_flight", estimate(t.in_flight)},
          {"roulette", estimate(t.roulette)}};
}

Json error_parts(const ErrorParts& e) {
  return {{"total", e.total()}, {"grid", e.grid},   {"steps", e.steps},
          {"rays", e.rays},     {"solve", e.solve}, {"model", e.model}};
}

Json error_part(const ErrorEstimate& e) {
  Json part{{"fluence", error_parts(e.fluence)}};
  part["fluence"]["measure"] = "relative L2 of the total fluence";
  if (e.image) {
    part["picture"] = error_parts(*e.image);
    part["picture"]["measure"] = "root of relMSE";
  }
  part["basis"] = e.basis;
  part["seconds"] = e.seconds;
  return part;
}

Json seconds_part(const std::vector<StageTime>& times) {
  Json part = Json::object();
  double total = 0;
  for (const StageTime& stage : times) {
    part[stage.name] = part.value(stage.name, 0.0) + stage.seconds;
    total += stage.seconds;
  }
  part["total"] = total;
  return part;
}

Json named(const NamedTexts& texts) {
  Json part = Json::object();
  for (const auto& [name, text] : texts) part[name] = text;
  return part;
}

}  // namespace

std::string report_json(const RunReport& r) {
  const SolverReport& s = r.solver;
  Json json{{"format", "turbid report 1"},
            {"version", TURBID_VERSION},
            {"command", r.command_line},
            {"scene", scene_part(r.scene)},
            {"device", device_part(r.device.device)},
            {"features", features_part(r.features)},
            {"medium", medium_part(r.scene, r.survey)},
            {"solver",
             {{"name", s.solver},
              {"seed", r.scene.solver.seed},
              {"channels", s.channels},
              {"rays", s.rays},
              {"march_batches", s.march_batches},
              {"iterations", s.iterations},
              {"error_estimate", s.error_estimate},
              {"storage_error", s.storage_error},
              {"active_blocks", s.active_blocks},
              {"active_voxels", s.active_voxels},
              {"diffusion_bytes", s.diffusion_bytes}}},
            {"energy", energy_part(s.energy, r.allowed_imbalance)}};
  json["device"]["chosen_because"] = r.device.reason;
  if (r.exposure) {
    const Camera& camera = r.scene.camera;
    json["picture"] = {{"width", camera.width},
                       {"height", camera.height},
                       {"samples", camera.samples},
                       {"exposure_stops", *r.exposure}};
  }
  if (!r.chosen.empty()) json["chosen"] = r.chosen;
  if (r.error) json["error_estimate"] = error_part(*r.error);
  if (s.photon) json["photon"] = photon_part(*s.photon);
  json["seconds"] = seconds_part(r.times);
  json["peak_memory_bytes"] = peak_memory();
  json["checksums"] = named(r.checksums);
  json["outputs"] = named(r.outputs);
  json["warnings"] = r.warnings;
  return document(json);
}

}  // namespace turbid
