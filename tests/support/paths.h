// SPDX-License-Identifier: Apache-2.0
// Where the build has put what tests need.
#pragma once
#include <string>

namespace turbid::test {

std::string turbid_binary();
std::string build_folder();
std::string cmake_binary();
/// The path of tests/kernel/<file>.
std::string test_kernel(const std::string& file);

}  // namespace turbid::test
