// SPDX-License-Identifier: Apache-2.0
// What physics a scene needs; chooses programs, -D integers, allocations and launches. What is absent costs nothing.
#pragma once
#include <string>
#include <vector>

#include "host/scene/light.h"
#include "volumes/medium_volume.h"

namespace turbid {

struct SceneFeatures {
  int bodies = 0;              ///< regions besides the ambient
  bool graded_index = false;   ///< some region's index varies or is blurred: eikonal steps
  bool interfaces = false;     ///< some sharp surface has an index jump or an opaque body: zero crossings, Fresnel
  bool scattering = false;     ///< some region scatters or emits: deposit, solve, gather
  bool absorption = false;
  bool heterogeneous = false;  ///< some region's coefficients vary: coefficient tiles
  bool anisotropic = false;    ///< some g != 0
  bool emission = false;
  int channels = 3;            ///< 1 when all coefficients are grey and all lights have one colour ratio, else 3
  glm::vec3 tint{1};           ///< colour of that one channel; (1, 1, 1) with 3 channels

  bool operator==(const SceneFeatures&) const = default;

  /// The colour that a grey scene's one channel is computed for: the brightest of the tint, whose value there is 1.
  int first_colour() const;
  /// A power of the lights or of emission in the channels computed.
  glm::vec3 to_channels(glm::vec3 rgb) const {
    return channels == 3 ? rgb : glm::vec3(rgb[first_colour()] / tint[first_colour()], 0, 0);
  }

  /// One line each, for `turbid check`.
  std::vector<std::string> describe() const;
};

SceneFeatures scene_features(const MediumVolume&, const LightList&);

}  // namespace turbid
