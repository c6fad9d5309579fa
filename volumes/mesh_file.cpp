// SPDX-License-Identifier: Apache-2.0
// Looks at a mesh file before Assimp does: Assimp's readers allocate what a header claims, whatever the size of the
// file, take a directory or a pipe for a file, and read a PLY file named .obj as an OBJ file without faces.
#include "volumes/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "host/base/errors.h"
#include "volumes/mesh_text.h"

namespace turbid {
namespace {

constexpr const char* expected_formats = "expected a mesh in OBJ, PLY, STL, OFF or glTF format";
constexpr std::size_t head_size = 1 << 16;  // [bytes], more than any header with its comments takes

[[noreturn]] void refuse(const std::string& path, const std::string& found, const std::string& expected) {
  throw InputError(path + ": " + printable(found) + "; " + expected);
}

/// The extension that the first bytes speak for, if they carry a signature (OBJ and binary STL have none).
std::optional<std::string> signature(std::string_view head) {
  if (head.starts_with("ply\n") || head.starts_with("ply\r")) return ".ply";
  if (head.starts_with("glTF")) return ".glb";
  if (head.starts_with("OFF")) return ".off";
  return std::nullopt;
}

void require_room(const std::string& path, std::uint64_t count, const std::string& what, std::uint64_t bytes_each,
                  std::uint64_t bytes) {
  if (count > bytes / bytes_each)
    refuse(path,
           "the header claims " + std::to_string(count) + " " + what + ", more than its " + std::to_string(bytes) +
               " bytes can hold",
           "expected a complete, undamaged file");
}

/// Fewest bytes that a property can take: a list may be empty, and a number in text is a digit and a blank.
std::uint64_t property_bytes(std::istringstream& words, bool text) {
  std::string type;
  words >> type;
  if (type == "list") words >> type;  // the type of its length
  if (text) return 2;
  if (type.ends_with("8") || type.ends_with("char")) return 1;
  if (type.ends_with("16") || type.ends_with("short")) return 2;
  if (type.ends_with("64") || type == "double") return 8;
  return 4;
}

void check_ply(const std::string& path, std::string_view head, std::uint64_t bytes) {
  std::istringstream lines{std::string(head)};
  std::string line, keyword, element;
  bool text = true, ended = false;
  std::uint64_t count = 0, bytes_each = 0;
  const auto finish_element = [&] {
    if (!element.empty())
      require_room(path, count, "entries of \"" + element + "\"", std::max<std::uint64_t>(bytes_each, 1), bytes);
  };
  while (!ended && std::getline(lines, line)) {
    std::istringstream words(line);
    if (!(words >> keyword)) continue;
    if (keyword == "format") {
      words >> keyword;
      text = keyword == "ascii";
    } else if (keyword == "element") {
      finish_element();
      std::string number;
      words >> element >> number;
      const auto parsed = to_number<std::uint64_t>(number);
      if (!parsed)
        refuse(path, "\"" + line.substr(0, 80) + "\" in the header", "expected \"element\", a name and a count");
      count = *parsed;
      bytes_each = 0;
    } else if (keyword == "property") {
      bytes_each += property_bytes(words, text);
    }
    ended = keyword == "end_header";
  }
  if (!ended) refuse(path, "a PLY header without \"end_header\"", "expected a complete, undamaged file");
  finish_element();
}

}  // namespace

std::string lower_case_extension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void require_plausible_mesh_file(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) refuse(path, "no such file", expected_formats);
  if (status.type() == fs::file_type::directory) refuse(path, "a directory", expected_formats);
  if (error) refuse(path, error.message(), expected_formats);
  if (status.type() != fs::file_type::regular) refuse(path, "not a regular file", expected_formats);

  const std::string extension = lower_case_extension(path);
  const auto known = {".obj", ".ply", ".stl", ".off", ".gltf", ".glb"};
  if (std::find(known.begin(), known.end(), extension) == known.end())
    refuse(path, extension.empty() ? "a name without an extension" : "unknown mesh format \"" + extension + "\"",
           "expected .obj, .ply, .stl, .off, .gltf or .glb");

  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, std::string("cannot be opened: ") + std::strerror(errno), "expected a readable file");
  const std::uint64_t bytes = fs::file_size(path);
  if (bytes == 0) refuse(path, "an empty file (0 bytes)", expected_formats);
  std::string head(std::min<std::uint64_t>(bytes, head_size), '\0');
  if (!file.read(head.data(), static_cast<std::streamsize>(head.size())))
    refuse(path, "cannot be read", "expected a readable file");

  if (head.starts_with("\xFE\xFF") || head.starts_with("\xFF\xFE"))
    refuse(path, "UTF-16 text", "expected a mesh file saved as ASCII or UTF-8");
  const auto speaks_for = signature(head);
  if (speaks_for && *speaks_for != extension)
    refuse(path, "content of a " + *speaks_for + " file", "expected the name to end in " + *speaks_for);
  if (extension == ".ply" && !speaks_for) refuse(path, "no \"ply\" in the first line", "expected a PLY file");
  if (extension == ".ply") check_ply(path, head, bytes);
}

}  // namespace turbid
