// SPDX-License-Identifier: Apache-2.0
// host/study's photon runs on the tests' session.
#pragma once
#include <gtest/gtest.h>

#include "host/study/photon_runs.h"
#include "tests/support/test_media.h"

namespace turbid::test {

using study::PhotonAnswer, study::photons, study::pull, study::slab, study::source;

inline PhotonAnswer follow(const MediumDescription& description, const SolverSettings& settings,
                           const std::vector<PhotonSource>& sources) {
  return study::follow(session(), description, settings, sources);
}
inline PhotonAnswer follow(const MediumDescription& description, const SolverSettings& settings, const LightList& lights,
                           const Surroundings& surroundings = {}) {
  return study::follow(session(), description, settings, lights, surroundings);
}

inline Material milk(float sigma_s, float sigma_a, float eta = 1, float g = 0) {
  return make_material({.sigma_s = glm::vec3(sigma_s), .sigma_a = glm::vec3(sigma_a), .eta = eta, .g = g});
}

/// Weights telescope in integers: nothing is left but the rounding of their conversion to watts.
inline void expect_balance(const LightSolution& solution) { EXPECT_LT(solution.report.energy.imbalance(), 1e-12); }

inline constexpr glm::vec3 kLitPoint(3.5f, 3.5f, 0);  ///< of the face that slabs are lit through

}  // namespace turbid::test
