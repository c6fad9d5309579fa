// SPDX-License-Identifier: Apache-2.0
// Where labels can go in a figure. Private to host/report.
#pragma once
#include <vector>

#include "host/report/svg.h"

namespace turbid {

/// Where labels can go without covering data or each other.
class LabelRoom {
 public:
  explicit LabelRoom(const Box& frame) : frame_(frame) {}
  void take(const Box&);
  void take_line(Point a, Point b);
  /// The first candidate that is free and inside the frame is taken; else, if it `must` be placed, the least covered
  /// one. Returns its index, or -1.
  int place(const std::vector<Box>& candidates, bool must);

 private:
  double cover(const Box&) const;
  Box frame_;
  std::vector<Box> taken_;
  std::vector<Point> dots_;
};

}  // namespace turbid
