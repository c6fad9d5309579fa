// SPDX-License-Identifier: Apache-2.0
// See file_report.h.
#include "host/report/file_report.h"

#include <sstream>

#include "host/report/json_parts.h"

namespace turbid {

std::string file_json(const std::string& file, const std::string& kind, const std::string& text) {
  Json lines = Json::array();
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return document({{"format", "turbid file 1"}, {"file", file}, {"kind", kind}, {"description", lines}});
}

}  // namespace turbid
