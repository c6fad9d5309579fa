// SPDX-License-Identifier: Apache-2.0
// See label_room.h.
#include "host/report/label_room.h"

#include <algorithm>
#include <cmath>

namespace turbid {

void LabelRoom::take(const Box& box) {
  taken_.push_back(box);
}

void LabelRoom::take_line(Point a, Point b) {
  const int steps = std::clamp(static_cast<int>(std::hypot(b.x - a.x, b.y - a.y) / 3), 1, 1000);
  for (int i = 0; i <= steps; ++i) dots_.push_back({a.x + (b.x - a.x) * i / steps, a.y + (b.y - a.y) * i / steps});
}

double LabelRoom::cover(const Box& box) const {
  const auto overlap = [](double a, double a_size, double b, double b_size) {
    return std::max(0.0, std::min(a + a_size, b + b_size) - std::max(a, b));
  };
  const double inside =
      overlap(box.x, box.width, frame_.x, frame_.width) * overlap(box.y, box.height, frame_.y, frame_.height);
  double covered = 10 * std::max(0.0, box.width * box.height - inside - 1);
  for (const Box& other : taken_)
    covered += overlap(box.x, box.width, other.x, other.width) * overlap(box.y, box.height, other.y, other.height);
  for (const Point& dot : dots_)
    if (dot.x >= box.x && dot.x <= box.x + box.width && dot.y >= box.y && dot.y <= box.y + box.height) covered += 5;
  return covered;
}

int LabelRoom::place(const std::vector<Box>& candidates, bool must) {
  int best = -1;
  double least = 0;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double covered = cover(candidates[i]);
    if (best < 0 || covered < least) {
      best = static_cast<int>(i);
      least = covered;
    }
    if (covered == 0) break;
  }
  if (best < 0 || (least > 0 && !must)) return -1;
  take(candidates[static_cast<std::size_t>(best)]);
  return best;
}

}  // namespace turbid
