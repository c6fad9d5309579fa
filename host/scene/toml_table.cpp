// SPDX-License-Identifier: Apache-2.0
// A strict reader of one TOML table: see toml_table.h.
#include "host/scene/toml_table.h"

#include <algorithm>
#include <cmath>

#include "host/base/errors.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {
namespace {

std::string bound(double value) {
  const std::string text = text_of(value);
  return text.ends_with(".0") ? text.substr(0, text.size() - 2) : text;
}

std::string with(std::string text, const Range& range) {
  const std::string rule = range.text();
  return rule.empty() ? text : text + " " + rule;
}

}  // namespace

bool Range::contains(double value) const {
  return (lower_open ? value > lower : value >= lower) && (upper_open ? value < upper : value <= upper);
}

bool Range::unbounded() const {
  return std::isinf(lower) && std::isinf(upper);
}

std::string Range::text() const {
  std::string text;
  if (std::isfinite(lower) && std::isfinite(upper))
    text =
        std::string("in ") + (lower_open ? "(" : "[") + bound(lower) + ", " + bound(upper) + (upper_open ? ")" : "]");
  else if (std::isfinite(lower))
    text = (lower_open ? "> " : ">= ") + bound(lower);
  else if (std::isfinite(upper))
    text = (upper_open ? "< " : "<= ") + bound(upper);
  if (!unit.empty()) text += (text.empty() ? "[" : " [") + unit + "]";
  return text;
}

void fail(const toml::node& node, std::string_view key, const std::string& expected) {
  throw InputError(place_of(node.source()) + ": " + std::string(key) + " = " + text_of(node) + ": " + expected);
}

float number_of(const toml::node& node, const std::string& key, const Range& range) {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value) fail(node, key, with("expected a number", range));
  if (!std::isfinite(*value) || !std::isfinite(static_cast<float>(*value)))
    fail(node, key, with("must be a finite number", range));
  // The float that is kept must not have rounded onto a bound that is excluded.
  const auto kept = static_cast<float>(*value);
  const bool rounded_out = (range.lower_open && kept <= static_cast<float>(range.lower)) ||
                           (range.upper_open && kept >= static_cast<float>(range.upper));
  if (!range.contains(*value) || rounded_out) fail(node, key, "must be " + range.text());
  return kept;
}

glm::vec3 vector_of(const toml::node& node, const std::string& key, const Range& range, bool grey) {
  if (grey && node.is_number()) return glm::vec3(number_of(node, key, range));
  const toml::array* array = node.as_array();
  if (!array || array->size() != 3)
    fail(node, key,
         with(grey ? "expected a number or [red, green, blue]" : "expected [x, y, z]",
              range.unbounded() ? Range::any(range.unit) : range));
  glm::vec3 value;
  for (int c = 0; c < 3; ++c)
    value[c] = number_of((*array)[static_cast<std::size_t>(c)], key + "[" + std::to_string(c) + "]", range);
  return value;
}

void TableReader::allow(const std::vector<std::string>& keys, const std::string& what) const {
  const toml::key* first = nullptr;
  for (const auto& [key, value] : table_) {
    if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
    const auto begin = [](const toml::key& k) { return std::pair(k.source().begin.line, k.source().begin.column); };
    if (!first || begin(key) < begin(*first)) first = &key;
  }
  if (!first) return;
  throw InputError(place_of(first->source()) + ": " + key_text(first->str()) + " = " +
                   text_of(*table_.get(first->str())) + ": unknown key" + did_you_mean(first->str(), keys) + "; " +
                   (what.empty() ? what_ : what) + " has " + list_of(keys, false));
}

std::string TableReader::place() const {
  return place_of(table_.source());
}

const toml::node& TableReader::need(std::string_view key) const {
  if (const toml::node* node = table_.get(key)) return *node;
  throw InputError(place() + ": " + what_ + " lacks the key " + std::string(key));
}

void TableReader::fail(std::string_view key, const std::string& expected) const {
  turbid::scene::fail(need(key), key, expected);
}

float TableReader::number(std::string_view key, const Range& range, std::optional<float> fallback) const {
  const float value = !has(key) && fallback ? *fallback : number_of(need(key), std::string(key), range);
  effective_.add(std::string(key), text_of(value));
  return value;
}

std::int64_t TableReader::integer(std::string_view key, const Range& range,
                                  std::optional<std::int64_t> fallback) const {
  std::int64_t value = 0;
  if (!has(key) && fallback) {
    value = *fallback;
  } else {
    const toml::node& node = need(key);
    if (!node.is_integer()) fail(key, with("expected a whole number", range));
    value = node.as_integer()->get();
    if (!range.contains(static_cast<double>(value))) fail(key, "must be " + range.text());
  }
  effective_.add(std::string(key), std::to_string(value));
  return value;
}

std::string TableReader::text(std::string_view key, std::optional<std::string> fallback) const {
  std::string value;
  if (!has(key) && fallback) {
    value = *fallback;
  } else {
    if (!need(key).is_string()) fail(key, "expected a text in quotes");
    value = find(key)->as_string()->get();
    if (value.empty()) fail(key, "must not be empty");
  }
  effective_.add(std::string(key), toml_string(value));
  return value;
}

glm::vec3 TableReader::colour(std::string_view key, const Range& range, std::optional<glm::vec3> fallback) const {
  const glm::vec3 value = !has(key) && fallback ? *fallback : vector_of(need(key), std::string(key), range, true);
  effective_.add(std::string(key), text_of(value));
  return value;
}

glm::vec3 TableReader::vector(std::string_view key, const Range& range, std::optional<glm::vec3> fallback) const {
  const glm::vec3 value = !has(key) && fallback ? *fallback : vector_of(need(key), std::string(key), range, false);
  effective_.add(std::string(key), text_of(value));
  return value;
}

glm::vec3 TableReader::direction(std::string_view key, std::optional<glm::vec3> fallback) const {
  const glm::dvec3 value = vector(key, Range::any(), fallback);
  const double length = glm::length(value);
  if (!(length > 0)) fail(key, "must not be zero: it is a direction");
  return glm::vec3(value / length);
}

std::string TableReader::word(std::string_view key, const std::vector<std::string>& words,
                              std::optional<std::string> fallback) const {
  if (!has(key) && fallback) {
    effective_.add(std::string(key), toml_string(*fallback));
    return *fallback;
  }
  const toml::node& node = need(key);
  const std::string expected = "expected " + list_of(words, true);
  if (!node.is_string()) fail(key, expected);
  const std::string value = node.as_string()->get();
  if (std::find(words.begin(), words.end(), value) == words.end()) fail(key, expected + did_you_mean(value, words));
  effective_.add(std::string(key), toml_string(value));
  return value;
}

}  // namespace turbid::scene
