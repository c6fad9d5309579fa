// SPDX-License-Identifier: Apache-2.0
// GCC's vectors: four lanes hold a point or a colour, eight the two x-neighbours of a node; AVX2 and AVX-512 where the
// machine has them. Threads claim rays 64 at a time, as the kernels do.
#include "host/bench/reference_march.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>

namespace turbid::reference {
namespace {

typedef float Four __attribute__((vector_size(16)));
typedef int Four32 __attribute__((vector_size(16)));
typedef float Eight __attribute__((vector_size(32)));

constexpr int kInterleave = 8, kClaim = 64;

template <class V>
V load(const float* from) {
  V value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
Four low(Eight v) { return __builtin_shufflevector(v, v, 0, 1, 2, 3); }
Four high(Eight v) { return __builtin_shufflevector(v, v, 4, 5, 6, 7); }
Four three(const float* v) { return Four{v[0], v[1], v[2], 0.0f}; }
float dot(Four a, Four b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
float largest(Four v) { return std::max(v[0], std::max(v[1], v[2])); }

Four interpolate(const float* at, int n, Four f) {
  const Eight a = load<Eight>(at), b = load<Eight>(at + 4 * n);
  const Eight c = load<Eight>(at + 4 * n * n), d = load<Eight>(at + 4 * (n * n + n));
  const Eight near = a + f[2] * (c - a), far = b + f[2] * (d - b);
  const Eight row = near + f[1] * (far - near);
  return low(row) + f[0] * (high(row) - low(row));
}

/// (1 - exp(-x)) / x, as kernels/lib/attenuation.h.
Four mean_transmittance(Four x) {
  Four mean = 1.0f / 720.0f - x * (1.0f / 5040.0f - x * (1.0f / 40320.0f));
  mean = 0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f - x * (1.0f / 120.0f - x * mean)));
  mean = 1.0f - x * mean;
  if (largest(x) > 0.5f) {
    for (int c = 0; c < 3; ++c) {
      if (x[c] > 0.5f) mean[c] = -std::expm1(-x[c]) / x[c];
    }
  }
  return mean;
}

struct Lane {
  Four x, v, weight, gathered;
  std::ptrdiff_t ray = -1;
};

/// One step; false when the ray has ended. Gathering and marching differ in what a segment is good for.
template <bool gathering>
bool advance(const RayMedium& m, Lane& lane, float step, float min_weight) {
  const int n = m.n;
  const float dtau = step * m.tau_per_arc, size = static_cast<float>(n), last = static_cast<float>(n - 1);
  const Four middle = lane.x + 0.5f * dtau * lane.v;
  const Four zero{}, top{last, last, last, last};
  Four y = middle - 0.5f;
  y = y < zero ? zero : y;
  y = y > top ? top : y;
  Four32 i = __builtin_convertvector(y, Four32);
  const Four32 cells{n - 2, n - 2, n - 2, 0};
  i = i > cells ? cells : i;
  const Four f = y - __builtin_convertvector(i, Four);
  const std::size_t node = 4 * (i[0] + static_cast<std::size_t>(n) * (i[1] + n * i[2]));
  Four u = interpolate(m.index.data() + node, n, f);
  u[3] = 0.0f;
  const Four v = lane.v + dtau * u;
  const Four to = middle + 0.5f * dtau * v;
  const Four mean = 0.5f * (lane.v + v);
  const float eta_squared = dot(mean, mean);
  float length = dtau * std::sqrt(eta_squared);
  const bool inside = to[0] >= 0 && to[1] >= 0 && to[2] >= 0 && to[0] <= size && to[1] <= size && to[2] <= size;
  if (!inside) {
    float part = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const float from = lane.x[axis], d = to[axis] - from;
      if (to[axis] < 0) part = std::min(part, std::max(-from / d, 0.0f));
      if (to[axis] > size) part = std::min(part, std::max((size - from) / d, 0.0f));
    }
    length *= part;
  }
  const Four depth = (load<Four>(m.sigma_s.data()) + load<Four>(m.sigma_a.data())) * length;
  const Four share = lane.weight * mean_transmittance(depth);
  if constexpr (gathering) {
    const Four source = interpolate(m.source.data() + node, n, f);
    lane.gathered += share * source * (length * 0.0795774715f / eta_squared);
  }
  lane.weight -= share * depth;
  lane.x = to;
  lane.v = v;
  return inside && (!gathering || largest(lane.weight) >= min_weight);
}

/// All rays on all threads; `end(thread, lane)` takes an ended ray's result.
template <bool gathering, class End>
std::int64_t follow(const RayMedium& m, const std::vector<RayStart>& rays, float step, float min_weight, int threads,
                    const End& end) {
  std::atomic<std::size_t> claims{0};
  std::vector<std::int64_t> steps(threads, 0);
  const auto work = [&](int thread) {
    Lane lanes[kInterleave];
    std::size_t next = 0, last = 0;
    std::int64_t done = 0;
    for (bool busy = true; busy;) {
      busy = false;
      for (Lane& lane : lanes) {
        if (lane.ray < 0) {
          if (next == last) {
            next = std::min(claims.fetch_add(kClaim), rays.size());
            last = std::min(next + kClaim, rays.size());
            if (next == last) continue;
          }
          const RayStart& start = rays[next];
          lane = {three(start.position), three(start.velocity), load<Four>(start.power), Four{},
                  static_cast<std::ptrdiff_t>(next++)};
        }
        busy = true;
        ++done;
        if (advance<gathering>(m, lane, step, min_weight)) continue;
        end(thread, lane);
        lane.ray = -1;
      }
    }
    steps[thread] = done;
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < threads; ++t) pool.emplace_back(work, t);
  work(0);
  for (std::thread& thread : pool) thread.join();
  std::int64_t sum = 0;
  for (std::int64_t count : steps) sum += count;
  return sum;
}

}  // namespace

MarchSums march_rays(const RayMedium& medium, const std::vector<RayStart>& rays, float step, int threads) {
  std::vector<MarchSums> parts(threads);
  MarchSums sums;
  sums.steps = follow<false>(medium, rays, step, 0.0f, threads, [&](int thread, const Lane& lane) {
    for (int c = 0; c < 3; ++c) {
      parts[thread].escaped[c] += lane.weight[c];
      parts[thread].absorbed[c] += static_cast<double>(rays[lane.ray].power[c]) - lane.weight[c];
    }
  });
  for (const MarchSums& part : parts) {
    for (int c = 0; c < 3; ++c) {
      sums.escaped[c] += part.escaped[c];
      sums.absorbed[c] += part.absorbed[c];
    }
  }
  return sums;
}

std::int64_t gather_rays(const RayMedium& medium, const std::vector<RayStart>& rays, float step, float min_weight,
                         int threads, std::vector<float>* radiance) {
  radiance->assign(4 * rays.size(), 0.0f);
  return follow<true>(medium, rays, step, min_weight, threads, [&](int, const Lane& lane) {
    std::memcpy(radiance->data() + 4 * lane.ray, &lane.gathered, sizeof lane.gathered);
  });
}

}  // namespace turbid::reference
