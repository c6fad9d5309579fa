// SPDX-License-Identifier: Apache-2.0
// The files that cases come from, one per topic. Private to host/study.
#pragma once
#include <vector>

#include "host/study/case.h"

namespace turbid::study {

std::vector<Case> lattice_cases();   ///< cases_lattice.cpp
std::vector<Case> wave_cases();      ///< cases_waves.cpp
std::vector<Case> boundary_cases();  ///< cases_boundary.cpp
std::vector<Case> stopping_cases();  ///< cases_stopping.cpp

}  // namespace turbid::study
