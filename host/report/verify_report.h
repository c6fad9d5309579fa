// SPDX-License-Identifier: Apache-2.0
// What `turbid verify` found, for people and as JSON.
#pragma once
#include <string>
#include <vector>

#include "host/report/document.h"
#include "host/study/case.h"

namespace turbid {

/// A case with what it came to.
struct VerifiedCase {
  const Case* of = nullptr;
  CaseResult result;
};

struct VerifyReport {
  std::string command_line, device;
  bool quick = false;
  std::vector<VerifiedCase> cases;

  int failed() const;
  /// One sentence: how many passed, or the names of those that failed.
  std::string verdict() const;
};

/// One case: its head, one line per check and per observed order.
std::string verified_case_text(const VerifiedCase&);
/// "number name title" of every case, one line each.
std::string case_list_text(const std::vector<Case>&);
std::string case_list_json(const std::vector<Case>&);
std::string verify_json(const VerifyReport&);
/// The same as a page: an overview, then a table and a plot per case.
Document verify_document(const VerifyReport&, const cl::DeviceInfo&);

}  // namespace turbid
