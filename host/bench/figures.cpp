// SPDX-License-Identifier: Apache-2.0
#include "host/bench/figures.h"

#include <cstdarg>
#include <cstdio>

namespace turbid {

std::string figures(const char* format, ...) {
  char buffer[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

}  // namespace turbid
