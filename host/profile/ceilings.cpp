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
}

double CeilingMeter::time_arithmetic(F& out) {
  return time([&] { multiply_add_.enqueue(session_.march_queue(), {kMultiplyAddItems}, {64}, out, rounds_, 0.5f, 0.5f); });
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
  F a = session_.zeros<float>(16 * items_), b = session_.zeros<float>(16 * items_), c = session_.zeros<float>(16 * items_);
  // Warm: pages are touched, kernels compiled for their work-group.
  time([&] { triad_.enqueue(queue, {items_}, {64}, a, b, c, 3.0f); });
  time([&] { copy_.enqueue(queue, {items_}, {64}, a, b); });
  time([&] { nothing_.enqueue(queue, {64}, {64}, a); });
  time_arithmetic(a);
  while (time_arithmetic(a) < kLongEnough && rounds_ < 1 << 20) rounds_ *= 2;
  for (int round = 0; round < rounds; ++round) {
    triads_.push_back(12 * floats / time([&] { triad_.enqueue(queue, {items_}, {64}, a, b, c, 3.0f); }));
    copies_.push_back(8 * floats / time([&] { copy_.enqueue(queue, {items_}, {64}, a, b); }));
    const double operations = 2.0 * 8 * 16 * static_cast<double>(kMultiplyAddItems) * rounds_;
    multiply_adds_.push_back(operations / time_arithmetic(a));
    launches_.push_back(time([&] {
                          for (int i = 0; i < kLaunches; ++i) nothing_.enqueue(queue, {64}, {64}, a);
                        }) / kLaunches);
    const double started = wall_time();
    for (int i = 0; i < kWaits; ++i) time([&] { nothing_.enqueue(queue, {64}, {64}, a); });
    waits_.push_back((wall_time() - started) / kWaits);
  }
}

Ceilings CeilingMeter::ceilings() const {
  return {spread_of(triads_), spread_of(copies_), spread_of(multiply_adds_), spread_of(launches_), spread_of(waits_)};
}

}  // namespace turbid
