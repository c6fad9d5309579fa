// SPDX-License-Identifier: Apache-2.0
// How much device memory a session holds: now, at its peak, and by the stage that asked for it.
#pragma once
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>

namespace turbid::cl {

struct MemoryCount {
  std::size_t now = 0, peak = 0;            ///< [bytes]
  std::size_t allocations = 0;              ///< buffers asked for so far
  std::string stage;                        ///< what allocates now; "" until a recorder names it
  std::map<std::string, std::size_t> by_stage;  ///< bytes asked for in each stage, freed ones included

  void add(std::size_t bytes) {
    now += bytes;
    peak = now > peak ? now : peak;
    ++allocations;
    by_stage[stage] += bytes;
  }
};

/// A buffer's share of the count, given back when the buffer goes.
class CountedBytes {
 public:
  CountedBytes() = default;
  CountedBytes(std::shared_ptr<MemoryCount> count, std::size_t bytes) : count_(std::move(count)), bytes_(bytes) {
    if (count_) count_->add(bytes_);
  }
  CountedBytes(CountedBytes&& other) noexcept
      : count_(std::move(other.count_)), bytes_(std::exchange(other.bytes_, 0)) {}
  CountedBytes& operator=(CountedBytes&& other) noexcept {
    std::swap(count_, other.count_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  CountedBytes(const CountedBytes&) = delete;
  CountedBytes& operator=(const CountedBytes&) = delete;
  ~CountedBytes() {
    if (count_) count_->now -= bytes_;
  }

 private:
  std::shared_ptr<MemoryCount> count_;
  std::size_t bytes_ = 0;
};

}  // namespace turbid::cl
