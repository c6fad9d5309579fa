// SPDX-License-Identifier: Apache-2.0
// Writes the effective scene as TOML: see effective.h.
#include "host/scene/effective.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {

void EffectiveTable::add(const std::string& key, const std::string& value, const std::string& hashed) {
  entries_.push_back({key, value, hashed});
}

std::string EffectiveTable::inline_text(bool hashed) const {
  std::string text;
  for (const Entry& entry : entries_)
    text += (text.empty() ? " " : ", ") + key_text(entry.key) + " = " + (hashed ? entry.hashed : entry.value);
  return "{" + text + (text.empty() ? "}" : " }");
}

std::string EffectiveTable::block_text(bool hashed) const {
  std::string text;
  for (const Entry& entry : entries_)
    text += key_text(entry.key) + " = " + (hashed ? entry.hashed : entry.value) + "\n";
  if (!hashed)
    for (const std::string& line : comments_) text += "# " + line + "\n";
  return text;
}

EffectiveTable& EffectiveScene::section(const std::string& header) {
  sections_.push_back({header, {}});
  return sections_.back().table;
}

std::string EffectiveScene::text(bool hashed) const {
  std::string text;
  for (const Section& section : sections_) {
    if (!section.header.empty()) text += "\n" + section.header + "\n";
    text += section.table.block_text(hashed);
  }
  return text;
}

}  // namespace turbid::scene
