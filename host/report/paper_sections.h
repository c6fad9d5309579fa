// SPDX-License-Identifier: Apache-2.0
// The sections of the page on the paper's scheme. Private to host/report.
#pragma once
#include "host/report/document.h"
#include "host/study/paper_scheme.h"

namespace turbid {

Section paper_stability(const std::vector<study::Stability>&);
Section paper_energy(const study::ClosedBox&);
Section paper_stopping(const std::vector<study::Stopping>&);
Section paper_cost(const std::vector<study::Cost>&);
Section paper_bending(const std::vector<study::FocusError>&, const std::array<double, 3>& refraction);
Section paper_deposits(const std::vector<study::Attenuation>&);
Section paper_directions(const study::Directions&);

}  // namespace turbid
