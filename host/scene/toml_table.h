// SPDX-License-Identifier: Apache-2.0
// A strict reader of one TOML table: every value is checked for type and range and recorded in the effective scene, and
// every mistake is an InputError `file:line:column: key = found: expected`. Private to host/scene.
#pragma once
#include <toml++/toml.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/scene/effective.h"

namespace turbid::scene {

/// What a number may be. NaN and infinity are never allowed.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false, upper_open = false;  ///< the bound itself is not allowed
  std::string unit;                             ///< for messages; empty: none

  static Range any(std::string unit = "") { return {.unit = std::move(unit)}; }
  static Range at_least(double lower, std::string unit = "") { return {.lower = lower, .unit = std::move(unit)}; }
  static Range above(double lower, std::string unit = "") {
    return {.lower = lower, .lower_open = true, .unit = std::move(unit)};
  }
  static Range closed(double lower, double upper, std::string unit = "") {
    return {lower, upper, false, false, std::move(unit)};
  }
  static Range half_open(double lower, double upper, std::string unit = "") {
    return {lower, upper, true, false, std::move(unit)};
  }
  static Range open(double lower, double upper, std::string unit = "") {
    return {lower, upper, true, true, std::move(unit)};
  }

  bool contains(double value) const;
  bool unbounded() const;
  std::string text() const;  ///< `>= 0 [1/mm]`, `in (0, 170] [degrees]`
};

class TableReader {
 public:
  /// `what` names the table in messages: `[camera]`, `eta`. What is read is added to `effective`.
  TableReader(const toml::table& table, std::string what, EffectiveTable& effective)
      : table_(table), what_(std::move(what)), effective_(effective) {}

  /// Refuses every key but these. `what` replaces the table's name in the message ("a point light").
  void allow(const std::vector<std::string>& keys, const std::string& what = "") const;
  bool has(std::string_view key) const { return table_.contains(key); }
  const toml::node* find(std::string_view key) const { return table_.get(key); }
  /// The value; an error if it is missing.
  const toml::node& need(std::string_view key) const;
  const std::string& what() const { return what_; }
  EffectiveTable& effective() const { return effective_; }
  std::string place() const;

  // Each: the value of `key`, or the fallback; without a fallback the key is required.
  float number(std::string_view key, const Range& range, std::optional<float> fallback = {}) const;
  std::int64_t integer(std::string_view key, const Range& range, std::optional<std::int64_t> fallback = {}) const;
  std::string text(std::string_view key, std::optional<std::string> fallback = {}) const;
  /// One number, or three for red, green, blue.
  glm::vec3 colour(std::string_view key, const Range& range, std::optional<glm::vec3> fallback = {}) const;
  /// Three numbers, x, y, z.
  glm::vec3 vector(std::string_view key, const Range& range, std::optional<glm::vec3> fallback = {}) const;
  /// A vector that is not zero; returned with unit length.
  glm::vec3 direction(std::string_view key, std::optional<glm::vec3> fallback = {}) const;

  /// One of a few words.
  template <class Value>
  Value choice(std::string_view key, std::initializer_list<std::pair<std::string, Value>> words,
               std::optional<std::string> fallback = {}) const {
    std::vector<std::string> names;
    for (const auto& word : words) names.push_back(word.first);
    const std::string name = word(key, names, fallback);
    for (const auto& [known, value] : words)
      if (known == name) return value;
    return words.begin()->second;  // not reached: word() accepts known names only
  }
  std::string word(std::string_view key, const std::vector<std::string>& words,
                   std::optional<std::string> fallback = {}) const;

  /// Throws `place: key = found: expected`.
  [[noreturn]] void fail(std::string_view key, const std::string& expected) const;

 private:
  const toml::table& table_;
  std::string what_;
  EffectiveTable& effective_;
};

/// Throws `place: key = found: expected` about a node.
[[noreturn]] void fail(const toml::node& node, std::string_view key, const std::string& expected);

/// The node as a number within the range.
float number_of(const toml::node& node, const std::string& key, const Range& range);
/// Three numbers; one number counts as three where `grey` says so.
glm::vec3 vector_of(const toml::node& node, const std::string& key, const Range& range, bool grey);

}  // namespace turbid::scene
