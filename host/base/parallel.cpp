// SPDX-License-Identifier: Apache-2.0
// A fresh set of threads per loop: host loops are few and long.
#include "host/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace turbid {

void parallel_ranges(int count, const std::function<void(int, int)>& body) {
  const int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int chunk = std::max(1, count / (threads * 8));
  if (count <= chunk || threads == 1) {
    if (count > 0) body(0, count);
    return;
  }
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  auto work = [&] {
    try {
      for (int begin = next.fetch_add(chunk); begin < count; begin = next.fetch_add(chunk)) {
        body(begin, std::min(begin + chunk, count));
      }
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back(work);
  work();
  for (std::thread& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace turbid
