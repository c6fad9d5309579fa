// SPDX-License-Identifier: Apache-2.0
// GCC's vectors of sixteen, two rows along x: AVX-512 where the machine has it. Inside a block populations stream in
// place: a step that crosses to the neighbours' slots and one that stays in the voxel's own alternate
// (kernels/lattice.cl explains the slots).
#include "host/bench/reference_lattice.h"

#include <algorithm>
#include <barrier>
#include <cmath>
#include <cstring>
#include <thread>

namespace turbid::reference {
namespace {

constexpr int kVoxels = 512, kRows = 64, kVectors = 32;

typedef float V __attribute__((vector_size(64)));
typedef int VI __attribute__((vector_size(64)));
typedef float H __attribute__((vector_size(32)));  // one row

template <class T>
T load(const float* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}
template <class T>
void store(float* to, T value) {
  std::memcpy(to, &value, sizeof value);
}
H low(V v) {
  return __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
}
H high(V v) {
  return __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
}
V join(H a, H b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
/// Both rows moved one voxel along x; what enters comes from lanes 0 and 8, or 7 and 15, of `ends`.
V shift_up(V v, V ends) {
  return __builtin_shufflevector(v, ends, 16, 0, 1, 2, 3, 4, 5, 6, 24, 8, 9, 10, 11, 12, 13, 14);
}
V shift_down(V v, V ends) {
  return __builtin_shufflevector(v, ends, 1, 2, 3, 4, 5, 6, 7, 23, 9, 10, 11, 12, 13, 14, 15, 31);
}

/// What comes in over the faces of a block, what has gone out, and whether a face reflects (then nothing comes in).
struct Faces {
  V x[2][kVectors];
  H y[2][8];
  V z[2][4];
};
struct Gone {
  H x[2][8];  // lanes are rows y
  H y[2][8];
  V z[2][4];
};

struct Coefficients {
  const float *p0, *p1, *q0;
};

template <bool crossing, bool walled, bool last>
void step(float* f, const Coefficients& k, const Faces& in, const float* wall, Gone& gone, float* fluence) {
  float *down_x = f, *up_x = f + kVoxels, *down_y = f + 2 * kVoxels, *up_y = f + 3 * kVoxels, *down_z = f + 4 * kVoxels,
        *up_z = f + 5 * kVoxels;
  for (int z = 0; z < 8; ++z) {
    V x_minus[4], x_plus[4];
#pragma GCC unroll 4
    for (int j = 0; j < 4; ++j) {
      const int v = 4 * z + j, at = 16 * v;
      V xp, xm, yp, ym, zp, zm;
      if constexpr (crossing) {
        const V below = load<V>(up_x + at), above = load<V>(down_x + at);
        V low_end = in.x[0][v], high_end = in.x[1][v];
        if constexpr (walled) {
          low_end += wall[0] * above;
          high_end += wall[1] * below;
        }
        xp = shift_up(below, low_end);
        xm = shift_down(above, high_end);
        if (j == 0) {
          H side = in.y[0][z];
          if constexpr (walled) side += wall[2] * load<H>(down_y + at);
          yp = join(side, load<H>(up_y + at));
        } else {
          yp = load<V>(up_y + at - 8);
        }
        if (j == 3) {
          H side = in.y[1][z];
          if constexpr (walled) side += wall[3] * load<H>(up_y + at + 8);
          ym = join(load<H>(down_y + at + 8), side);
        } else {
          ym = load<V>(down_y + at + 8);
        }
        if (z > 0) {
          zp = load<V>(up_z + at - 64);
        } else {
          zp = in.z[0][j];
          if constexpr (walled) zp += wall[4] * load<V>(down_z + at);
        }
        if (z < 7) {
          zm = load<V>(down_z + at + 64);
        } else {
          zm = in.z[1][j];
          if constexpr (walled) zm += wall[5] * load<V>(up_z + at);
        }
      } else {
        xp = load<V>(down_x + at), xm = load<V>(up_x + at), yp = load<V>(down_y + at);
        ym = load<V>(up_y + at), zp = load<V>(down_z + at), zm = load<V>(up_z + at);
      }
      const V p0 = load<V>(k.p0 + at), p1 = load<V>(k.p1 + at), q0 = load<V>(k.q0 + at);
      const V before = ((xp + xm) + (yp + ym)) + (zp + zm), after = (before - p0 * before) + q0;
      const V odd = 0.5f - 0.5f * p1;  // the even moments are kept by -odd
      const V base = after * (1.0f / 6.0f) + odd * (before * (1.0f / 3.0f));
      const V ex = base - odd * (xp + xm), ey = base - odd * (yp + ym), ez = base - odd * (zp + zm);
      const V ox = xp - xm, oy = yp - ym, oz = zp - zm;
      xp = ex + odd * ox, xm = ex - odd * ox;
      yp = ey + odd * oy, ym = ey - odd * oy;
      zp = ez + odd * oz, zm = ez - odd * oz;
      if constexpr (last) {
        const V s = p1 / (1.0f - 0.5f * p1), absorbed = p0 / (1.0f - 0.5f * p0);
        const V mean = 0.5f * (before + after), q_star = q0 * (1.0f + 0.5f * absorbed);
        store(fluence + at, mean - 0.25f * s * (absorbed * mean - q_star));
      }
      x_plus[j] = xp;
      x_minus[j] = xm;
      if (j == 0) gone.y[0][z] += low(ym);
      if (j == 3) gone.y[1][z] += high(yp);
      if (z == 0) gone.z[0][j] += zm;
      if (z == 7) gone.z[1][j] += zp;
      if constexpr (crossing) {
        V low_end = in.x[0][v], high_end = in.x[1][v];
        if constexpr (walled) {
          low_end += wall[0] * xm;
          high_end += wall[1] * xp;
        }
        store(down_x + at, shift_up(xp, low_end));
        store(up_x + at, shift_down(xm, high_end));
        if (j == 0) {
          H side = in.y[0][z];
          if constexpr (walled) side += wall[2] * low(ym);
          store(down_y + at, side);
          store(up_y + at, high(ym));
        } else {
          store(up_y + at - 8, ym);
        }
        if (j == 3) {
          H side = in.y[1][z];
          if constexpr (walled) side += wall[3] * high(yp);
          store(up_y + at + 8, side);
          store(down_y + at + 8, low(yp));
        } else {
          store(down_y + at + 8, yp);
        }
        if (z > 0) {
          store(up_z + at - 64, zm);
        } else {
          V side = in.z[0][j];
          if constexpr (walled) side += wall[4] * zm;
          store(down_z + at, side);
        }
        if (z < 7) {
          store(down_z + at + 64, zp);
        } else {
          V side = in.z[1][j];
          if constexpr (walled) side += wall[5] * zp;
          store(up_z + at, side);
        }
      } else {
        store(down_x + at, xm), store(up_x + at, xp), store(down_y + at, ym);
        store(up_y + at, yp), store(down_z + at, zm), store(up_z + at, zp);
      }
    }
    const V low_pair =
        __builtin_shufflevector(x_minus[0], x_minus[1], 0, 8, 16, 24, 0, 8, 16, 24, 0, 8, 16, 24, 0, 8, 16, 24);
    const V low_rest =
        __builtin_shufflevector(x_minus[2], x_minus[3], 0, 8, 16, 24, 0, 8, 16, 24, 0, 8, 16, 24, 0, 8, 16, 24);
    gone.x[0][z] += __builtin_shufflevector(low_pair, low_rest, 0, 1, 2, 3, 16, 17, 18, 19);
    const V high_pair =
        __builtin_shufflevector(x_plus[0], x_plus[1], 7, 15, 23, 31, 7, 15, 23, 31, 7, 15, 23, 31, 7, 15, 23, 31);
    const V high_rest =
        __builtin_shufflevector(x_plus[2], x_plus[3], 7, 15, 23, 31, 7, 15, 23, 31, 7, 15, 23, 31, 7, 15, 23, 31);
    gone.x[1][z] += __builtin_shufflevector(high_pair, high_rest, 0, 1, 2, 3, 16, 17, 18, 19);
  }
}

template <bool walled>
void steps(float* f, const Coefficients& k, const Faces& in, const float* wall, Gone& gone, float* fluence, int inner,
           bool last) {
  for (int i = 0; i < inner; i += 2) {
    step<true, walled, false>(f, k, in, wall, gone, fluence);
    if (last && i + 2 >= inner)
      step<false, walled, true>(f, k, in, wall, gone, fluence);
    else
      step<false, walled, false>(f, k, in, wall, gone, fluence);
  }
}

}  // namespace

BlockLattice::BlockLattice(const LatticeCube& cube, int threads)
    : cube_(cube), threads_(threads), side_(cube.n / 8), blocks_(side_ * side_ * side_) {
  populations_.assign(static_cast<std::size_t>(6) * kVoxels * blocks_ * cube.channels, 0.0f);
  fluence_.assign(static_cast<std::size_t>(kVoxels) * blocks_ * cube.channels, 0.0f);
  for (auto& values : interfaces_)
    values.assign(static_cast<std::size_t>(6) * kRows * (blocks_ + 1) * cube.channels, 0.0f);
}

void BlockLattice::block_steps(int channel, int block, int inner, bool last) {
  const int position[3] = {block % side_, block / side_ % side_, block / (side_ * side_)};
  const int stride[3] = {1, side_, side_ * side_};
  const std::size_t index = static_cast<std::size_t>(channel) * blocks_ + block;
  const float* sent = interfaces_[current_].data() + static_cast<std::size_t>(channel) * (blocks_ + 1) * 6 * kRows;
  Faces in;
  Gone gone{};
  float wall[6];
  bool walled = false;
  const float* from[6];
  for (int i = 0; i < 6; ++i) {
    const bool outer = i % 2 ? position[i / 2] == side_ - 1 : position[i / 2] == 0;
    wall[i] = outer ? cube_.reflection : 0.0f;
    walled |= outer;
    from[i] =
        sent + (static_cast<std::size_t>(outer ? blocks_ : block + (i % 2 ? 1 : -1) * stride[i / 2]) * 6 + i) * kRows;
  }
  for (int side = 0; side < 2; ++side) {
    for (int v = 0; v < kVectors; ++v) {
      in.x[side][v] = V{};
      in.x[side][v][7 * side] = from[side][2 * v];
      in.x[side][v][7 * side + 8] = from[side][2 * v + 1];
    }
    std::memcpy(in.y[side], from[2 + side], sizeof in.y[side]);
    std::memcpy(in.z[side], from[4 + side], sizeof in.z[side]);
  }
  const std::size_t at = index * kVoxels;
  const Coefficients k{cube_.p0.data() + at, cube_.p1.data() + at, cube_.q0.data() + at};
  float* f = populations_.data() + 6 * at;
  float* psi = fluence_.data() + at;
  if (walled)
    steps<true>(f, k, in, wall, gone, psi, inner, last);
  else
    steps<false>(f, k, in, wall, gone, psi, inner, last);
  float* out =
      interfaces_[1 - current_].data() + (static_cast<std::size_t>(channel) * (blocks_ + 1) + block) * 6 * kRows;
  const float mean = 1.0f / static_cast<float>(inner);
  for (int side = 0; side < 2; ++side) {
    for (int z = 0; z < 8; ++z) {
      store(out + (1 - side) * kRows + 8 * z, mean * gone.x[side][z]);
      store(out + (3 - side) * kRows + 8 * z, mean * gone.y[side][z]);
    }
    for (int j = 0; j < 4; ++j) store(out + (5 - side) * kRows + 16 * j, mean * gone.z[side][j]);
  }
}

void BlockLattice::sweep(int count, int inner) {
  std::barrier meet(threads_, [&]() noexcept { current_ = 1 - current_; });
  const auto work = [&](int thread) {
    const std::ptrdiff_t all = static_cast<std::ptrdiff_t>(blocks_) * cube_.channels;
    for (int i = 0; i < count; ++i) {
      for (std::ptrdiff_t b = all * thread / threads_; b < all * (thread + 1) / threads_; ++b) {
        block_steps(static_cast<int>(b / blocks_), static_cast<int>(b % blocks_), inner, i == count - 1);
      }
      meet.arrive_and_wait();
    }
  };
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads_; ++thread) others.emplace_back(work, thread);
  work(0);
  for (std::thread& thread : others) thread.join();
}

}  // namespace turbid::reference
