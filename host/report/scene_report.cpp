// SPDX-License-Identifier: Apache-2.0
// See scene_report.h.
#include "host/report/scene_report.h"

#include <sstream>

#include "host/report/json_parts.h"
#include "host/report/text_line.h"

namespace turbid {
namespace {

std::string commented(const std::string& text) {
  std::istringstream lines(text);
  std::string out;
  for (std::string one; std::getline(lines, one);) out += one.empty() ? "#\n" : "# " + one + "\n";
  return out;
}

}  // namespace

std::string megabytes(std::uint64_t bytes) {
  return line("%.0f MB", static_cast<double>(bytes) / 1e6);
}

std::string grid_text(const SceneReport& r) {
  const GridFrame& frame = r.scene.medium.frame;
  const MediumSurvey& s = r.survey;
  std::string text = line("voxels: %d x %d x %d of %g %s, %.2f million in all\n", frame.voxels.x, frame.voxels.y,
                          frame.voxels.z, frame.voxel_size, r.scene.unit.c_str(), static_cast<double>(s.voxels) / 1e6);
  text += line("active blocks: %zu of %zu, with %.2f million scattering voxels\n", s.active_blocks, s.blocks,
               static_cast<double>(s.active_voxels) / 1e6);
  if (s.active_voxels > 0)
    text += line("optical thickness per voxel: min %.3g, median %.3g, max %.3g\n", s.thickness_min, s.thickness_median,
                 s.thickness_max);
  if (s.index_step > 0)
    text +=
        line("largest step of the index between voxels: %.3g, in \"%s\"\n", s.index_step, s.index_step_region.c_str());
  return text + "memory: about " + megabytes(s.memory_bytes) + "\n";
}

std::string scene_text(const SceneReport& r) {
  std::string notes = "needs\n";
  for (const std::string& sentence : r.features.describe()) notes += "  " + sentence + "\n";
  std::istringstream grid(grid_text(r));
  notes += "grid\n";
  for (std::string one; std::getline(grid, one);) notes += "  " + one + "\n";
  if (r.device) notes += "device\n  " + r.device->device.label() + ": " + r.device->reason + "\n";
  notes += r.warnings.empty() ? "no warnings\n" : "warnings\n";
  for (const std::string& sentence : r.warnings) notes += "  " + sentence + "\n";
  return "# " + r.scene.path + " with all defaults, scene hash " + r.scene.hash + "\n" + r.scene.effective_toml + "\n" +
         commented(notes);
}

std::string scene_json(const SceneReport& r) {
  Json json{{"format", "turbid scene 1"},
            {"version", TURBID_VERSION},
            {"scene", scene_part(r.scene)},
            {"features", features_part(r.features)},
            {"medium", medium_part(r.scene, r.survey)}};
  if (r.device) json["device"] = device_part(r.device->device);
  if (!r.output.empty()) json["outputs"] = {{"vdb", r.output}};
  json["warnings"] = r.warnings;
  return document(json);
}

}  // namespace turbid
