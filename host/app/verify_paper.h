// SPDX-License-Identifier: Apache-2.0
// turbid verify --paper: the study of the paper's own scheme.
#pragma once
#include <string>

#include "host/app/options.h"

namespace turbid::app {

struct PaperOptions {
  TalkOptions talk;
  std::string device;
  std::string prefix;  ///< of the files written
  bool quick = false;
};
/// Writes PREFIX.html, PREFIX.json and a CSV per table, prints the tables.
void verify_paper(const PaperOptions&);

}  // namespace turbid::app
