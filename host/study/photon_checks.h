// SPDX-License-Identifier: Apache-2.0
// What the photon solver answers to cases that diffusion has an answer to as well. Expected values: exact transport, or
// an own Monte Carlo program in double precision for layers and exact spheres, 2e7 photons, standard error 5e-5 to
// 8e-5.
#pragma once
#include "host/study/case.h"

namespace turbid::study {

void check_slab_photons(CaseContext&, CaseResult&);
void check_layer_photons(CaseContext&, CaseResult&);
void check_sphere_photons(CaseContext&, CaseResult&, bool glass);
void check_point_photons(CaseContext&, CaseResult&);
void check_unscattered_photons(CaseContext&, CaseResult&);
void check_fresnel_photons(CaseContext&, CaseResult&);

}  // namespace turbid::study
