// SPDX-License-Identifier: Apache-2.0
#include "host/bench/goal.h"

namespace turbid {

bool Goal::passed() const { return at_least ? ratio >= aim : ratio <= aim; }

}  // namespace turbid
