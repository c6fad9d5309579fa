// SPDX-License-Identifier: Apache-2.0
// Lines and tokens of a text mesh, and the check of an OBJ file's vertices.
#include "volumes/mesh_text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <sstream>

#include "host/base/errors.h"

namespace turbid {
namespace {

void split(std::string_view line, std::vector<std::string_view>& tokens) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  while (!line.empty()) {
    const auto first = std::find_if_not(line.begin(), line.end(), blank);
    const auto last = std::find_if(first, line.end(), blank);
    if (first != last) tokens.emplace_back(first, last);
    line = std::string_view(last, line.end());
  }
}

}  // namespace

std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) > '~') c = '?';
  return text;
}

TextLines::TextLines(const std::string& path) : path_(path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  text_ = std::move(content).str();
  rest_ = text_;
}

bool TextLines::next() {
  tokens.clear();
  while (tokens.empty() && !rest_.empty()) {
    const std::size_t length = std::min(rest_.find('\n'), rest_.size());
    const std::string_view line = rest_.substr(0, length);
    rest_.remove_prefix(std::min(length + 1, rest_.size()));
    ++number_;
    split(line.substr(0, line.find('#')), tokens);
  }
  return !tokens.empty();
}

void TextLines::require_finite(std::size_t k) const {
  const auto value = to_number<double>(tokens[k]);
  if (!value || !std::isfinite(static_cast<float>(*value)))
    refuse("coordinate \"" + std::string(tokens[k].substr(0, 40)) + "\"", "a finite number");
}

void TextLines::refuse(const std::string& found, const std::string& expected) const {
  throw InputError(path_ + ":" + std::to_string(number_) + ": " + printable(found) + "; expected " + expected);
}

void require_sound_obj_vertices(const std::string& path) {
  for (TextLines lines(path); lines.next();) {
    if (lines.tokens[0] != "v" || lines.tokens.back().ends_with('\\'))
      continue;  // (a line that goes on is left to Assimp)
    const std::size_t count = lines.tokens.size() - 1;
    if (count != 3 && count != 4 && count != 6)  // x y z, x y z w, x y z and a colour
      lines.refuse("a vertex of " + std::to_string(count) + " numbers", "x y z");
    for (std::size_t k = 1; k <= (count == 4 ? 4 : 3); ++k) lines.require_finite(k);
  }
}

}  // namespace turbid
