// SPDX-License-Identifier: Apache-2.0
// A Document for a terminal.
#include <algorithm>

#include "host/report/document.h"

namespace turbid {
namespace {

/// Characters, not bytes: continuation bytes of UTF-8 take no room.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t to, bool right) {
  const std::string space(to > width(text) ? to - width(text) : 0, ' ');
  return right ? space + text : text + space;
}

/// Its last column is the state's, if there is one.
std::vector<std::vector<std::string>> texts_of(const Table& table) {
  const bool states = table.has_states();
  std::vector<std::vector<std::string>> lines;
  auto& head = lines.emplace_back();
  for (const Column& column : table.columns) head.push_back(column_title(column));
  if (states) head.emplace_back();
  for (const Row& row : table.rows) {
    auto& out = lines.emplace_back();
    for (std::size_t i = 0; i < row.cells.size(); ++i) out.push_back(cell_text(row.cells[i], table.columns[i]));
    if (states) out.push_back(state_word(row.state));
  }
  return lines;
}

std::string table_text(const Table& table) {
  const auto lines = texts_of(table);
  std::vector<std::size_t> widths(lines[0].size(), 0);
  for (const auto& fields : lines)
    for (std::size_t i = 0; i < fields.size(); ++i) widths[i] = std::max(widths[i], width(fields[i]));
  std::string text = table.title.empty() ? "" : table.title + "\n";
  for (const auto& fields : lines) {
    std::string out;
    for (std::size_t i = 0; i < fields.size(); ++i)
      out += (i > 0 ? "  " : "") + padded(fields[i], widths[i], i < table.columns.size() && right_aligned(table, i));
    text += out.erase(out.find_last_not_of(' ') + 1) + "\n";
  }
  return table.caption.empty() ? text : text + table.caption + "\n";
}

struct PartText {
  std::string operator()(const Paragraph& part) const { return part.text + "\n"; }
  std::string operator()(const Table& part) const { return table_text(part); }
  std::string operator()(const Code& part) const {
    return (part.title.empty() ? "" : part.title + "\n") + part.text + (part.text.ends_with('\n') ? "" : "\n");
  }
  std::string operator()(const auto&) const { return {}; }
};

}  // namespace

std::string document_text(const Document& document) {
  std::string text;
  const auto add = [&text](const std::string& block) {
    if (!block.empty()) text += (text.empty() ? "" : "\n") + block;
  };
  add(document.title.empty() ? "" : document.title + "\n");
  add(document.summary.empty() ? "" : document.summary + "\n");
  for (const Section& section : document.sections) {
    std::string parts;
    for (const Part& part : section.parts) {
      const std::string one = std::visit(PartText{}, part);
      if (!one.empty()) parts += (parts.empty() ? "" : "\n") + one;
    }
    if (parts.empty()) continue;
    add(section.title.empty() ? parts : section.title + "\n" + std::string(width(section.title), '-') + "\n" + parts);
  }
  const std::string checks = verdict_text(document);
  add(checks.empty() ? "" : checks + "\n");
  return text;
}

}  // namespace turbid
