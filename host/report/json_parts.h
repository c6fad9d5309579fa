// SPDX-License-Identifier: Apache-2.0
// Pieces that several JSON documents share. Private to host/report, the only user of nlohmann-json.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "host/cl/device.h"
#include "host/study/medium_survey.h"
#include "host/scene/features.h"
#include "host/scene/scene.h"

namespace turbid {

using Json = nlohmann::ordered_json;

Json scene_part(const Scene&);
Json features_part(const SceneFeatures&);
Json medium_part(const Scene&, const MediumSurvey&);
Json device_part(const cl::DeviceInfo&);
Json colours(glm::dvec3);

/// Indented, one line feed at the end; bytes that are no UTF-8 (in file names, say) become U+FFFD.
std::string document(const Json&);

}  // namespace turbid
