// SPDX-License-Identifier: Apache-2.0
// Changes of the scene on the command line, made in the TOML tree before it is read. Private to host/scene.
#pragma once
#include <toml++/toml.h>

#include "host/scene/scene.h"

namespace turbid::scene {

/// Applies -D settings in order, then --resolution, --solver and --seed. Nodes that they bring say in their source
/// which option they came from. Throws InputError naming the option.
void apply_overrides(toml::table& root, const SceneOverrides& overrides);

}  // namespace turbid::scene
