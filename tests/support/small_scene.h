// SPDX-License-Identifier: Apache-2.0
// A scene that renders in a second: a milky ball on a ground plane, one spot light.
#pragma once
#include <stdexcept>
#include <string>

namespace turbid::test {

inline const std::string kMilkyBall = R"(unit = "mm"
[domain]
resolution = 24
[material.milk]
eta = 1.3
sigma_s = [1.0, 1.2, 1.5]
sigma_a = [0.02, 0.01, 0.005]
[[object]]
shape = "sphere"
radius = 10
material = "milk"
[[light]]
type = "spot"
position = [60, 40, 30]
target = [0, 0, 0]
angle = 30
power = [1, 1, 1]
[camera]
position = [0, 10, 60]
width = 48
height = 32
samples = 1
[ground]
height = -10
)";

/// The scene with one piece of its text replaced.
inline std::string milky_ball_with(const std::string& piece, const std::string& replacement) {
  std::string text = kMilkyBall;
  const std::size_t at = text.find(piece);
  if (at == std::string::npos) throw std::logic_error("not in the scene: " + piece);
  return text.replace(at, piece.size(), replacement);
}

}  // namespace turbid::test
