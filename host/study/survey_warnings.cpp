// SPDX-License-Identifier: Apache-2.0
// What is doubtful in a voxelised scene, one sentence each, with the way out.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/study/medium_survey.h"

namespace turbid {
namespace {

constexpr float kThickVoxel =
    5.0f;  // sigma_t h: a half-space returns 1 % too little of a beam at 5, 5 % too much at 10
constexpr float kThickAmbient = 2.0f;  // the same where light enters through the domain's faces: 6 % too little at 2
constexpr float kIndexStep = 0.1f;     // |difference of eta| between neighbours: beyond it a ray's bend is not resolved
constexpr float kThinObject = 3.0f;    // voxels across: below it no voxel may lie wholly inside

std::string text(const char* format, auto... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

/// Region that owns a point of the scene; -1 outside the domain.
int owner_at(const MediumVolume& medium, glm::vec3 point) {
  const GridFrame& frame = medium.frame();
  const glm::vec3 voxel = glm::floor((point - frame.origin) / frame.voxel_size);
  for (int axis = 0; axis < 3; ++axis)
    if (!(voxel[axis] >= 0 && voxel[axis] < static_cast<float>(frame.voxels[axis]))) return -1;
  int owner = -1;
  medium.read_owner(glm::ivec3(voxel), glm::ivec3(1), {&owner, 1});
  return owner;
}

bool is_void(const Region& region) {
  return !region.opaque && !region.participates() && !region.absorbs && !region.graded_index && region.eta == 1.0f;
}

void warn_of_place(std::vector<std::string>& warnings, const MediumVolume& medium, const std::string& who,
                   glm::vec3 point, const std::string& consequence) {
  const int owner = owner_at(medium, point);
  if (owner < 0 || is_void(medium.region(owner))) return;
  const Region& region = medium.region(owner);
  const std::string where = owner == 0 ? "the domain's own medium" : "\"" + region.name + "\"";
  warnings.push_back(region.opaque ? who + " stands inside " + where + ", which is opaque: it can't be seen from there"
                                   : who + " stands inside " + where + consequence);
}

}  // namespace

std::vector<std::string> survey_warnings(const Scene& scene, const MediumVolume& medium, const MediumSurvey& survey) {
  std::vector<std::string> warnings;
  const GridFrame& frame = medium.frame();
  const double resolution = std::max({frame.voxels.x, frame.voxels.y, frame.voxels.z});
  const bool ambient = survey.first_flight_ambient > kThickAmbient && survey.first_flight_max <= kThickVoxel;
  const float thickest = ambient ? survey.first_flight_ambient : survey.first_flight_max,
              limit = ambient ? kThickAmbient : kThickVoxel;
  if (thickest > limit)
    warnings.push_back(text(
        "voxels%s are optically too thick: sigma_t * voxel size reaches %.3g, more than %g; a resolution of %.0f or "
        "more would resolve it",
        ambient ? " of the domain's own medium" : "", thickest, limit, std::ceil(resolution * thickest / limit)));
  for (const std::string& name : survey.unseen)
    warnings.push_back("object \"" + name +
                       "\" holds no voxel's centre: it is hardly seen, and light that it scatters counts as absorbed; "
                       "raise the resolution");
  if (survey.index_step > kIndexStep)
    warnings.push_back(
        text("the refractive index of \"%s\" changes by %.3g from one voxel to the next, more than %g: rays may bend "
             "wrongly there; raise the resolution or the smoothing",
             survey.index_step_region.c_str(), survey.index_step, kIndexStep));
  for (const Light& light : scene.lights)
    if (light.kind != LightKind::directional)
      warn_of_place(warnings, medium, light.name, light.position,
                    ": its rays start there, evenly in all directions it shines to");
  if (scene.has_camera)
    warn_of_place(warnings, medium, "the camera", scene.camera.position, ": it sees only what lies inside");
  for (const Body& body : scene.medium.bodies) {
    const glm::vec3 size = bounds(body.solid.mesh).size() / frame.voxel_size;
    const float thinnest = std::min({size.x, size.y, size.z});
    if (thinnest < kThinObject)
      warnings.push_back(text("object \"%s\" is only %.2g voxels thick; a resolution of %.0f or more would resolve it",
                              body.name.c_str(), thinnest,
                              std::ceil(resolution * kThinObject / std::max(thinnest, 1e-3f))));
  }
  const int thinnest_side = std::min({frame.voxels.x, frame.voxels.y, frame.voxels.z});
  if (scene.medium.bodies.empty() && thinnest_side <= kBlockEdge)
    warnings.push_back(text("the domain is only %d voxels thick; raise the resolution", thinnest_side));
  return warnings;
}

}  // namespace turbid
