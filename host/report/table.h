// SPDX-License-Identifier: Apache-2.0
// A table of a report: typed cells under columns with units. JSON and CSV get the cells in full precision, HTML and
// text as the columns say.
#pragma once
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace turbid {

enum class NumberStyle {
  significant,  ///< `digits` significant digits; below 1e-4 and from 1e6 on with a power of ten
  fixed,        ///< `digits` decimals
  scientific,   ///< `digits` significant digits and a power of ten
};

enum class Align { automatic, left, right };  ///< automatic: numbers right, texts left

struct Column {
  std::string name;
  std::string unit = {};  ///< empty: a text, a count or a number without one
  int digits = 3;         ///< of floating-point cells, see NumberStyle; in [0, 17]
  NumberStyle style = NumberStyle::significant;
  Align align = Align::automatic;
};

/// Nothing, a text, a number, a count, yes or no.
using Cell = std::variant<std::monostate, std::string, double, std::int64_t, bool>;

enum class RowState { plain, pass, fail };

struct Row {
  std::vector<Cell> cells;           ///< one per column
  RowState state = RowState::plain;  ///< shown by a colour and a word; counted in the document's verdict
};

struct Table {
  std::string id;  ///< letters, digits, '_' and '-'; unique in the document; part of the CSV file's name
  std::string title = {};
  std::string caption = {};
  std::vector<Column> columns = {};
  std::vector<Row> rows = {};

  bool has_states() const;
};

/// A number as a column shows it: "0.0123", "1.20e-05", "nan", "inf".
std::string number_text(double, int digits, NumberStyle = NumberStyle::significant);
/// "voxel size [mm]"
std::string column_title(const Column&);
/// Whether column `i` stands at the right edge: as it asks, else because its first cell is a number.
bool right_aligned(const Table&, std::size_t i);
/// "pass", "fail" or nothing.
std::string state_word(RowState);
/// A cell as a column shows it; empty for nothing, "yes" and "no" for bools.
std::string cell_text(const Cell&, const Column&);

}  // namespace turbid
