// SPDX-License-Identifier: Apache-2.0
// Host loops on all cores. Each index writes its own results, so nothing depends on the number of threads.
#pragma once
#include <functional>

namespace turbid {

/// Calls body(begin, end) on disjoint ranges that cover [0, count), from several threads. An exception is rethrown here.
void parallel_ranges(int count, const std::function<void(int begin, int end)>& body);

}  // namespace turbid
