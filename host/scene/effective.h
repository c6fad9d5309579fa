// SPDX-License-Identifier: Apache-2.0
// The effective scene: what was read, in the order in which it was read, with every default filled in. Private to
// host/scene.
#pragma once
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "host/scene/scene.h"

namespace turbid::scene {

/// One table. A value that stands for a file has a second text, made from the file's content, that is hashed instead.
class EffectiveTable {
 public:
  explicit EffectiveTable(std::string header = "") { section_.header = std::move(header); }
  explicit EffectiveTable(SceneSection section) : section_(std::move(section)) {}
  void add(const std::string& key, const std::string& value) { add(key, value, value); }
  void add(const std::string& key, const std::string& value, const std::string& hashed);
  /// A table within this one, written inline.
  void add(const std::string& key, const EffectiveTable& table) {
    add(key, table.inline_text(false), table.inline_text(true));
  }
  void comment(const std::string& line) { section_.comments.push_back(line); }

  std::string inline_text(bool hashed) const;  ///< `{ a = 1, b = 2 }`
  const SceneSection& section() const { return section_; }

 private:
  SceneSection section_;
};

class EffectiveScene {
 public:
  /// `header`: `[camera]`, `[[light]]`; empty for the top level, which comes first.
  EffectiveTable& section(const std::string& header) { return tables_.emplace_back(header); }
  /// Takes over tables of a scene that was read before.
  void keep(const SceneSection& section) { tables_.emplace_back(section); }
  /// Writes sections, text and hash into the scene.
  void finish(Scene& scene) const;

 private:
  std::deque<EffectiveTable> tables_;  ///< a deque: references to its tables stay valid
};

/// 16 hex digits of FNV-1a, 64 bits.
std::string hash_text(const std::string& text);
/// The same over a file's bytes. Throws InputError if it can't be read.
std::string hash_file(const std::string& path);

}  // namespace turbid::scene
