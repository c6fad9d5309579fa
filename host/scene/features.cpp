// SPDX-License-Identifier: Apache-2.0
// What physics a scene needs, from its regions, its voxels where coefficients vary, and its lights. See features.h.
#include "host/scene/features.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace turbid {
namespace {

constexpr float kSame = 1e-6f;  // relative: what float input and float means round to

bool grey(glm::vec3 v) {
  return std::fabs(v.x - v.y) <= kSame * std::fabs(v.x) && std::fabs(v.x - v.z) <= kSame * std::fabs(v.x);
}

float largest(glm::vec3 v) {
  return std::max({v.x, v.y, v.z});
}

/// The one colour that all sources share, as long as they do.
class SharedColour {
 public:
  void add(glm::vec3 power) {
    const float scale = largest(power);
    if (!(scale > 0)) return;
    const glm::vec3 colour = power / scale;
    if (!colour_) colour_ = colour;
    const glm::vec3 difference = glm::abs(colour - *colour_);
    shared_ = shared_ && largest(difference) <= kSame;
  }
  bool shared() const { return shared_; }
  glm::vec3 colour() const { return colour_.value_or(glm::vec3(1)); }

 private:
  std::optional<glm::vec3> colour_;
  bool shared_ = true;
};

bool index_jump(const MediumVolume& medium, int body) {
  const Region& inside = medium.region(body);
  for (int r = 0; r < medium.region_count(); ++r) {
    const Region& outside = medium.region(r);
    if (r == body || outside.opaque) continue;
    if (inside.graded_index || outside.graded_index || std::fabs(inside.eta - outside.eta) > kSame * inside.eta)
      return true;
  }
  return false;
}

/// What constants can't tell: looks at the voxels of the blocks that a region with varying coefficients touches.
class VoxelSurvey {
 public:
  VoxelSurvey(const MediumVolume& medium, SharedColour& sources) : medium_(medium), sources_(sources) {}

  void look(int r) {
    const glm::ivec3 n = medium_.frame().voxels;
    const glm::ivec3 slab(n.x, n.y, kBlockEdge);
    std::vector<int> owner(static_cast<std::size_t>(slab.x) * slab.y * slab.z);
    std::vector<Coefficients> at(owner.size());
    for (int z = 0; z < n.z && !finished(); z += kBlockEdge) {
      medium_.read_owner({0, 0, z}, slab, owner);
      if (std::find(owner.begin(), owner.end(), r) == owner.end()) continue;
      medium_.read_coefficients(r, {0, 0, z}, slab, at);
      for (std::size_t i = 0; i < owner.size(); ++i)
        if (owner[i] == r) take(at[i]);
    }
  }
  bool grey_medium = true, anisotropic = false;

 private:
  bool finished() const { return anisotropic && !(grey_medium && sources_.shared()); }
  void take(const Coefficients& c) {
    grey_medium = grey_medium && grey(c.sigma_s) && grey(c.sigma_a);
    anisotropic = anisotropic || c.g != 0;
    sources_.add(c.emission);
  }

  const MediumVolume& medium_;
  SharedColour& sources_;
};

std::string colour_text(glm::vec3 c) {
  char text[64];
  std::snprintf(text, sizeof text, "(%.3g, %.3g, %.3g)", c.x, c.y, c.z);
  return text;
}

}  // namespace

SceneFeatures scene_features(const MediumVolume& medium, const LightList& lights) {
  SceneFeatures features;
  features.bodies = medium.region_count() - 1;
  SharedColour sources;
  for (const Light& light : lights) sources.add(light.kind == LightKind::directional ? light.irradiance : light.power);
  bool grey_medium = true;
  for (int r = 0; r < medium.region_count(); ++r) {
    const Region& region = medium.region(r);
    if (region.opaque) {
      features.interfaces = true;
      continue;
    }
    features.graded_index = features.graded_index || region.graded_index;
    features.scattering = features.scattering || region.participates();
    features.absorption = features.absorption || region.absorbs;
    features.emission = features.emission || region.emits;
    features.heterogeneous = features.heterogeneous || region.heterogeneous;
    features.anisotropic = features.anisotropic || region.g != 0;
    if (r > 0 && !region.smooth_surface) features.interfaces = features.interfaces || index_jump(medium, r);
    grey_medium = grey_medium && grey(region.sigma_s) && grey(region.sigma_a);
    if (!region.heterogeneous) sources.add(region.emission);
  }
  VoxelSurvey survey(medium, sources);
  survey.grey_medium = grey_medium;
  survey.anisotropic = features.anisotropic;
  for (int r = 0; r < medium.region_count(); ++r)
    if (!medium.region(r).opaque && medium.region(r).heterogeneous) survey.look(r);
  features.anisotropic = survey.anisotropic;
  if (survey.grey_medium && sources.shared()) {
    features.channels = 1;
    features.tint = sources.colour();
  }
  return features;
}

std::vector<std::string> SceneFeatures::describe() const {
  std::vector<std::string> lines;
  lines.push_back("bodies: " + std::to_string(bodies));
  lines.push_back(std::string("refraction: ") + (graded_index && interfaces
                                                     ? "curved rays and interfaces (Snell, Fresnel)"
                                                 : graded_index ? "curved rays"
                                                 : interfaces   ? "interfaces (Snell, Fresnel)"
                                                                : "none, straight rays"));
  lines.push_back(std::string("scattering: ") + (!scattering   ? "none, nothing to solve for"
                                                 : anisotropic ? "anisotropic"
                                                               : "isotropic"));
  lines.push_back(std::string("absorption: ") + (absorption ? "yes" : "none"));
  lines.push_back(std::string("emission: ") + (emission ? "yes" : "none"));
  lines.push_back(std::string("coefficients: ") + (heterogeneous ? "vary within a body" : "constant within each body"));
  lines.push_back(channels == 1 ? "colours: one channel, tint " + colour_text(tint) : "colours: three channels");
  return lines;
}

int SceneFeatures::first_colour() const {
  if (channels == 3) return 0;
  return tint.r >= tint.g && tint.r >= tint.b ? 0 : tint.g >= tint.b ? 1 : 2;
}

}  // namespace turbid
