// SPDX-License-Identifier: Apache-2.0
// The table of goals.
#include "host/bench/goals.h"

#include "host/bench/measure_frame.h"

namespace turbid {

const std::vector<GoalFamily>& goal_families() {
  static const std::vector<GoalFamily> list{{"frame", measure_frame}};
  return list;
}

}  // namespace turbid
