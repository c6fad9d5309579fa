// SPDX-License-Identifier: Apache-2.0
// turbid verify --paper: the study of the paper's own scheme.
#pragma once
#include <string>

#include "host/app/options.h"

namespace turbid::app {

struct PaperOptions {
  TalkOptions talk;
  std::string device;
  std::string output;  ///< folder; empty: out/paper
  bool quick = false;
};
/// Writes paper.html, paper.json and a CSV per table into the folder, prints the tables.
void verify_paper(const PaperOptions&);

}  // namespace turbid::app
