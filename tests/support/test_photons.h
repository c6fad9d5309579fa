// SPDX-License-Identifier: Apache-2.0
// host/study's photon runs on the tests' session.
#pragma once
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

}  // namespace turbid::test
