// SPDX-License-Identifier: Apache-2.0
// A Table as comma-separated values, RFC 4180: lines end with CR LF, and a field that holds a comma, a quotation mark
// or a line end stands in quotation marks.
#include <charconv>
#include <cmath>

#include "host/report/document.h"

namespace turbid {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// The shortest decimal that reads back as the same number.
std::string full_precision(double value) {
  if (!std::isfinite(value)) return number_text(value, 0);
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

struct CellField {
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(const std::string& text) const { return field(text); }
  std::string operator()(double value) const { return full_precision(value); }
  std::string operator()(std::int64_t count) const { return std::to_string(count); }
  std::string operator()(bool yes) const { return yes ? "true" : "false"; }
};

std::string record(const std::vector<std::string>& fields) {
  std::string text;
  for (const std::string& one : fields) text += (&one == fields.data() ? "" : ",") + one;
  return text + "\r\n";
}

}  // namespace

std::string table_csv(const Table& table) {
  const bool states = table.has_states();
  std::vector<std::string> fields;
  for (const Column& column : table.columns) fields.push_back(field(column_title(column)));
  if (states) fields.push_back("state");
  std::string text = record(fields);
  for (const Row& row : table.rows) {
    fields.clear();
    for (const Cell& cell : row.cells) fields.push_back(std::visit(CellField{}, cell));
    if (states) fields.push_back(state_word(row.state));
    text += record(fields);
  }
  return text;
}

}  // namespace turbid
