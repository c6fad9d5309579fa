// SPDX-License-Identifier: Apache-2.0
// A report as data. HTML, JSON, CSV and text are all written from one Document, so they cannot say different things.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include "host/report/named_texts.h"
#include "host/report/plot.h"
#include "host/report/table.h"

namespace turbid {

struct Paragraph {
  std::string text;
};

struct Picture {
  std::string title = {};
  std::string caption = {};
  int width = 0, height = 0;            ///< [pixels]
  std::vector<unsigned char> png = {};  ///< the file's bytes, see png_bytes() and png_preview_bytes() in host/view
};

/// Pictures side by side, as many as fit.
struct Pictures {
  std::string id;  ///< as of a table
  std::string title = {};
  std::string caption = {};
  std::vector<Picture> pictures = {};
};

/// Commands, an effective scene: shown as they are.
struct Code {
  std::string title = {};
  std::string text = {};
};

using Part = std::variant<Paragraph, Table, Plot, BarChart, Timeline, Pictures, Code>;

struct Section {
  std::string title;
  std::vector<Part> parts = {};
};

struct Document {
  std::string title;
  std::string summary = {};  ///< a sentence or two: what was asked and what came out
  NamedTexts context = {};   ///< command line, device, machine, options, ...: see report_context()
  std::vector<Section> sections = {};
};

/// Rows of all tables that passed and failed.
struct Verdict {
  std::size_t passed = 0, failed = 0;
};
Verdict verdict(const Document&);
/// "all 12 checks passed", "3 of 12 checks failed"; empty without any.
std::string verdict_text(const Document&);

/// One self-contained page: no network, no script.
std::string document_html(const Document&);
/// Numbers in full precision; what is not finite is the text "nan", "inf" or "-inf", an empty cell is null. Pictures
/// give their title and size alone.
std::string document_json(const Document&);
/// RFC 4180; the header says "name [unit]". Numbers in full precision, or nan, inf, -inf. If rows have states, a last
/// column "state" holds pass, fail or nothing.
std::string table_csv(const Table&);
/// For a terminal: paragraphs and aligned tables; plots and pictures are left to the page.
std::string document_text(const Document&);

/// Writes PREFIX.html, PREFIX.json and PREFIX.ID.csv for each table; all of them or, throwing InputError, none. Returns
/// what it wrote as name and file. Throws std::invalid_argument if an id is unfit or used twice, a row lacks cells, or
/// a plot's arrays differ in length.
NamedTexts write_document(const Document&, const std::string& prefix);

/// `text` turned into an id: what an id may not hold becomes '_'.
std::string identifier(const std::string& text);

}  // namespace turbid
