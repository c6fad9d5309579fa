// SPDX-License-Identifier: Apache-2.0
// Writes the effective scene as TOML: see effective.h.
#include "host/scene/effective.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {

namespace {

/// Comments are not hashed.
std::string text_of(const std::vector<SceneSection>& sections, bool hashed) {
  std::string text;
  for (const SceneSection& section : sections) {
    if (!section.header.empty()) text += "\n" + section.header + "\n";
    for (const SceneEntry& entry : section.entries)
      text += key_text(entry.key) + " = " + (hashed ? entry.hashed : entry.value) + "\n";
    if (!hashed)
      for (const std::string& line : section.comments) text += "# " + line + "\n";
  }
  return text;
}

}  // namespace

void EffectiveTable::add(const std::string& key, const std::string& value, const std::string& hashed) {
  section_.entries.push_back({key, value, hashed});
}

std::string EffectiveTable::inline_text(bool hashed) const {
  std::string text;
  for (const SceneEntry& entry : section_.entries)
    text += (text.empty() ? " " : ", ") + key_text(entry.key) + " = " + (hashed ? entry.hashed : entry.value);
  return "{" + text + (text.empty() ? "}" : " }");
}

void EffectiveScene::finish(Scene& scene) const {
  scene.sections.clear();
  for (const EffectiveTable& table : tables_) scene.sections.push_back(table.section());
  scene.effective_toml = text_of(scene.sections, false);
  scene.hash = hash_text(text_of(scene.sections, true));
}

}  // namespace turbid::scene
