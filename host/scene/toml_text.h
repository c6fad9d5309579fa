// SPDX-License-Identifier: Apache-2.0
// Words for messages and for the effective scene: numbers, strings and nodes as TOML text, places in the file, the
// nearest known name. Private to host/scene.
#pragma once
#include <toml++/toml.h>

#include <glm/glm.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace turbid::scene {

/// Shortest decimal text that reads back as the same number; always a TOML float (`2.0`, not `2`).
std::string text_of(float value);
std::string text_of(double value);
std::string text_of(glm::vec3 value);                                   ///< `[1.0, 2.0, 3.0]`
std::string toml_string(std::string_view text);                         ///< a TOML basic string
std::string key_text(std::string_view key);                             ///< bare where TOML allows it, else quoted
std::string text_of(const toml::node& node, std::size_t longest = 60);  ///< on one line, cut with "..."

/// `file:line:column`; for what an option of the command line gave, that option (`-D camera.fov=0`).
std::string place_of(const toml::source_region& source);

/// ` (did you mean "fov"?)` if one of `known` is spelt almost like `name`, else nothing.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& known);

/// `"a", "b"` or `a, b`.
std::string list_of(const std::vector<std::string>& names, bool quote);

}  // namespace turbid::scene
