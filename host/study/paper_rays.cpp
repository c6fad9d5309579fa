// SPDX-License-Identifier: Apache-2.0
// Rays and deposits as Bernabei et al. print them, in double precision, against what the engine does.
#include <cmath>
#include <functional>
#include <numbers>

#include "host/study/paper_scheme.h"

namespace turbid::study {
namespace {

struct Vec {
  double x, y;
};
Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y};
}
Vec operator*(double k, Vec a) {
  return {k * a.x, k * a.y};
}

struct Index {
  std::function<double(Vec)> eta;
  std::function<Vec(Vec)> gradient;
};

struct Ray {
  Vec x, v;
};

Ray step(const Index& index, Ray ray, double delta, int tracer) {
  const double eta = index.eta(ray.x);
  const Vec gradient = index.gradient(ray.x);
  if (tracer == 0)  // x += delta v / n, v += delta grad n
    return {ray.x + (delta / eta) * ray.v, ray.v + delta * gradient};
  if (tracer == 1)  // x = x + v / n * delta; v = v + delta * grad_n / n
    return {ray.x + (delta / eta) * ray.v, ray.v + (delta / eta) * gradient};
  const Vec half = ray.v + (0.5 * delta * eta) * gradient, x = ray.x + delta * half;  // in tau, dtau = ds / n
  return {x, half + (0.5 * delta * index.eta(x)) * index.gradient(x)};
}

/// Rays parallel to x into a lens of radius 1 meet at (1, 0).
double focus_error(double delta, int tracer) {
  const Index lens{[](Vec p) { return std::sqrt(std::max(2 - p.x * p.x - p.y * p.y, 0.25)); },
                   [](Vec p) {
                     const double eta = std::sqrt(std::max(2 - p.x * p.x - p.y * p.y, 0.25));
                     return Vec{-p.x / eta, -p.y / eta};
                   }};
  double squares = 0;
  constexpr int kRays = 9;
  for (int i = 1; i <= kRays; ++i) {
    const double impact = 0.1 * i;
    Ray ray{{-std::sqrt(1 - impact * impact), impact}, {1, 0}}, last = ray;
    const auto outside = [](Vec p) { return p.x * p.x + p.y * p.y - 1; };
    do {
      last = ray;
      ray = step(lens, ray, delta, tracer);
    } while (outside(ray.x) < 0 || ray.x.x < -0.5);
    // The last step is shortened so that it ends on the lens.
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double t = 0.5 * (low + high);
      (outside(step(lens, last, t * delta, tracer).x) < 0 ? low : high) = t;
    }
    const Vec end = step(lens, last, low * delta, tracer).x;
    squares += (end.x - 1) * (end.x - 1) + end.y * end.y;
  }
  return std::sqrt(squares / kRays);
}

}  // namespace

std::vector<FocusError> luneburg_focus() {
  std::vector<FocusError> levels;
  for (const double delta : {0.1, 0.05, 0.025, 0.0125, 0.00625}) {
    FocusError level{delta, {}};
    for (int tracer = 0; tracer < 3; ++tracer) level.rms[static_cast<std::size_t>(tracer)] = focus_error(delta, tracer);
    levels.push_back(level);
  }
  return levels;
}

std::array<double, 3> refraction_at_30() {
  // A rise as a tanh over one length unit, crossed in steps a thousand times finer: only the equations differ.
  const Index rise{[](Vec p) { return 1.25 + 0.25 * std::tanh(p.x); },
                   [](Vec p) {
                     return Vec{0.25 / std::pow(std::cosh(p.x), 2), 0};
                   }};
  std::array<double, 3> degrees{};
  for (int tracer = 0; tracer < 3; ++tracer) {
    Ray ray{{-10, 0}, {std::cos(std::numbers::pi / 6), std::sin(std::numbers::pi / 6)}};
    while (ray.x.x < 10) ray = step(rise, ray, 1e-3, tracer);
    degrees[static_cast<std::size_t>(tracer)] = std::atan2(ray.v.y, ray.v.x) * 180 / std::numbers::pi;
  }
  return degrees;
}

std::vector<Attenuation> attenuation() {
  std::vector<Attenuation> all;
  for (const double step : {1.0, 0.5, 0.25, 0.125}) {
    Attenuation a{step, {}, {}, 0, 0};
    double od = 0, power = 1;
    const int steps = static_cast<int>(std::lround(4 / step));
    for (int i = 1; i <= steps; ++i) {
      od += std::exp(-step);
      a.depth.push_back(i * step);
      a.printed.push_back(od);
    }
    for (int i = 0; i < static_cast<int>(40 / step); ++i) {
      const double next = power * std::exp(-step);
      a.deposited_printed += next;
      a.deposited += power - next;
      power = next;
    }
    all.push_back(a);
  }
  return all;
}

}  // namespace turbid::study
