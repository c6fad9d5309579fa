// SPDX-License-Identifier: Apache-2.0
// See redo.h.
#include "host/live/redo.h"

#include <algorithm>
#include <set>

namespace turbid {
namespace {

Redo redo_for_section(const std::string& header) {
  if (header == "[film]") return Redo::tone;
  if (header == "[camera]") return Redo::look;
  if (header == "[view]" || header.empty()) return Redo::gather;
  if (header == "[[light]]") return Redo::light;
  if (header == "[ground]") return Redo::prepare;
  if (header.starts_with("[material.")) return Redo::medium;
  return Redo::all;
}

std::vector<const SceneSection*> with_header(const Scene& scene, const std::string& header) {
  std::vector<const SceneSection*> found;
  for (const SceneSection& section : scene.sections)
    if (section.header == header) found.push_back(&section);
  return found;
}

}  // namespace

Redo redo_for(const Scene& before, const Scene& after) {
  std::set<std::string> headers;
  for (const Scene* scene : {&before, &after})
    for (const SceneSection& section : scene->sections) headers.insert(section.header);
  Redo redo = Redo::nothing;
  for (const std::string& header : headers) {
    const auto then = with_header(before, header), now = with_header(after, header);
    const bool same = std::equal(then.begin(), then.end(), now.begin(), now.end(),
                                 [](const SceneSection* a, const SceneSection* b) { return *a == *b; });
    if (!same) redo = std::max(redo, redo_for_section(header));
  }
  return redo;
}

}  // namespace turbid
