// SPDX-License-Identifier: Apache-2.0
// printf into a string, for the lines that reports are made of.
#pragma once
#include <cstdio>
#include <string>

namespace turbid {

inline std::string line(const char* format, auto... values) {
  char text[1024];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

}  // namespace turbid
