// SPDX-License-Identifier: Apache-2.0
// One small scene for each kind of medium, surface, light and domain face: where every watt must be found again.
#pragma once
#include <string>
#include <vector>

#include "host/study/small_media.h"

namespace turbid::study {

struct EnergyMedium {
  std::string name;
  MediumDescription scene;
  LightList lights;
};

std::vector<EnergyMedium> energy_media();

}  // namespace turbid::study
