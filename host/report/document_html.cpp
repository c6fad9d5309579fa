// SPDX-License-Identifier: Apache-2.0
// A Document as one self-contained page.
#include <algorithm>

#include "host/report/document.h"
#include "host/report/figure.h"
#include "host/report/html_style.h"
#include "host/report/markup.h"

namespace turbid {
namespace {

constexpr std::size_t kNamedFailures = 10;  // at the top; the tables have them all
constexpr std::size_t kLongText = 40;       // characters of a cell that may break into lines
constexpr std::size_t kShortText = 16;      // that stay on one
constexpr int kSmallPicture = 128;          // [pixels]: enlarged without blurring
constexpr std::size_t kSectionsWithoutContents = 3;

std::string titled(const char* tag, const std::string& title) {
  return title.empty() ? "" : std::string("<") + tag + ">" + html_with_exponents(title) + "</" + tag + ">\n";
}

std::string figure_end(const std::string& caption) {
  return (caption.empty() ? "" : "<figcaption>" + html_with_exponents(caption) + "</figcaption>\n") + "</figure>\n";
}

std::string figure_begin(const std::string& id, const std::string& title) {
  return "<figure id=\"" + escaped(id) + "\">\n" + titled("h3", title);
}

std::string cell_html(const Cell& cell, const Column& column, bool right) {
  const std::string text = cell_text(cell, column);
  const bool number = std::holds_alternative<double>(cell) || std::holds_alternative<std::int64_t>(cell);
  const std::size_t length = character_count(text);
  const char* const kind = right                  ? "right"
                           : length > kLongText   ? "text long"
                           : length <= kShortText ? "text short"
                                                  : "text";
  return std::string("<td class=\"") + kind + "\">" + html_with_exponents(number ? with_power_of_ten(text) : text) +
         "</td>";
}

std::string state_html(RowState state) {
  const char* const mark = state == RowState::pass ? "\xE2\x9C\x93 " : state == RowState::fail ? "\xE2\x9C\x97 " : "";
  return "<td class=\"state\">" + (mark + state_word(state)) + "</td>";
}

std::string table_html(const Table& table) {
  std::string html = figure_begin(table.id, table.title) + "<div class=\"scroll\"><table>\n<thead><tr>";
  const bool states = table.has_states();
  if (states) html += "<th scope=\"col\">state</th>";  // first: a phone shows it without scrolling
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const Column& column = table.columns[i];
    html += std::string("<th scope=\"col\"") + (right_aligned(table, i) ? " class=\"right\">" : ">") +
            html_with_exponents(column.name);
    if (!column.unit.empty()) html += " <span class=\"unit\">[" + html_with_exponents(column.unit) + "]</span>";
    html += "</th>";
  }
  html += "</tr></thead>\n<tbody>\n";
  for (const Row& row : table.rows) {
    html += row.state == RowState::plain ? "<tr>" : "<tr class=\"" + state_word(row.state) + "\">";
    if (states) html += state_html(row.state);
    for (std::size_t i = 0; i < row.cells.size(); ++i)
      html += cell_html(row.cells[i], table.columns[i], right_aligned(table, i));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n" + figure_end(table.caption);
}

struct PartHtml {
  std::string operator()(const Paragraph& part) const { return "<p>" + html_with_exponents(part.text) + "</p>\n"; }
  std::string operator()(const Table& table) const { return table_html(table); }
  std::string operator()(const Plot& plot) const { return figure(plot, plot_svg); }
  std::string operator()(const BarChart& chart) const { return figure(chart, bars_svg); }
  std::string operator()(const Timeline& timeline) const { return figure(timeline, timeline_svg); }
  std::string operator()(const Code& code) const {
    return "<figure>\n" + titled("h3", code.title) + "<pre>" + escaped(code.text) + "</pre>\n</figure>\n";
  }

