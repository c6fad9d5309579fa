// SPDX-License-Identifier: Apache-2.0
// Text meshes for read_mesh: what Assimp's readers would misread without a word is read or refused here.
#pragma once
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace turbid {

/// The text of an OFF file (OFF, COFF, NOFF, STOFF and 4OFF; colours, normals and texture coordinates are left out) as
/// the text of an OBJ file. Throws InputError naming the file and line.
std::string off_as_obj(const std::string& path);

/// Throws InputError naming the file and line unless every vertex of an OBJ file has finite coordinates, and as many as
/// Assimp takes: it leaves out others, which shifts all indices.
void require_sound_obj_vertices(const std::string& path);

/// The text with '?' for what is not printable ASCII: quotes from a damaged file must not break a message's one line.
std::string printable(std::string text);

/// Whole token as a number, or nothing.
template <typename Number>
std::optional<Number> to_number(std::string_view token) {
  if (token.starts_with('+')) token.remove_prefix(1);
  Number value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return value;
}

/// The lines of a file that are not empty after taking away their '#' comments, as blank-separated tokens.
class TextLines {
 public:
  explicit TextLines(const std::string& path);

  /// Goes to the next line; false at the end of the file.
  bool next();
  /// Refuses the line unless token k is a finite number in single precision.
  void require_finite(std::size_t k) const;
  /// Throws InputError about the line.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const;

  std::vector<std::string_view> tokens;

 private:
  std::string path_;
  std::string text_;
  std::string_view rest_;
  std::size_t number_ = 0;
};

}  // namespace turbid
