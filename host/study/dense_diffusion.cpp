// SPDX-License-Identifier: Apache-2.0
// Neighbours are found by voxel coordinates and the collision follows numerics section 1 line by line, so that nothing
// is shared with the device's solvers but the lists of boundary and jump faces.
#include "host/study/dense_diffusion.h"

#include <cmath>

namespace turbid::study {

DenseDiffusion::DenseDiffusion(const DiffusionMedium& medium, int channel) : size_(medium.stride()) {
  const glm::ivec3 n = medium.frame.voxels;
  const auto index_of = [&](glm::ivec3 v) -> std::ptrdiff_t {
    const int block = medium.blocks.find(v / 8);
    if (block < 0) return -1;
    const glm::ivec3 l = v % 8;
    const std::ptrdiff_t i = block * std::ptrdiff_t{512} + l.x + 8 * (l.y + 8 * l.z);
    return medium.region[i] >= 0 ? i : -1;
  };
  active_.resize(size_);
  faces_.resize(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    active_[i] = medium.region[i] >= 0;
    s_.push_back(medium.s[channel * size_ + i]);
    s_a_.push_back(medium.s_a[channel * size_ + i]);
    eta_squared_.push_back(medium.eta_squared[i]);
  }
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        const std::ptrdiff_t here = index_of({x, y, z});
        if (here < 0) continue;
        for (int face = 0; face < 6; ++face) {
          glm::ivec3 v(x, y, z);
          const int axis = face / 2;
          v[axis] += face % 2 ? 1 : -1;
          if (v[axis] < 0 || v[axis] >= n[axis]) {
            if (!medium.blocks.periodic()[axis]) continue;
            v[axis] = (v[axis] + n[axis]) % n[axis];
          }
          const std::ptrdiff_t there = index_of(v);
          if (there >= 0) faces_[here][face] = {Kind::inner, static_cast<std::size_t>(there), 0, 0};
        }
      }
    }
  }
  for (const BoundaryFace& f : medium.boundary)
    faces_[f.block * std::size_t{512} + f.voxel][f.face] = {Kind::boundary, 0, f.c[channel], 0};
  for (const JumpFace& j : medium.jumps) {
    Face& lower = faces_[j.block * std::size_t{512} + j.voxel][2 * j.axis + 1];
    lower.resistance = j.resistance;
    faces_[lower.other][2 * j.axis].resistance = j.resistance;
  }
}

std::vector<double> DenseDiffusion::apply(const std::vector<double>& u) const {
  std::vector<double> result(size_, 0.0);
  for (std::size_t i = 0; i < size_; ++i) {
    if (!active_[i]) continue;
    double loss = s_a_[i];
    for (const Face& f : faces_[i]) {
      if (f.kind == Kind::boundary) loss += 1 / (3 * (0.5 * s_[i] + f.c));
      if (f.kind != Kind::inner) continue;
      const double t = 1 / (1.5 * (s_[i] / eta_squared_[i] + s_[f.other] / eta_squared_[f.other]) + f.resistance);
      result[i] += t * (u[i] - u[f.other]);
    }
    result[i] += loss * eta_squared_[i] * u[i];
  }
  return result;
}

DenseDiffusion::StepResult DenseDiffusion::step(Populations& f, CollisionVariant variant,
                                                const std::vector<double>& q) const {
  StepResult result;
  result.fluence.assign(size_, 0.0);
  Populations in(size_, {0, 0, 0, 0, 0, 0});
  for (std::size_t i = 0; i < size_; ++i) {
    if (!active_[i]) continue;
    for (int face = 0; face < 6; ++face) {
      const Face& link = faces_[i][face];
      // Population `face` travels away from the face of that number and arrives over it; its mirror image is face ^ 1.
      const double left = f[i][face ^ 1];
      if (link.kind == Kind::boundary) {
        const double r = (link.c - 1) / (link.c + 1);
        in[i][face] = r * left;
        result.escaped += (1 - r) * left;
      } else if (link.kind == Kind::mirror) {
        in[i][face] = left;
      } else {
        // Net flux 2 (f_here / eta_here^2 - f_there / eta_there^2) / (1/eta_here^2 + 1/eta_there^2 + r/3).
        const double a = 1 / eta_squared_[i], b = 1 / eta_squared_[link.other];
        const double net = 2 * (left * a - f[link.other][face] * b) / (a + b + link.resistance / 3);
        in[i][face] = left - net;
      }
    }
  }
  for (std::size_t i = 0; i < size_; ++i) {
    if (!active_[i]) continue;
    const double s = s_[i], s_a = s_a_[i];
    double p0 = 0, p1 = 0, p2 = 0, q0 = q[i], star = 0, q_star = q[i];
    if (variant == CollisionVariant::paper) {
      p0 = s_a, p1 = p2 = s;
    } else if (variant == CollisionVariant::exponential) {
      p1 = p2 = 1 - std::exp(-s);
      p0 = p1 * s_a / s;
    } else if (variant == CollisionVariant::trapezoid) {
      p1 = p2 = s / (1 + s / 2);
      p0 = s_a / (1 + s_a / 2);
      q0 = q[i] / (1 + s_a / 2);
    } else {
      p1 = s / (1 + s / 2);
      const double s2 = 4 / s;
      p2 = s2 / (1 + s2 / 2);
      star = s_a / (1 + s_a * s / 4);
      p0 = star / (1 + star / 2);
      q_star = q[i] / (1 + s_a * s / 4);
      q0 = q_star / (1 + star / 2);
    }
    double before = 0;
    for (double population : in[i]) before += population;
    const double after = (1 - p0) * before + q0;
    for (int k = 0; k < 3; ++k) {
      const double even = after / 3 + (1 - p2) * (in[i][2 * k] + in[i][2 * k + 1] - before / 3);
      const double odd = (1 - p1) * (in[i][2 * k] - in[i][2 * k + 1]);
      f[i][2 * k] = 0.5 * (even + odd);
      f[i][2 * k + 1] = 0.5 * (even - odd);
    }
    result.absorbed += before - after + q[i];
    const double mean = 0.5 * (before + after);
    result.fluence[i] = variant == CollisionVariant::paper         ? before
                        : variant == CollisionVariant::exponential ? before * p1 / s
                        : variant == CollisionVariant::trapezoid   ? mean
                                                                   : mean - (star * mean - q_star) * s / 4;
  }
  return result;
}

}  // namespace turbid::study
