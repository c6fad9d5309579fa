// SPDX-License-Identifier: Apache-2.0
// See document.h: verdict, ids.
#include "host/report/document.h"

#include <cctype>

#include "host/report/text_line.h"

namespace turbid {

Verdict verdict(const Document& document) {
  Verdict result;
  for (const Section& section : document.sections)
    for (const Part& part : section.parts)
      if (const auto* table = std::get_if<Table>(&part))
        for (const Row& row : table->rows) {
          result.passed += row.state == RowState::pass;
          result.failed += row.state == RowState::fail;
        }
  return result;
}

std::string verdict_text(const Document& document) {
  const Verdict v = verdict(document);
  const std::size_t all = v.passed + v.failed;
  if (all == 0) return {};
  if (v.failed > 0) return line("%zu of %zu checks failed", v.failed, all);
  return all == 1 ? "the one check passed" : line("all %zu checks passed", all);
}

std::string identifier(const std::string& text) {
  std::string id;
  for (const char c : text) id += c == '-' || (std::isalnum(static_cast<unsigned char>(c)) && !(c & 0x80)) ? c : '_';
  return id.empty() ? "_" : id;
}

}  // namespace turbid
