// SPDX-License-Identifier: Apache-2.0
// The sub-commands. Each add_... declares its flags on the program; the one that the user chose leaves its work in
// `work`, which main runs where errors are caught.
#pragma once
#include <CLI/CLI.hpp>
#include <functional>

namespace turbid::app {

using Work = std::function<void()>;

void add_render(CLI::App& program, Work& work);
void add_solve(CLI::App& program, Work& work);
void add_voxelise(CLI::App& program, Work& work);
void add_view(CLI::App& program, Work& work);
void add_check(CLI::App& program, Work& work);
void add_devices(CLI::App& program, Work& work);
void add_info(CLI::App& program, Work& work);
void add_compare(CLI::App& program, Work& work);
void add_profile(CLI::App& program, Work& work);
void add_verify(CLI::App& program, Work& work);

}  // namespace turbid::app