  std::string operator()(const Pictures& row) const {
    std::string html = figure_begin(row.id, row.title) + "<div class=\"pictures\">\n";
    for (const Picture& one : row.pictures) {
      const bool small = one.width <= kSmallPicture && one.height <= kSmallPicture;
      html += "<figure>" + titled("h4", one.title) + "<img" + (small ? " class=\"small\"" : "") + " width=\"" +
              std::to_string(one.width) + "\" height=\"" + std::to_string(one.height) + "\" alt=\"" +
              escaped(one.title) + "\" src=\"data:image/png;base64," + base64(one.png) + "\">\n" +
              figure_end(one.caption);
    }
    return html + "</div>\n" + figure_end(row.caption);
  }

  template <class Drawn>
  std::string figure(const Drawn& part, std::string (*draw)(const Drawn&, const FigureLayout&)) const {
    const std::string missing = left_out(part);
    const std::string caption = part.caption + (part.caption.empty() || missing.empty() ? "" : " ") + missing;
    return figure_begin(part.id, part.title) + draw(part, kWideFigure) + draw(part, kNarrowFigure) +
           figure_end(caption);
  }
};

/// The verdict, and where to look.
std::string verdict_html(const Document& document) {
  const std::string text = verdict_text(document);
  if (text.empty()) return {};
  const bool failed = verdict(document).failed > 0;
  std::string html =
      std::string("<div class=\"verdict ") + (failed ? "fail\">\xE2\x9C\x97 " : "pass\">\xE2\x9C\x93 ") + text;
  std::string items;
  std::size_t named = 0, left = 0;
  for (const Section& section : document.sections)
    for (const Part& part : section.parts)
      if (const auto* table = std::get_if<Table>(&part))
        for (const Row& row : table->rows) {
          if (row.state != RowState::fail) continue;
          if (named++ >= kNamedFailures) {
            ++left;
            continue;
          }
          std::string name = row.cells.empty() ? "" : cell_text(row.cells[0], table->columns[0]);
          if (!table->title.empty()) name += (name.empty() ? "" : " (") + table->title + (name.empty() ? "" : ")");
          items += "<li><a href=\"#" + escaped(table->id) + "\">" + html_with_exponents(name) + "</a></li>\n";
        }
  if (left > 0) items += "<li>and " + std::to_string(left) + " more</li>\n";
  return html + (items.empty() ? "" : "\n<ul>\n" + items + "</ul>") + "</div>\n";
}

std::string section_id(std::size_t i) {
  return "section-" + std::to_string(i + 1) + ".";
}

std::string contents_html(const Document& document) {
  if (document.sections.size() <= kSectionsWithoutContents) return {};
  std::string html = "<nav aria-label=\"contents\"><ol>\n";
  for (std::size_t i = 0; i < document.sections.size(); ++i)
    html += "<li><a href=\"#" + section_id(i) + "\">" + html_with_exponents(document.sections[i].title) + "</a></li>\n";
  return html + "</ol></nav>\n";
}

std::string context_html(const NamedTexts& context) {
  if (context.empty()) return {};
  std::string html = "<section>\n<h2>How this was made</h2>\n<dl>\n";
  for (const auto& [name, value] : context) html += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
  return html + "</dl>\n</section>\n";
}

}  // namespace

std::string document_html(const Document& document) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(document.title) + "</title>\n<style>" + kPageStyle + "</style>\n</head>\n<body>\n";
  html += titled("h1", document.title);
  if (!document.summary.empty()) html += "<p class=\"summary\">" + html_with_exponents(document.summary) + "</p>\n";
  html += verdict_html(document) + contents_html(document);
  for (std::size_t i = 0; i < document.sections.size(); ++i) {
    const Section& section = document.sections[i];
    html += "<section id=\"" + section_id(i) + "\">\n" + titled("h2", section.title);
    for (const Part& part : section.parts) html += std::visit(PartHtml{}, part);
    html += "</section>\n";
  }
  return html + context_html(document.context) + "</body>\n</html>\n";
}

}  // namespace turbid
