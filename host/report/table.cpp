// SPDX-License-Identifier: Apache-2.0
// See table.h.
#include "host/report/table.h"

#include <algorithm>
#include <cmath>

#include "host/report/text_line.h"

namespace turbid {
namespace {

constexpr double kSmallestPlain = 1e-4, kLargestPlain = 1e6;  // outside: a power of ten

std::string significant_text(double value, int digits) {
  const double magnitude = std::abs(value);
  if (magnitude == 0) return "0";
  // Rounding may carry into one more digit: 9.996 to three digits is 10.0, and its exponent that of 10.
  const double rounded = std::stod(line("%.*e", std::max(digits - 1, 0), magnitude));
  if (rounded < kSmallestPlain || rounded >= kLargestPlain) return line("%.*e", std::max(digits - 1, 0), value);
  const int exponent = static_cast<int>(std::floor(std::log10(rounded) + 1e-12));
  return line("%.*f", std::max(digits - 1 - exponent, 0), value);
}

struct CellText {
  const Column& column;
  std::string operator()(std::monostate) const { return {}; }
  std::string operator()(const std::string& text) const { return text; }
  std::string operator()(double value) const { return number_text(value, column.digits, column.style); }
  std::string operator()(std::int64_t count) const { return std::to_string(count); }
  std::string operator()(bool yes) const { return yes ? "yes" : "no"; }
};

}  // namespace

bool Table::has_states() const {
  return std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.state != RowState::plain; });
}

std::string number_text(double value, int digits, NumberStyle style) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  switch (style) {
    case NumberStyle::significant:
      return significant_text(value, digits);
    case NumberStyle::fixed:
      return line("%.*f", digits, value);
    case NumberStyle::scientific:
      return line("%.*e", std::max(digits - 1, 0), value);
  }
  return {};
}

std::string column_title(const Column& column) {
  return column.unit.empty() ? column.name : column.name + " [" + column.unit + "]";
}

bool right_aligned(const Table& table, std::size_t i) {
  if (table.columns[i].align != Align::automatic) return table.columns[i].align == Align::right;
  for (const Row& row : table.rows) {
    if (std::holds_alternative<std::monostate>(row.cells[i])) continue;
    return std::holds_alternative<double>(row.cells[i]) || std::holds_alternative<std::int64_t>(row.cells[i]);
  }
  return false;
}

std::string state_word(RowState state) {
  return state == RowState::pass ? "pass" : state == RowState::fail ? "fail" : "";
}

std::string cell_text(const Cell& cell, const Column& column) {
  return std::visit(CellText{column}, cell);
}

}  // namespace turbid
