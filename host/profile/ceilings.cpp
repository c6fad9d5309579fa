// SPDX-License-Identifier: Apache-2.0
// Times streams, multiply-adds and launches by the wall clock, around launch and finish.
#include "host/profile/ceilings.h"

#include <algorithm>

#include "host/base/progress.h"

namespace turbid {
namespace {

constexpr std::size_t kStreamBytes = std::size_t{96} << 20;  // per array: beyond any last-level cache
constexpr std::size_t kMultiplyAddItems = 1 << 14;
constexpr double kLongEnough = 4e-3;                         // [s] of multiply-adds: a thousand launches' worth
constexpr int kLaunches = 200, kWaits = 20;

}  // namespace

CeilingMeter::CeilingMeter(cl::Session& session)
    : session_(session), program_(session.build("ceilings.cl", {})), triad_(program_, "triad"),
      copy_(program_, "stream_copy"), multiply_add_(program_, "multiply_add"), nothing_(program_, "nothing") {
  const std::size_t offered = std::min<std::size_t>(session.device().max_allocation, session.device().global_memory / 8);
  items_ = std::min(kStreamBytes, offered) / 64 / 64 * 64;
  a_ = session.zeros<float>(16 * items_);
  b_ = session.zeros<float>(16 * items_);
  c_ = session.zeros<float>(16 * items_);
  cl::Queue& queue = session.march_queue();
  const auto arithmetic = [&] { multiply_add_.enqueue(queue, {kMultiplyAddItems}, {64}, a_, rounds_, 0.5f, 0.5f); };
  time([&] { triad_.enqueue(queue, {items_}, {64}, a_, b_, c_, 3.0f); });
  time([&] { copy_.enqueue(queue, {items_}, {64}, a_, b_); });
  time([&] { nothing_.enqueue(queue, {64}, {64}, a_); });
  time(arithmetic);
  while (time(arithmetic) < kLongEnough && rounds_ < 1 << 20) rounds_ *= 2;
}

double CeilingMeter::time(const std::function<void()>& enqueue) {
  cl::Queue& queue = session_.march_queue();
  queue.finish();
  const double started = wall_time();
  enqueue();
  queue.finish();
  return wall_time() - started;
}

void CeilingMeter::measure(int rounds) {
  cl::Queue& queue = session_.march_queue();
  const double floats = 16.0 * static_cast<double>(items_);
  for (int round = 0; round < rounds; ++round) {
    triads_.push_back(12 * floats / time([&] { triad_.enqueue(queue, {items_}, {64}, a_, b_, c_, 3.0f); }));
    copies_.push_back(8 * floats / time([&] { copy_.enqueue(queue, {items_}, {64}, a_, b_); }));
    const double operations = 2.0 * 8 * 16 * static_cast<double>(kMultiplyAddItems) * rounds_;
    multiply_adds_.push_back(
        operations / time([&] { multiply_add_.enqueue(queue, {kMultiplyAddItems}, {64}, a_, rounds_, 0.5f, 0.5f); }));
    launches_.push_back(time([&] {
                          for (int i = 0; i < kLaunches; ++i) nothing_.enqueue(queue, {64}, {64}, a_);
                        }) / kLaunches);
    const double started = wall_time();
    for (int i = 0; i < kWaits; ++i) time([&] { nothing_.enqueue(queue, {64}, {64}, a_); });
    waits_.push_back((wall_time() - started) / kWaits);
  }
}

Ceilings CeilingMeter::ceilings() const {
  return {spread_of(triads_), spread_of(copies_), spread_of(multiply_adds_), spread_of(launches_), spread_of(waits_)};
}

}  // namespace turbid
