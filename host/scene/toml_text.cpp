// SPDX-License-Identifier: Apache-2.0
// Words for messages and for the effective scene: see toml_text.h.
#include "host/scene/toml_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

namespace turbid::scene {
namespace {

template <class Number>
std::string shortest(Number value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char buffer[40];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

bool bare(std::string_view key) {
  return !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string whole_text_of(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return shortest(value->get());
  if (const auto* value = node.as_integer()) return std::to_string(value->get());
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_string()) return toml_string(value->get());
  std::string text;
  if (const auto* array = node.as_array()) {
    for (const auto& element : *array) text += (text.empty() ? "" : ", ") + whole_text_of(element);
    return std::string("[") + text + "]";
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      text += (text.empty() ? " " : ", ") + key_text(key.str()) + " = " + whole_text_of(value);
    return "{" + text + (text.empty() ? "}" : " }");
  }
  return "a date or time";
}

// Edits (insert, remove, replace, swap neighbours) that turn one name into the other.
int distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<int>> d(a.size() + 1, std::vector<int>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(i);
  std::iota(d[0].begin(), d[0].end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string text_of(float value) {
  return shortest(value);
}
std::string text_of(double value) {
  return shortest(value);
}
std::string text_of(glm::vec3 value) {
  return std::string("[") + text_of(value.x) + ", " + text_of(value.y) + ", " + text_of(value.z) + "]";
}

std::string toml_string(std::string_view text) {
  static const char hex[] = "0123456789ABCDEF";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      out += std::string("\\u00") + hex[byte >> 4] + hex[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string key_text(std::string_view key) {
  return bare(key) ? std::string(key) : toml_string(key);
}

std::string text_of(const toml::node& node, std::size_t longest) {
  std::string text = whole_text_of(node);
  if (text.size() <= longest) return text;
  std::size_t end = longest - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // not inside a UTF-8 character
  return text.substr(0, end) + "...";
}

std::string place_of(const toml::source_region& source) {
  const std::string path = source.path ? *source.path : "scene";
  if (path.starts_with('-')) return path;
  return path + ":" + std::to_string(source.begin.line) + ":" + std::to_string(source.begin.column);
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::string* best = nullptr;
  int best_distance = std::max(1, static_cast<int>(name.size()) / 3) + 1;
  for (const std::string& candidate : known)
    if (const int d = distance(name, candidate); d < best_distance) {
      best = &candidate;
      best_distance = d;
    }
  return best ? " (did you mean " + toml_string(*best) + "?)" : "";
}

std::string list_of(const std::vector<std::string>& names, bool quote) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + (quote ? toml_string(name) : name);
  return text;
}

}  // namespace turbid::scene
