// SPDX-License-Identifier: Apache-2.0
// The files that cases come from, one per topic. Private to host/study.
#pragma once
#include <vector>

#include "host/study/case.h"

namespace turbid::study {

std::vector<Case> lattice_cases();        ///< cases_lattice.cpp
std::vector<Case> wave_cases();           ///< cases_waves.cpp
std::vector<Case> boundary_cases();       ///< cases_boundary.cpp
std::vector<Case> beam_cases();           ///< cases_beam.cpp
std::vector<Case> path_cases();           ///< cases_paths.cpp
std::vector<Case> surface_cases();        ///< cases_surfaces.cpp
std::vector<Case> transport_cases();      ///< cases_transport.cpp
std::vector<Case> view_cases();           ///< cases_view.cpp
std::vector<Case> stopping_cases();       ///< cases_stopping.cpp
std::vector<Case> photon_cases();         ///< cases_photon.cpp
std::vector<Case> estimate_cases();       ///< cases_estimate.cpp
std::vector<Case> settings_cases();       ///< cases_settings.cpp
std::vector<Case> hard_media_cases();     ///< hard_media.cpp
std::vector<Case> hard_contrast_cases();  ///< hard_contrast.cpp
std::vector<Case> hard_void_cases();      ///< hard_voids.cpp
std::vector<Case> hard_index_cases();     ///< hard_index.cpp
std::vector<Case> hard_ray_cases();       ///< hard_rays.cpp
std::vector<Case> hard_shape_cases();     ///< hard_shapes.cpp

}  // namespace turbid::study
