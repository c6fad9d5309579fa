// SPDX-License-Identifier: Apache-2.0
// See json_parts.h.
#include "host/report/json_parts.h"

#include <charconv>

namespace turbid {
namespace {

/// The shortest decimal that reads back as the same float: 0.1, not 0.10000000149.
double decimal(float value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  double number = value;
  std::from_chars(text, end, number);
  return number;
}

Json vector(glm::vec3 v) {
  return Json::array({decimal(v.x), decimal(v.y), decimal(v.z)});
}

}  // namespace

Json colours(glm::dvec3 v) {
  return Json::array({v.x, v.y, v.z});
}

Json scene_part(const Scene& scene) {
  return {{"file", scene.path},
          {"name", scene.name},
          {"hash", scene.hash},
          {"unit", scene.unit},
          {"effective", scene.effective_toml}};
}

Json features_part(const SceneFeatures& f) {
  return {{"bodies", f.bodies},           {"graded_index", f.graded_index}, {"interfaces", f.interfaces},
          {"scattering", f.scattering},   {"absorption", f.absorption},     {"heterogeneous", f.heterogeneous},
          {"anisotropic", f.anisotropic}, {"emission", f.emission},         {"channels", f.channels},
          {"tint", vector(f.tint)}};
}

Json medium_part(const Scene& scene, const MediumSurvey& s) {
  const GridFrame& frame = scene.medium.frame;
  Json part{{"grid", {frame.voxels.x, frame.voxels.y, frame.voxels.z}},
            {"voxel_size", decimal(frame.voxel_size)},
            {"origin", vector(frame.origin)},
            {"voxels", s.voxels},
            {"blocks", s.blocks},
            {"active_blocks", s.active_blocks},
            {"active_voxels", s.active_voxels}};
  part["optical_thickness"] = s.active_voxels == 0 ? Json(nullptr)
                                                   : Json{{"min", decimal(s.thickness_min)},
                                                          {"median", decimal(s.thickness_median)},
                                                          {"max", decimal(s.thickness_max)}};
  part["largest_index_step"] = decimal(s.index_step);
  part["memory_estimate_bytes"] = s.memory_bytes;
  return part;
}

Json device_part(const cl::DeviceInfo& d) {
  return {{"number", std::to_string(d.platform_index) + ":" + std::to_string(d.device_index)},
          {"name", d.name},
          {"platform", d.platform_name},
          {"vendor", d.vendor},
          {"driver", d.driver},
          {"version", d.version},
          {"type", d.gpu   ? "gpu"
                   : d.cpu ? "cpu"
                           : "other"},
          {"compute_units", d.compute_units},
          {"memory_bytes", d.global_memory},
          {"largest_buffer_bytes", d.max_allocation}};
}

std::string document(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace turbid
