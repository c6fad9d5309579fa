// SPDX-License-Identifier: Apache-2.0
#include "tests/support/test_media.h"

#include <cmath>

namespace turbid::test {

cl::Session& session() {
  static cl::Session shared(cl::choose_device(""));
  return shared;
}

double observed_order(double coarse_error, double fine_error, double refinement) {
  return std::log(coarse_error / fine_error) / std::log(refinement);
}

}  // namespace turbid::test
