// SPDX-License-Identifier: Apache-2.0
// OFF text to OBJ text. Assimp 5.2's own OFF reader knows neither comments between the lines nor polygons of more than
// nine corners, clamps indices out of range, and allocates whatever the header claims; its OBJ reader does none of
// this.
#include <cstdint>
#include <optional>
#include <string_view>

#include "volumes/mesh_text.h"

namespace turbid {
namespace {

struct Header {
  std::uint64_t vertices = 0, faces = 0;
  std::size_t coordinates = 3;  ///< 4 in 4OFF: x w, y w, z w, w
};

Header read_header(TextLines& lines) {
  Header header;
  if (!lines.next()) lines.refuse("no content", "an OFF file");
  std::string_view& keyword = lines.tokens.front();
  if (const std::size_t off = keyword.find("OFF"); off != std::string_view::npos) {
    const std::string_view kind = keyword.substr(0, off);
    if (kind.ends_with('n')) lines.refuse("nOFF, for any number of dimensions", "three dimensions");
    if (kind.ends_with('4')) header.coordinates = 4;
    keyword.remove_prefix(off + 3);  // some writers put the first count right behind it
    if (keyword.empty()) lines.tokens.erase(lines.tokens.begin());
    if (!lines.tokens.empty() && lines.tokens.front() == "BINARY") lines.refuse("binary OFF", "OFF as text");
    if (lines.tokens.empty()) lines.next();
  }
  const auto vertices = lines.tokens.empty() ? std::nullopt : to_number<std::uint64_t>(lines.tokens[0]);
  const auto faces = lines.tokens.size() < 2 ? std::nullopt : to_number<std::uint64_t>(lines.tokens[1]);
  if (!vertices || !faces) lines.refuse("no counts", "an OFF file with the numbers of vertices and faces");
  header.vertices = *vertices;
  header.faces = *faces;
  if (header.faces == 0) lines.refuse("no faces", "a closed surface of triangles or polygons");
  return header;
}

}  // namespace

std::string off_as_obj(const std::string& path) {
  TextLines lines(path);
  const Header header = read_header(lines);

  std::string obj = "# from OFF\n";
  for (std::uint64_t v = 0; v < header.vertices; ++v) {
    const auto claimed = " of " + std::to_string(header.vertices) + " vertices";
    if (!lines.next()) lines.refuse("the file ends after " + std::to_string(v) + claimed, "a complete file");
    if (lines.tokens.size() < header.coordinates) lines.refuse("a vertex with too few coordinates", "x y z");
    obj += 'v';
    for (std::size_t k = 0; k < header.coordinates; ++k) {
      lines.require_finite(k);
      (obj += ' ') += lines.tokens[k];
    }
    obj += '\n';
  }
  for (std::uint64_t f = 0; f < header.faces; ++f) {
    const auto claimed = " of " + std::to_string(header.faces) + " faces";
    if (!lines.next()) lines.refuse("the file ends after " + std::to_string(f) + claimed, "a complete file");
    const auto corners = to_number<std::uint64_t>(lines.tokens[0]);
    if (!corners || *corners >= lines.tokens.size())
      lines.refuse("a face with fewer indices than it announces", "a count and as many vertex indices");
    if (*corners < 3) continue;  // a point or a line
    obj += 'f';
    for (std::uint64_t k = 1; k <= *corners; ++k) {
      const auto index = to_number<std::uint64_t>(lines.tokens[k]);
      if (!index || *index >= header.vertices)
        lines.refuse("a face names vertex " + std::string(lines.tokens[k].substr(0, 40)) + ", which does not exist",
                     "indices below " + std::to_string(header.vertices));
      (obj += ' ') += std::to_string(*index + 1);
    }
    obj += '\n';
  }
  return obj;
}

}  // namespace turbid
