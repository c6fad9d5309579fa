// SPDX-License-Identifier: Apache-2.0
// The table of goals.
#include "host/bench/goals.h"

#include "host/bench/measure_frame.h"
#include "host/bench/measure_lattice.h"
#include "host/bench/measure_rays.h"

namespace turbid {

namespace {

std::vector<Goal> rays(cl::Session& session, const BenchSettings& settings) {
  return settings.quick ? measure_rays(session, 32, 3) : measure_rays(session);
}

std::vector<Goal> lattice(cl::Session& session, const BenchSettings& settings) {
  return settings.quick ? measure_lattice(session, 32, 32, 3) : measure_lattice(session);
}

}  // namespace

const std::vector<GoalFamily>& goal_families() {
  static const std::vector<GoalFamily> list{{"lattice", lattice}, {"rays", rays}, {"frame", measure_frame}};
  return list;
}

}  // namespace turbid
