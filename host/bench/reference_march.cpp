// SPDX-License-Identifier: Apache-2.0
// GCC's vectors. Sixteen rays go in step: positions, velocities and weights stand component by component, one lane per ray, so
// that a 512-bit instruction serves all of them; only the corners of a cell are loaded ray by ray, the two x-neighbours and
// all four components of a node at once. Threads claim rays 64 at a time, as the kernels do.
#include "host/bench/reference_march.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>

namespace turbid::reference {
namespace {

constexpr int kLanes = 16, kClaim = 64;

typedef float Four __attribute__((vector_size(16)));
typedef float Eight __attribute__((vector_size(32)));
typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef int Lanes32 __attribute__((vector_size(4 * kLanes)));

template <class V>
V load(const float* from) {
  V value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

Lanes least(Lanes a, Lanes b) { return a < b ? a : b; }
Lanes greatest(Lanes a, Lanes b) { return a > b ? a : b; }
Lanes root(Lanes a) {
  for (int i = 0; i < kLanes; ++i) a[i] = std::sqrt(a[i]);
  return a;
}
bool any(Lanes32 mask) {
  const auto eight = __builtin_shufflevector(mask, mask, 0, 1, 2, 3, 4, 5, 6, 7) |
                     __builtin_shufflevector(mask, mask, 8, 9, 10, 11, 12, 13, 14, 15);
  const auto four = __builtin_shufflevector(eight, eight, 0, 1, 2, 3) | __builtin_shufflevector(eight, eight, 4, 5, 6, 7);
  long both[2];
  std::memcpy(both, &four, sizeof both);
  return (both[0] | both[1]) != 0;
}

/// The cells that sixteen points lie in.
struct Cells {
  int node[kLanes];  ///< lowest corner, in floats
  float fraction[3][kLanes];
};

/// Trilinear values of four components each; turned so that every component has its lanes.
void interpolate(const std::vector<float>& grid, int n, const Cells& cells, Lanes out[4]) {
  Four value[kLanes];
#pragma GCC unroll 16
  for (int i = 0; i < kLanes; ++i) {
    const float* at = grid.data() + cells.node[i];
    const Eight a = load<Eight>(at), b = load<Eight>(at + 4 * n);
    const Eight c = load<Eight>(at + 4 * n * n), d = load<Eight>(at + 4 * (n * n + n));
    const Eight near = a + cells.fraction[2][i] * (c - a), far = b + cells.fraction[2][i] * (d - b);
    const Eight row = near + cells.fraction[1][i] * (far - near);
    const Four low = __builtin_shufflevector(row, row, 0, 1, 2, 3), high = __builtin_shufflevector(row, row, 4, 5, 6, 7);
    value[i] = low + cells.fraction[0][i] * (high - low);
  }
  const float* values = reinterpret_cast<const float*>(value);
  const Lanes p = load<Lanes>(values), q = load<Lanes>(values + 16), r = load<Lanes>(values + 32), s = load<Lanes>(values + 48);
#define TURBID_HALVES(x, y, k) __builtin_shufflevector(x, y, k, k + 4, k + 8, k + 12, k + 16, k + 20, k + 24, k + 28, \
                                                       k, k + 4, k + 8, k + 12, k + 16, k + 20, k + 24, k + 28)
#define TURBID_COMPONENT(k) __builtin_shufflevector(TURBID_HALVES(p, q, k), TURBID_HALVES(r, s, k), 0, 1, 2, 3, 4, 5, 6, 7, \
                                                    16, 17, 18, 19, 20, 21, 22, 23)
  out[0] = TURBID_COMPONENT(0);
  out[1] = TURBID_COMPONENT(1);
  out[2] = TURBID_COMPONENT(2);
  out[3] = TURBID_COMPONENT(3);
#undef TURBID_COMPONENT
#undef TURBID_HALVES
}

/// (1 - exp(-x)) / x, as kernels/lib/attenuation.h.
Lanes mean_transmittance(Lanes x) {
  Lanes mean = 1.0f / 720.0f - x * (1.0f / 5040.0f - x * (1.0f / 40320.0f));
  mean = 0.5f - x * (1.0f / 6.0f - x * (1.0f / 24.0f - x * (1.0f / 120.0f - x * mean)));
  mean = 1.0f - x * mean;
  if (any(x > 0.5f)) [[unlikely]] {
    for (int i = 0; i < kLanes; ++i) {
      if (x[i] > 0.5f) mean[i] = -std::expm1(-x[i]) / x[i];
    }
  }
  return mean;
}

/// Sixteen rays under way.
struct Packet {
  Lanes x[3], v[3], weight[3], gathered[3];
  Lanes32 alive;
};

/// One step of all rays; true in the lanes of rays that end with it. Gathering and marching differ in what a segment is good
/// for.
template <bool gathering>
Lanes32 advance(const RayMedium& m, Packet& p, float step, float min_weight) {
  const int n = m.n;
  const float dtau = step * m.tau_per_arc, size = static_cast<float>(n), last = static_cast<float>(n - 1);
  Lanes middle[3];
  Lanes32 cell[3];
  Cells cells;
  for (int a = 0; a < 3; ++a) {
    middle[a] = p.x[a] + 0.5f * dtau * p.v[a];
    const Lanes y = least(greatest(middle[a] - 0.5f, Lanes{}), Lanes{} + last);
    const Lanes32 i = __builtin_convertvector(y, Lanes32);
    cell[a] = i < n - 2 ? i : Lanes32{} + (n - 2);
    const Lanes f = y - __builtin_convertvector(cell[a], Lanes);
    std::memcpy(cells.fraction[a], &f, sizeof f);
  }
  const Lanes32 node = 4 * (cell[0] + n * (cell[1] + n * cell[2]));
  std::memcpy(cells.node, &node, sizeof node);
  Lanes u[4];
  interpolate(m.index, n, cells, u);
  Lanes eta_squared{}, to[3];
  Lanes32 outside{};
  for (int a = 0; a < 3; ++a) {
    const Lanes v = p.v[a] + dtau * u[a], mean = 0.5f * (p.v[a] + v);
    to[a] = middle[a] + 0.5f * dtau * v;
    eta_squared += mean * mean;
    p.v[a] = v;
    outside |= (to[a] < 0.0f) | (to[a] > size);
  }
  Lanes length = dtau * root(eta_squared);
  if (any(outside)) [[unlikely]] {
    Lanes part = Lanes{} + 1.0f;
    for (int a = 0; a < 3; ++a) {
      const Lanes d = to[a] - p.x[a];
      part = to[a] < 0.0f ? least(part, greatest(-p.x[a] / d, Lanes{})) : part;
      part = to[a] > size ? least(part, greatest((size - p.x[a]) / d, Lanes{})) : part;
    }
    length *= part;
  }
  Lanes source[4], heaviest{};
  if constexpr (gathering) interpolate(m.source, n, cells, source);
  for (int c = 0; c < 3; ++c) {
    const Lanes depth = (m.sigma_s[c] + m.sigma_a[c]) * length;
    const Lanes share = p.weight[c] * mean_transmittance(depth);
    if constexpr (gathering) p.gathered[c] += share * source[c] * (length * 0.0795774715f / eta_squared);
    p.weight[c] -= share * depth;
    heaviest = greatest(heaviest, p.weight[c]);
  }
  for (int a = 0; a < 3; ++a) p.x[a] = to[a];
  if constexpr (gathering) outside |= heaviest < min_weight;
  return outside & p.alive;
}

/// All rays on all threads; `end(thread, ray, packet, lane)` takes an ended ray's result.
template <bool gathering, class End>
std::int64_t follow(const RayMedium& m, const std::vector<RayStart>& rays, float step, float min_weight, int threads,
                    const End& end) {
  std::atomic<std::size_t> claims{0};
  std::vector<std::int64_t> steps(threads, 0);
  const auto work = [&](int thread) {
    Packet p{};
    std::size_t ray[kLanes], next = 0, last = 0;
    const auto begin = [&](int lane) {
      if (next == last) {
        next = std::min(claims.fetch_add(kClaim), rays.size());
        last = std::min(next + kClaim, rays.size());
      }
      const bool more = next < last;
      const RayStart nothing{{1, 1, 1}, {0, 0, 0}, {0, 0, 0, 0}};
      const RayStart& start = more ? rays[next] : nothing;
      for (int a = 0; a < 3; ++a) {
        p.x[a][lane] = start.position[a];
        p.v[a][lane] = start.velocity[a];
        p.weight[a][lane] = start.power[a];
        p.gathered[a][lane] = 0;
      }
      p.alive[lane] = more ? -1 : 0;
      ray[lane] = next;
      if (more) ++next;
      return more;
    };
    int alive = 0;
    for (int lane = 0; lane < kLanes; ++lane) alive += begin(lane);
    std::int64_t done = 0;
    while (alive > 0) {
      done += alive;
      const Lanes32 ended = advance<gathering>(m, p, step, min_weight);
      if (!any(ended)) continue;
      for (int lane = 0; lane < kLanes; ++lane) {
        if (!ended[lane]) continue;
        end(thread, ray[lane], p, lane);
        if (!begin(lane)) --alive;
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
  struct alignas(64) Part : MarchSums {};  // a cache line for each thread
  std::vector<Part> parts(threads);
  MarchSums sums;
  sums.steps = follow<false>(medium, rays, step, 0.0f, threads, [&](int thread, std::size_t ray, const Packet& p, int lane) {
    for (int c = 0; c < 3; ++c) {
      parts[thread].escaped[c] += p.weight[c][lane];
      parts[thread].absorbed[c] += static_cast<double>(rays[ray].power[c]) - p.weight[c][lane];
    }
  });
  for (const Part& part : parts) {
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
  return follow<true>(medium, rays, step, min_weight, threads, [&](int, std::size_t ray, const Packet& p, int lane) {
    for (int c = 0; c < 3; ++c) (*radiance)[4 * ray + c] = p.gathered[c][lane];
  });
}

}  // namespace turbid::reference
