// SPDX-License-Identifier: Apache-2.0
// Command-line changes of the scene: see overrides.h.
#include "host/scene/overrides.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "host/base/errors.h"
#include "host/scene/toml_text.h"

namespace turbid::scene {
namespace {

void merge(toml::table& into, toml::table& from, const std::string& option, const std::string& path);

void assign(toml::table& into, const toml::key& key, toml::node& value) {
  value.visit([&](auto& node) { into.insert_or_assign(key, std::move(node)); });  // moved: a copy would lose its source
}

void merge_element(toml::array& into, const std::string& index, toml::node& value, const std::string& option,
                   const std::string& path) {
  std::size_t i = 0;
  const auto [end, error] = std::from_chars(index.data(), index.data() + index.size(), i);
  if (error != std::errc() || end != index.data() + index.size() || i >= into.size())
    throw InputError(option + ": " + path + " is a list of " + std::to_string(into.size()) + ": expected " +
                     (into.empty() ? "no index" : "an index from 0 to " + std::to_string(into.size() - 1)) + ", not " +
                     index);
  toml::table* table = value.as_table();
  if (table && !table->is_inline() && into[i].is_table()) {
    merge(*into[i].as_table(), *table, option, path + "." + index);
  } else if (table && !table->is_inline() && into[i].is_array()) {
    for (auto&& [key, sub] : *table)
      merge_element(*into[i].as_array(), std::string(key.str()), sub, option, path + "." + index);
  } else {
    value.visit([&](auto& node) { into.replace(into.cbegin() + static_cast<std::ptrdiff_t>(i), std::move(node)); });
  }
}

void merge(toml::table& into, toml::table& from, const std::string& option, const std::string& path) {
  for (auto&& [key, value] : from) {
    const std::string here = path.empty() ? std::string(key.str()) : path + "." + std::string(key.str());
    toml::node* present = into.get(key.str());
    toml::table* table = value.as_table();
    const bool path_goes_on = table && !table->is_inline();
    if (path_goes_on && present && present->is_table()) {
      merge(*present->as_table(), *table, option, here);
    } else if (path_goes_on && present && present->is_array()) {
      for (auto&& [index, sub] : *table)
        merge_element(*present->as_array(), std::string(index.str()), sub, option, here);
    } else {
      assign(into, key, value);
    }
  }
}

toml::table parse(const std::string& setting, const std::string& option) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(option + ": expected key.sub=value, e.g. -D camera.fov=30");
  try {
    return toml::parse(setting, std::string(option));
  } catch (const toml::parse_error& error) {
    // A bare word is taken as a text, to spare the shell's quotes: -D solver.name=lattice.
    const std::string value = setting.substr(equals + 1);
    const bool word = !value.empty() && value.find_first_of(" \t\r\n\"'[]{}=,#\\") == std::string::npos;
    if (!word) throw InputError(option + ": " + std::string(error.description()) + "; the value must be TOML");
  }
  try {
    return toml::parse(setting.substr(0, equals + 1) + toml_string(setting.substr(equals + 1)), std::string(option));
  } catch (const toml::parse_error& error) {
    throw InputError(option + ": " + std::string(error.description()) + "; expected key.sub=value");
  }
}

// resolution and voxel_size exclude each other: the one from the command line replaces the file's.
void replace_voxel_rule(toml::table& root, const toml::table& change) {
  toml::table* domain = root["domain"].as_table();
  const toml::table* given = change["domain"].as_table();
  if (!domain || !given) return;
  if (given->contains("resolution") && !given->contains("voxel_size")) domain->erase("voxel_size");
  if (given->contains("voxel_size") && !given->contains("resolution")) domain->erase("resolution");
}

void apply(toml::table& root, const std::string& setting, const std::string& option) {
  toml::table change = parse(setting, option);
  replace_voxel_rule(root, change);
  merge(root, change, option, "");
}

}  // namespace

void apply_overrides(toml::table& root, const SceneOverrides& overrides) {
  for (const std::string& setting : overrides.settings) apply(root, setting, "-D " + setting);
  if (overrides.resolution) {
    const std::string value = std::to_string(*overrides.resolution);
    apply(root, "domain.resolution=" + value, "--resolution " + value);
  }
  if (overrides.solver) apply(root, "solver.name=" + toml_string(*overrides.solver), "--solver " + *overrides.solver);
  if (overrides.seed) {
    const std::string value = std::to_string(*overrides.seed);
    if (*overrides.seed > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
      throw InputError("--seed " + value + ": must be < 2^63");
    apply(root, "solver.seed=" + value, "--seed " + value);
  }
}

}  // namespace turbid::scene
